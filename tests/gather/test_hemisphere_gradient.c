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
    assay_rgb  grey;
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

static double published_rotation(const assay_hemisphere *h, const truth *t)
{
    const int  m = h->layout.theta, n = h->layout.phi;
    assay_vec3 g = {0, 0, 0};
    for (int i = 0; i < m * n; i++) {
        const assay_vec3 d = h->cells[i].direction;
        const double     w = h->cells[i].radiance.g *
                         (h->layout.strata == ASSAY_STRATA_COSINE ? ASSAY_PI / d.z : 2 * ASSAY_PI) /
                         (m * n);
        g = vec3_mad(g, w, vec3(-d.y, d.x, 0));
    }
    return distance(g, t->rotation) / vec3_length(t->rotation);
}

static void converges(void **state)
{
    (void)state;
    assay_context *context = measure_context(1);
    closed_scene   scenes[SCENES];
    make_scenes(scenes);
    for (int i = 0; i < SCENES; i++) {
        const seen_scene scene = seen_from_origin(scenes[i].objects, scenes[i].count);
        const truth      t     = truth_of(&scenes[i]);
        print_message("#| %s E %.5f g %.4f %.4f t %.4f %.4f %.4f\n", scenes[i].name, t.irradiance,
                      t.rotation.x, t.rotation.y, t.translation.x, t.translation.y,
                      t.translation.z);
        for (int strata = 0; strata < 2; strata++) {
            for (int m = 16; m <= 256; m *= 2) {
                const int         n = (int)floor(ASSAY_PI * m + 0.5);
                assay_hemisphere *h =
                    seen_hemisphere(context, &scene, m, n, (assay_strata)strata, false, 0);
                const errors e = errors_of(h, &t);
                print_message("#| %s M %3d E %.4f  g %.4f  (pub %.4f) t %.4f n %.4f\n",
                              strata ? "uniform" : "cosine ", m, e.irradiance, e.rotation,
                              published_rotation(h, &t), e.tangential, e.normal);
                assay_hemisphere_destroy(context, h);
            }
        }
    }
    assay_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(converges)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
