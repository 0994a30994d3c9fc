/* test_hemisphere_gradient.c - irradiance and its gradients against closed forms. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <string.h>

#include "core/numerics.h"
#include "support/closed_form.h"
#include "support/measure.h"
#include "support/near.h"
#include "support/seen.h"

/* ---- scenes whose irradiance is known at every point and tilt ---- */

enum { OBJECTS = 3 };

typedef struct {
    const char *name;
    seen_object objects[OBJECTS];
    int         count;
    double signs[OBJECTS]; /* E = sum of signs times that of each object, alone, of radiance 1 */
} closed_scene;

typedef struct {
    double     irradiance;
    assay_vec3 rotation, translation;
} truth;

static const assay_vec3 UP = {0, 0, 1};

static closed_scene one(const char *name, seen_object object)
{
    return (closed_scene){name, {object}, 1, {1.0}};
}

enum { SCENES = 8 };

static void make_scenes(closed_scene *s)
{
    const double      c = cos(ASSAY_PI / 6.0), h = 0.5;
    const seen_object lamp = seen_quad(vec3(0.3, 0.2, 1.5), vec3(0.8, 0, 0), vec3(0, 0.6, 0), 1.0);
    s[0]                   = one("rectangle overhead", lamp);
    s[1]                   = one("rectangle at 30 degrees",
                                 seen_quad(vec3(0.9, -0.3, 1.3), vec3(0.6 * c, 0, -0.6 * h), vec3(0, 0.7, 0), 1.0));
    s[2]                   = one("rectangle at 60 degrees",
                                 seen_quad(vec3(-1.0, 0.6, 1.2), vec3(0.6 * h, 0, 0.6 * c), vec3(0.1, 0.8, 0), 1.0));
    s[3]                   = one("upright rectangle, clipped",
                                 seen_quad(vec3(1.1, 0.3, 0.2), vec3(0, 0.9, 0), vec3(0, 0, 0.8), 1.0));
    s[4]                   = one("triangle",
                                 (seen_object){.shape    = SEEN_POLYGON,
                                               .vertices = {{-0.9, -0.4, 1.0}, {0.7, -0.9, 1.6}, {0.2, 0.8, 1.2}},
                                               .count    = 3,
                                               .radiance = {1.0, 1.0, 1.0}});
    s[5]                   = (closed_scene){
                          "occluder before a rectangle",
                          {seen_quad(vec3(0.2, 0.1, 2.0), vec3(1.4, 0, 0), vec3(0, 1.2, 0), 1.0),
                           seen_quad(vec3(0.25, -0.05, 0.8), vec3(0.3, 0.1, 0.05), vec3(-0.05, 0.25, 0), 0.0)},
                          2,
                          {1.0, -1.0}};
    s[6] = one("sphere", seen_sphere(vec3(0.7, 0.4, 1.3), 0.6, 1.0));
    s[7] = one("sphere nearly overhead", seen_sphere(vec3(0.1, -0.2, 1.5), 0.7, 1.0));
}

static truth truth_of(const closed_scene *scene)
{
    const assay_vec3 p = {0, 0, 0};
    truth            t = {.irradiance = 0.0};
    for (int i = 0; i < scene->count; i++) {
        const seen_object *o    = &scene->objects[i];
        const double       sign = scene->signs[i];
        if (o->shape == SEEN_SPHERE) {
            const assay_vec3 to = o->centre;
            const double     d  = vec3_length(to);
            t.irradiance += sign * (double)closed_sphere(o->centre, o->radius, p, UP);
            t.rotation = vec3_mad(t.rotation, sign * ASSAY_PI * o->radius * o->radius / (d * d * d),
                                  vec3_cross(UP, to));
            t.translation =
                vec3_mad(t.translation, sign, closed_sphere_gradient(o->centre, o->radius, p, UP));
        } else {
            t.irradiance += sign * (double)closed_polygon(o->vertices, o->count, p, UP);
            t.rotation =
                vec3_mad(t.rotation, sign, closed_polygon_rotation(o->vertices, o->count, p, UP));
            t.translation = vec3_mad(t.translation, sign,
                                     closed_polygon_gradient(o->vertices, o->count, p, UP));
        }
    }
    return t;
}

