/* test_cache_accuracy.c - the error of irradiance-cache over an image of the Cornell box.
 *
 * Two sets of probes by `path`, a and b, with the same bounces and other seeds, are the truth at
 * the centres of all pixels: the mean of (x - a)(x - b) is free of their noise, which is as large
 * as the error that is looked for.  It is divided by what the image says, never by what a or b say:
 * their noise would be in both factors then, and would not average out.
 *
 * The mistakes that the checks must see: gradients left out or with the wrong sign, records that
 * reach too far, a mean that is off. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "core/numerics.h"
#include "support/measure.h"

enum { SIDE = 40, PROBES = SIDE * SIDE, CHANNELS = 3 };

/* clang-format off */
/* About 1,000 rays a record; what follows in a list wins. */
#define CACHE(BOUNCES)                                                                             \
    {"method", "irradiance-cache"}, {"bounces", BOUNCES}, {"a", "0.15"}, {"theta_strata", "18"},   \
    {"phi_strata", "56"}, {"spp", "128"}, {"gradient_limit", "on"}, {"r_max", "0.2"}
/* clang-format on */

typedef struct {
    assay_context *context;
    assay_scene   *scene;
    bool           hit[PROBES];
    assay_array   *truth[2];
} box;

/* Of a layer, in parts of what it says; each with a standard error. */
typedef struct {
    measured squared; /* mean of the squared difference */
    measured bias;    /* of the mean                    */
} verdict;

static void open_box(box *b)
{
    assay_scene_options options = assay_scene_options_default();
    options.force_diffuse       = true;
    *b                          = (box){.context = measure_context(1)};
    assert_int_equal(
        assay_scene_load(b->context, "scenes/cornell-box/cornell-box.gltf", &options, &b->scene),
        ASSAY_OK);
}

static void close_box(box *b)
{
    assay_array_destroy(b->truth[0]);
    assay_array_destroy(b->truth[1]);
    assay_scene_destroy(b->scene);
    assay_context_destroy(b->context);
}

static assay_image *render(const box *b, const setting *settings)
{
    return measure_render(b->scene, settings, SIDE, SIDE, "irradiance,gbuffer");
}

static double value_at(const assay_image *image, const char *layer, char channel, int probe)
{
    char          name[64];
    assay_channel found;
    snprintf(name, sizeof name, "%s.%c", layer, channel);
    assert_true(assay_image_find_channel(image, name, &found));
    return found.data.f32[probe];
}

/* Positions are floats in an image: so probes stand a micrometre above the surfaces. */
static void probe_truth(box *b, const assay_image *image, const char *bounces, const char *spp)
{
    double points[6 * PROBES];
    for (int i = 0; i < PROBES; i++) {
        double *p = points + 6 * i, *n = p + 3;
        for (int axis = 0; axis < 3; axis++) {
            n[axis] = value_at(image, "N", "XYZ"[axis], i);
            p[axis] = value_at(image, "P", "XYZ"[axis], i) + 1e-6 * n[axis];
        }
        b->hit[i] = n[0] != 0.0 || n[1] != 0.0 || n[2] != 0.0;
        if (!b->hit[i]) {
            memcpy(p, (const double[]){0.0, 0.0, 0.0, 0.0, 0.0, 1.0}, 6 * sizeof *p);
        }
    }
    for (int k = 0; k < 2; k++) {
        const setting path[] = {{"spp", spp},
                                {"bounces", bounces},
                                {"gradients", "off"},
                                {"seed", k ? "12" : "11"},
                                {NULL, NULL}};
        b->truth[k]          = measure_probes(b->scene, path, points, PROBES);
    }
}

/* What the image says at all probes, channel by channel, and the mean of each. */
typedef struct {
    double at[CHANNELS][PROBES], mean[CHANNELS];
} said;