/* ---- errors ---- */

typedef struct {
    double irradiance, rotation, tangential, normal; /* relative to the truth's length */
} errors;

static double distance(assay_vec3 a, assay_vec3 b) { return vec3_length(vec3_sub(a, b)); }

static errors errors_of(const assay_hemisphere *h, const truth *t)
{
    assay_vec3 rotation[3], translation[3];
    assay_hemisphere_rotation_gradient(h, rotation);
    assay_hemisphere_translation_gradient(h, true, translation);
    const double length = vec3_length(t->translation);
    return (errors){fabs(assay_hemisphere_irradiance(h).g - t->irradiance) / t->irradiance,
                    distance(rotation[1], t->rotation) / vec3_length(t->rotation),
                    distance(vec3(translation[1].x, translation[1].y, 0),
                             vec3(t->translation.x, t->translation.y, 0)) /
                        length,
                    fabs(translation[1].z - t->translation.z) / length};
}

/* ---- what may be wrong ---- */

/* Standard deviation of a sum over cells if each cell that lies on an edge of what is seen is wrong
 * by anything between half of it too little and half too much: 1/12 of a weight's square.  Cells
 * with a neighbour of other radiance count: both sides of the edge, so twice as many as are cut. */
typedef struct {
    double irradiance, rotation;
} edge_noise;

static bool on_edge(const assay_hemisphere *h, int j, int k)
{
    const int    m = h->layout.theta, n = h->layout.phi;
    const double here      = h->cells[j * n + k].radiance.g;
    const double around[4] = {h->cells[j * n + (k + 1) % n].radiance.g,
                              h->cells[j * n + (k + n - 1) % n].radiance.g,
                              j > 0 ? h->cells[(j - 1) * n + k].radiance.g : here,
                              j < m - 1 ? h->cells[(j + 1) * n + k].radiance.g : here};
    return around[0] != here || around[1] != here || around[2] != here || around[3] != here;
}

static edge_noise noise_of(const assay_hemisphere *h)
{
    edge_noise sum = {0.0, 0.0};
    for (int i = 0; i < h->layout.theta * h->layout.phi; i++) {
        const int j = i / h->layout.phi;
        if (on_edge(h, j, i % h->layout.phi)) {
            const assay_vec3 d     = h->cells[i].direction;
            const double     angle = assay_hemisphere_solid_angle(h, j);
            sum.irradiance += angle * angle * d.z * d.z / 12.0;
            sum.rotation += angle * angle * (1.0 - d.z * d.z) / 12.0;
        }
    }
    return (edge_noise){sqrt(sum.irradiance), sqrt(sum.rotation)};
}

/* Relative error of the translational gradient.  Borders move as the distance at a cell's centre
 * says and not at the edge, half a cell further: to first order in the cell for what is flat.  A
 * sphere's edge is where the ray touches it, at D = sqrt(d^2 - R^2), and just inside by an angle e
 * it is nearer by d sqrt(e sin 2 alpha); with e even between 0 and a cell, e sin 2 alpha <= 1 / M
 * in cosine strata and 2 / M in uniform ones, the mean is 2/3 of the root. */
static double distance_bias(const seen_object *o, assay_strata strata, int m)
{
    if (o->shape == SEEN_POLYGON) {
        return 3.0 / m;
    }
    const double d2 = vec3_dot(o->centre, o->centre);
    return 2.0 / 3.0 * sqrt(d2 / (d2 - o->radius * o->radius)) *
           sqrt((strata == ASSAY_STRATA_COSINE ? 1.0 : 2.0) / m);
}

/* The rotational gradient as it is published, by tan theta at the samples, with the right sign. */
static assay_vec3 published_rotation(const assay_hemisphere *h)
{
    const bool cosine = h->layout.strata == ASSAY_STRATA_COSINE;
    const int  count  = h->layout.theta * h->layout.phi;
    assay_vec3 g      = {0, 0, 0};
    for (int i = 0; i < count; i++) {
        const assay_vec3 d = h->cells[i].direction;
        g = vec3_mad(g, h->cells[i].radiance.g * ASSAY_PI / count * (cosine ? 1.0 / d.z : 2.0),
                     vec3(-d.y, d.x, 0));
    }
    return g;
}

/* ---- centred cells ---- */

enum { SIZES = 3 };
static const int M[SIZES] = {16, 64, 256};

static int columns_of(int m) { return (int)floor(ASSAY_PI * m + 0.5); }

/* Uniform strata have their first border at 20 degrees where M = 16: too coarse for what hides
 * something overhead. */
static bool too_coarse(const closed_scene *scene, assay_strata strata, int m)
{
    return scene->count > 1 && strata == ASSAY_STRATA_UNIFORM && m == 16;
}

static errors check_scene(assay_context *context, const closed_scene *closed, assay_strata strata,
                          int m)
{
    const seen_scene  scene = seen_from_origin(closed->objects, closed->count);
    const truth       t     = truth_of(closed);
    assay_hemisphere *h     = seen_hemisphere(context, &scene, m, columns_of(m), strata, false, 0);
    const errors      e     = errors_of(h, &t);
    const edge_noise  noise = noise_of(h);
    print_message("#| %-28s %s M %3d: E %.4f, g %.4f (published %.4f), t %.4f %.4f\n", closed->name,
                  strata == ASSAY_STRATA_COSINE ? "cosine " : "uniform", m, e.irradiance,
                  e.rotation, distance(published_rotation(h), t.rotation) / vec3_length(t.rotation),
                  e.tangential, e.normal);
    if (!too_coarse(closed, strata, m)) {
        const double bias = distance_bias(&closed->objects[closed->count - 1], strata, m);
        const double slip = noise.irradiance / t.irradiance;
        assert_near(e.irradiance, 0.0, 5.0 * slip);
        assert_near(e.rotation, 0.0, 5.0 * noise.rotation / vec3_length(t.rotation));
        assert_near(e.tangential, 0.0, 1.25 * bias);
        assert_near(e.normal, 0.0, 1.25 * bias);
    }
    assay_hemisphere_destroy(context, h);
    return e;
}

/* Root mean square over the flat scenes from M = 16 to 256: E and g fall as M^-1.5 if edges lie on
 * the cells as if by chance, 64 times, t as M^-1, 16 times.  Six scenes tell that to a factor. */
static void converges(assay_strata strata)
{
    assay_context *context       = measure_context(1);
    errors         square[SIZES] = {{0, 0, 0, 0}};
    closed_scene   scenes[SCENES];
    make_scenes(scenes);
    for (int i = 0; i < SCENES; i++) {
        for (int s = 0; s < SIZES; s++) {
            const errors e    = check_scene(context, &scenes[i], strata, M[s]);
            const double flat = scenes[i].objects[0].shape == SEEN_POLYGON ? 1.0 : 0.0;
            square[s].irradiance += flat * e.irradiance * e.irradiance;
            square[s].rotation += flat * e.rotation * e.rotation;
            square[s].tangential += flat * (e.tangential * e.tangential + e.normal * e.normal);
        }
    }
    const double gain[3] = {sqrt(square[0].irradiance / square[SIZES - 1].irradiance),
                            sqrt(square[0].rotation / square[SIZES - 1].rotation),
                            sqrt(square[0].tangential / square[SIZES - 1].tangential)};
    print_message("#| flat scenes, M 16 to 256: E better %.0f times, g %.0f, t %.0f\n", gain[0],
                  gain[1], gain[2]);
    assert_true(gain[0] > 16.0 && gain[1] > 16.0 && gain[2] > 8.0);
    assay_context_destroy(context);
}