static said read_layer(const assay_image *image, const char *layer)
{
    said x = {.mean = {0.0}};
    for (int c = 0; c < CHANNELS; c++) {
        for (int i = 0; i < PROBES; i++) {
            x.at[c][i] = value_at(image, layer, "RGB"[c], i);
            x.mean[c] += x.at[c][i] / PROBES;
        }
    }
    return x;
}

static verdict judge(const box *b, const said *x, const char *quantity)
{
    double sum = 0.0, squares = 0.0, off = 0.0, noise = 0.0, all = 0.0, count = 0.0;
    for (int i = 0; i < PROBES; i++) {
        double of_probe = 0.0, apart = 0.0;
        for (int c = 0; b->hit[i] && c < CHANNELS; c++) {
            char         column[32];
            const double is = x->at[c][i], scale = is * is + 0.01 * x->mean[c] * x->mean[c];
            snprintf(column, sizeof column, "%s.%c", quantity, "RGB"[c]);
            const double one = measure_probe(b->truth[0], i, column).value;
            const double two = measure_probe(b->truth[1], i, column).value;
            of_probe += (is - one) * (is - two) / (scale * CHANNELS);
            apart += 0.5 * (one - two);
            off += is - 0.5 * (one + two);
            all += is;
        }
        sum += of_probe;
        squares += of_probe * of_probe;
        noise += apart * apart;
        count += b->hit[i];
    }
    return (verdict){{sum / count, sqrt(squares) / count}, {off / all, sqrt(noise) / all}};
}

static verdict judge_and_tell(const box *b, const assay_image *image, const char *what,
                              const char *layer, const char *quantity)
{
    const said    x = read_layer(image, layer);
    const verdict v = judge(b, &x, quantity);
    print_message("#| %-24s %-18s relative rms error %.4f (%.4f), mean %+.4f +- %.4f\n", what,
                  layer, sqrt(fmax(v.squared.value, 0.0)), sqrt(v.squared.error), v.bias.value,
                  v.bias.error);
    return v;
}

/* Within 3 percent, and 0.5 of the mean, with a standard error to spare. */
static void check_irradiance(const box *b, const assay_image *image, const char *what)
{
    const verdict v = judge_and_tell(b, image, what, "Irradiance", "E");
    assert_true(v.squared.value + v.squared.error <= 0.03 * 0.03);
    assert_true(fabs(v.bias.value) + v.bias.error <= 0.005);
}

/* Indirect light alone, all that is interpolated: its mean squared error. */
static double indirect(const box *b, const assay_image *image, const char *what)
{
    return judge_and_tell(b, image, what, "IrradianceIndirect", "EIndirect").squared.value;
}

static void one_bounce(void **state)
{
    (void)state;
    static const setting cache[] = {CACHE("2"), {NULL, NULL}};
    static const setting flat[]  = {CACHE("2"), {"gradients", "none"}, {NULL, NULL}};
    static const setting wide[]  = {
         CACHE("2"), {"gradient_limit", "off"}, {"r_max", "0"}, {NULL, NULL}};
    box b;
    open_box(&b);
    assay_image *image = render(&b, cache);
    probe_truth(&b, image, "2", "512");
    check_irradiance(&b, image, "one bounce");
    const double squared = indirect(&b, image, "one bounce");
    assert_true(squared <= 0.04 * 0.04);
    assay_image_destroy(image);
    image = render(&b, flat);
    assert_true(indirect(&b, image, "without gradients") > 1.3 * squared);
    assay_image_destroy(image);
    image = render(&b, wide);
    assert_true(indirect(&b, image, "without limits of R") > 1.3 * squared);
    assay_image_destroy(image);
    close_box(&b);
}

static void all_bounces(void **state)
{
    (void)state;
    static const setting cache[] = {CACHE("inf"), {NULL, NULL}};
    box                  b;
    open_box(&b);
    assay_image *image = render(&b, cache);
    probe_truth(&b, image, "inf", "256");
    check_irradiance(&b, image, "all bounces");
    (void)indirect(&b, image, "all bounces");
    assay_image_destroy(image);
    close_box(&b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_bounce),
        cmocka_unit_test(all_bounces),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