static void cosine_strata_converge(void **state)
{
    (void)state;
    converges(ASSAY_STRATA_COSINE);
}

static void uniform_strata_converge(void **state)
{
    (void)state;
    converges(ASSAY_STRATA_UNIFORM);
}

/* The normal gradient of a sphere straight overhead has just the bias that distance_bias says, and
 * with its sign: borders are taken for nearer than they are. */
static void bias_of_a_sphere_is_as_predicted(void **state)
{
    (void)state;
    assay_context    *context = measure_context(1);
    const seen_object ball    = seen_sphere(vec3(0, 0, 1.5), 0.7, 1.0);
    const seen_scene  scene   = seen_from_origin(&ball, 1);
    const assay_vec3  exact   = closed_sphere_gradient(ball.centre, ball.radius, vec3(0, 0, 0), UP);
    double            sum     = 0.0;
    int               count   = 0;
    /* A ring is right by chance of where the edge falls in it: the mean over many M tells. */
    for (int m = 64; m < 164; m++, count++) {
        assay_vec3        t[3];
        assay_hemisphere *h = seen_hemisphere(context, &scene, m, 8, ASSAY_STRATA_COSINE, false, 0);
        assay_hemisphere_translation_gradient(h, true, t);
        sum += (t[1].z / exact.z - 1.0) / distance_bias(&ball, ASSAY_STRATA_COSINE, m);
        assay_hemisphere_destroy(context, h);
    }
    print_message("#| sphere overhead: bias of the normal gradient %.3f of what is predicted\n",
                  sum / count);
    assert_near(sum / count, 1.0, 0.1);
    assay_context_destroy(context);
}

/* A channel has the gradient of its own radiance: powers of 2 scale without rounding. */
static void channels_are_apart(void **state)
{
    (void)state;
    assay_context *context = measure_context(1);
    seen_object    quad = seen_quad(vec3(0.3, 0.2, 1.5), vec3(0.8, 0, 0.1), vec3(0, 0.6, 0), 1.0);
    quad.radiance       = rgb(0.5, 1.0, 4.0);
    const seen_scene  scene = seen_from_origin(&quad, 1);
    assay_hemisphere *h = seen_hemisphere(context, &scene, 16, 50, ASSAY_STRATA_COSINE, true, 5);
    assay_vec3        g[2][3];
    assay_hemisphere_rotation_gradient(h, g[0]);
    assay_hemisphere_translation_gradient(h, true, g[1]);
    for (int i = 0; i < 2; i++) {
        assert_true(vec3_length(g[i][1]) > 0.05);
        assert_true(distance(g[i][0], vec3_scale(g[i][1], 0.5)) == 0.0);
        assert_true(distance(g[i][2], vec3_scale(g[i][1], 4.0)) == 0.0);
    }
    assay_vec3 level[3];
    assay_hemisphere_translation_gradient(h, false, level);
    assert_true(level[1].x == g[1][1].x && level[1].y == g[1][1].y && level[1].z == 0.0);
    assay_hemisphere_destroy(context, h);
    assay_context_destroy(context);
}

/* ---- jittered cells ---- */

enum { RUNS = 400, NUMBERS = 6, JITTERED_M = 32, JITTERED_N = 100 };

/* E; g.x, g.y; t.x, t.y, t.z; as published g.x, g.y: sums over runs. */
typedef struct {
    double sum[NUMBERS + 2], square[NUMBERS + 2];
} tally;

static tally repeat(assay_context *context, const closed_scene *closed, assay_strata strata)
{
    const seen_scene  scene = seen_from_origin(closed->objects, closed->count);
    assay_hemisphere *h = seen_hemisphere(context, &scene, JITTERED_M, JITTERED_N, strata, true, 0);
    tally             all = {{0}, {0}};
    for (int run = 0; run < RUNS; run++) {
        assay_vec3 g[3], t[3];
        seen_fill(&scene, (uint64_t)run, h);
        assay_hemisphere_rotation_gradient(h, g);
        assay_hemisphere_translation_gradient(h, true, t);
        const assay_vec3 published = published_rotation(h);
        const double     x[]       = {assay_hemisphere_irradiance(h).g,
                                      g[1].x,
                                      g[1].y,
                                      t[1].x,
                                      t[1].y,
                                      t[1].z,
                                      published.x,
                                      published.y};
        for (int i = 0; i < NUMBERS + 2; i++) {
            all.sum[i] += x[i];
            all.square[i] += x[i] * x[i];
        }
    }
    assay_hemisphere_destroy(context, h);
    return all;
}

static double mean_of(const tally *all, int i) { return all->sum[i] / RUNS; }

static double deviation_of(const tally *all, int i)
{
    return sqrt((all->square[i] - RUNS * mean_of(all, i) * mean_of(all, i)) / (RUNS - 1));
}

/* Means over many jitters: E has no bias at all.  g has that of a cell counting as one direction,
 * below half of what a cell is wide; t that of the distances, as centred. */
static void check_means(const closed_scene *closed, const tally *all, assay_strata strata)
{
    static const char *const names[]         = {"E", "g.x", "g.y", "t.x", "t.y", "t.z"};
    const truth              t               = truth_of(closed);
    const double             exact[NUMBERS]  = {t.irradiance,    t.rotation.x,    t.rotation.y,
                                                t.translation.x, t.translation.y, t.translation.z};
    const double             length[NUMBERS] = {t.irradiance,
                                                vec3_length(t.rotation),
                                                vec3_length(t.rotation),
                                                vec3_length(t.translation),
                                                vec3_length(t.translation),
                                                vec3_length(t.translation)};
    const seen_object       *nearest         = &closed->objects[closed->count - 1];
    const double             bias            = 1.25 * distance_bias(nearest, strata, JITTERED_M);
    const double             turn            = 0.5 / JITTERED_M;
    const double             band[NUMBERS]   = {0.0, turn, turn, bias, bias, bias};
    print_message("#| %s, %s strata, jittered:", closed->name,
                  strata == ASSAY_STRATA_COSINE ? "cosine" : "uniform");
    for (int i = 0; i < NUMBERS; i++) {
        print_message(" %s %+.4f (sd %.4f)", names[i], (mean_of(all, i) - exact[i]) / length[i],
                      deviation_of(all, i) / length[i]);
    }
    print_message("; g.y as published (sd %.4f)\n", deviation_of(all, NUMBERS + 1) / length[2]);
    for (int i = 0; i < NUMBERS; i++) {
        assert_near(mean_of(all, i), exact[i],
                    5.0 * deviation_of(all, i) / sqrt(RUNS) + band[i] * length[i]);
    }
}

static void jittered_cells(void **state)
{
    (void)state;
    static const int which[] = {1, 2, 3, 5, 6};
    assay_context   *context = measure_context(1);
    closed_scene     scenes[SCENES];
    make_scenes(scenes);
    for (int i = 0; i < 10; i++) {
        const assay_strata strata = i % 2 ? ASSAY_STRATA_UNIFORM : ASSAY_STRATA_COSINE;
        const tally        all    = repeat(context, &scenes[which[i / 2]], strata);
        check_means(&scenes[which[i / 2]], &all, strata);
    }
    assay_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cosine_strata_converge), cmocka_unit_test(uniform_strata_converge),
        cmocka_unit_test(bias_of_a_sphere_is_as_predicted), cmocka_unit_test(channels_are_apart),
        cmocka_unit_test(jittered_cells)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
