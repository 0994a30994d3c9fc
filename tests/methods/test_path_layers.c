/* test_path_layers.c - layers against each other and against the geometry.
 *
 * The scene of the G-buffer is a tilted quad whose points, coordinates and numbers follow from the
 * pixel by hand, one quad that is seen from behind, and one that glTF culls. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#include "support/gltf_maker.h"
#include "support/measure.h"
#include "support/near.h"

/* ---- sums ---- */

typedef struct {
    const char *whole, *parts[2];
} layer_sum;

static const float *channel(const assay_image *image, const char *layer, char letter)
{
    char          name[64];
    assay_channel found;
    snprintf(name, sizeof name, "%s%c", layer, letter);
    if (!assay_image_find_channel(image, name, &found)) {
        fail_msg("no channel %s", name);
    }
    return found.data.f32;
}

/* Largest deviation of the whole from the sum of its parts, in roundings to float of the whole. */
static double deviation_from_sum(const assay_image *image, layer_sum sum)
{
    const int pixels  = assay_image_width(image) * assay_image_height(image);
    double    largest = 0.0;
    for (const char *letter = "RGB"; *letter; letter++) {
        const float *whole = channel(image, sum.whole, *letter);
        const float *a     = channel(image, sum.parts[0], *letter);
        const float *b     = channel(image, sum.parts[1], *letter);
        for (int i = 0; i < pixels; i++) {
            const double expected = (double)a[i] + (double)b[i];
            largest = fmax(largest, fabs((double)whole[i] - expected) / (fabs(expected) + 1e-30));
        }
    }
    return largest / 0x1p-24;
}

/* Three roundings: of the whole and of each part. */
static void parts_add_up(void **state)
{
    (void)state;
    static const layer_sum SUMS[]   = {{"", {"Direct.", "Indirect."}},
                                       {"Irradiance.", {"IrradianceDirect.", "IrradianceIndirect."}}};
    static const layer_sum MUTANT   = {"", {"Direct.", "Direct."}};
    const setting          tests[3] = {{"spp", "8"}, {"roulette_depth", "2"}, {NULL, NULL}};
    assay_context         *context  = measure_context(2);
    assay_scene           *scene    = NULL;
    assert_int_equal(assay_scene_load(context, "scenes/cornell-box-glossy/cornell-box-glossy.gltf",
                                      NULL, &scene),
                     ASSAY_OK);
    assay_image *image = measure_render(scene, tests, 24, 24, NULL);
    assert_true(measure_mean(image, "Indirect.R").value > 0.01);
    for (int i = 0; i < 2; i++) {
        assert_true(deviation_from_sum(image, SUMS[i]) <= 3.0);
    }
    assert_true(deviation_from_sum(image, MUTANT) > 1e3);
    assay_image_destroy(image);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

/* One bounce has no indirect part; none has no irradiance. */
static void few_bounces(void **state)
{
    (void)state;
    assay_context *context = measure_context(1);
    assay_scene   *scene   = NULL;
    assert_int_equal(assay_scene_load(context, "scenes/cornell-box/cornell-box.gltf", NULL, &scene),
                     ASSAY_OK);
    for (int bounces = 0; bounces <= 1; bounces++) {
        const setting settings[] = {{"bounces", bounces ? "1" : "0"}, {"spp", "4"}, {NULL, NULL}};
        assay_image  *image      = measure_render(scene, settings, 16, 16, NULL);
        assert_true(measure_mean(image, "R").value > 0.0);
        assert_true(measure_mean(image, "Indirect.R").value == 0.0);
        assert_true(measure_mean(image, "IrradianceIndirect.R").value == 0.0);
        assert_true((measure_mean(image, "IrradianceDirect.R").value > 0.0) == (bounces == 1));
        assay_image_destroy(image);
    }
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

/* ---- G-buffer ---- */

static const double EYE[3]    = {0.5, 0.25, 5.0};
static const double YFOV      = 0.6;
static const double SHADE[3]  = {0.2, 0.1, 1.0};  /* of the tilted quad             */
static const double BEHIND[3] = {0.1, 0.0, -1.0}; /* of the one seen from behind   */

static void add_quad(gltf_maker *m, const float corners[12], const double *normal, int material)
{
    static const float    uv[8]       = {0, 1, 1, 1, 1, 0, 0, 0};
    static const uint16_t indices[6]  = {0, 1, 2, 0, 2, 3};
    const int             positions   = gltf_floats(m, "VEC3", 4, corners);
    const int             texcoords   = gltf_floats(m, "VEC2", 4, uv);
    const int             triangles   = gltf_shorts(m, 6, indices);
    char                  normals[32] = "";
    if (normal) {
        const double length =
            sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
        float values[12];
        for (int i = 0; i < 12; i++) {
            values[i] = (float)(normal[i % 3] / length);
        }
        snprintf(normals, sizeof normals, ",\"NORMAL\":%d", gltf_floats(m, "VEC3", 4, values));
    }
    gltf_shown_mesh(m,
                    "\"attributes\":{\"POSITION\":%d,\"TEXCOORD_0\":%d%s},\"indices\":%d,"
                    "\"material\":%d",
                    positions, texcoords, normals, triangles, material);
}

static assay_scene *three_quads(assay_context *context)
{
    /* z = x / 4 */
    static const float tilted[12] = {-2, -1, -0.5F, 2, -1, 0.5F, 2, 1, 0.5F, -2, 1, -0.5F};
    static const float behind[12] = {-2, 2, 0, 2, 2, 0, 2, 1.25F, 0, -2, 1.25F, 0};
    static const float culled[12] = {-2, -1.25F, 0, 2, -1.25F, 0, 2, -2, 0, -2, -2, 0};
    gltf_maker        *m          = gltf_maker_create();
    gltf_add(m, "materials", "\"name\":\"of nothing\"");
    gltf_add(m, "materials", "\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.2,0.4,0.6,1]}");
    gltf_add(m, "materials",
             "\"doubleSided\":true,\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.3,0.5,0.7,1]},"
             "\"extensions\":{\"KHR_materials_unlit\":{}}");
    add_quad(m, tilted, SHADE, 1);
    add_quad(m, behind, BEHIND, 2);
    add_quad(m, culled, NULL, 1);
    gltf_add(m, "cameras",
             "\"type\":\"perspective\",\"perspective\":{\"yfov\":%.17g,\"znear\":0.1}", YFOV);
    gltf_add(m, "nodes", "\"camera\":0,\"translation\":[%.17g,%.17g,%.17g]", EYE[0], EYE[1],
             EYE[2]);
    return gltf_load(m, context);
}

typedef struct {
    double   p[3], n[3], ns[3], albedo[3], uv[2], z;
    uint32_t material, primitive;
} expected_point;

static void set_unit(double out[3], const double v[3], double sign)
{
    const double length = sign * sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int i = 0; i < 3; i++) {
        out[i] = v[i] / length;
    }
}

/* What the ray through (i + within, j + within) must find. */
static expected_point expect(int i, int j, int width, int height, double within)
{
    static const double tilt[3]   = {-0.25, 0.0, 1.0};
    static const double toward[3] = {0.0, 0.0, 1.0};
    expected_point      e         = {.material = UINT32_MAX, .primitive = UINT32_MAX};
    const double        half      = tan(0.5 * YFOV);
    const double        dx        = (2.0 * (i + within) / width - 1.0) * half * width / height;
    const double        dy        = (1.0 - 2.0 * (j + within) / height) * half;
    const double        t         = (EYE[2] - 0.25 * EYE[0]) / (1.0 + 0.25 * dx);
    const double        x = EYE[0] + t * dx, y = EYE[1] + t * dy;
    if (fabs(x) <= 2.0 && fabs(y) <= 1.0) {
        e = (expected_point){.p         = {x, y, 0.25 * x},
                             .albedo    = {0.2, 0.4, 0.6},
                             .uv        = {(x + 2.0) / 4.0, (1.0 - y) / 2.0},
                             .z         = t,
                             .material  = 1,
                             .primitive = y < 0.5 * x ? 0 : 1};
        set_unit(e.n, tilt, 1.0);
        set_unit(e.ns, SHADE, 1.0);
        return e;
    }
    const double bx = EYE[0] + EYE[2] * dx, by = EYE[1] + EYE[2] * dy;
    if (fabs(bx) <= 2.0 && by >= 1.25 && by <= 2.0) {
        /* Across the diagonal from (-2, 2) to (2, 1.25). */
        const bool first = by > 1.625 - 0.1875 * bx;
        e                = (expected_point){.p         = {bx, by, 0.0},
                                            .albedo    = {0.3, 0.5, 0.7}, /* though unlit */
                                            .uv        = {(bx + 2.0) / 4.0, (by - 1.25) / 0.75},
                                            .z         = EYE[2],
                                            .material  = 2,
                                            .primitive = first ? 2 : 3};
        set_unit(e.n, toward, 1.0);
        set_unit(e.ns, BEHIND, -1.0);
    }
    return e;
}

static double largest(const assay_image *image, const char *layer, const char *letters, int pixel,
                      const double *expected)
{
    double worst = 0.0;
    for (int c = 0; letters[c]; c++) {
        worst = fmax(worst, fabs((double)channel(image, layer, letters[c])[pixel] - expected[c]));
    }
    return worst;
}

static uint32_t whole_number(const assay_image *image, const char *name, int pixel)
{
    assay_channel found;
    assert_true(assay_image_find_channel(image, name, &found));
    return found.data.u32[pixel];
}

/* Largest deviation of any number of any pixel; an id that differs counts 1. */
static double deviation(const assay_image *image, double within, int found[3])
{
    const int width = assay_image_width(image), height = assay_image_height(image);
    double    worst = 0.0;
    for (int k = 0; k < width * height; k++) {
        const expected_point e = expect(k % width, k / width, width, height, within);
        worst                  = fmax(worst, largest(image, "P.", "XYZ", k, e.p));
        worst                  = fmax(worst, largest(image, "N.", "XYZ", k, e.n));
        worst                  = fmax(worst, largest(image, "Ns.", "XYZ", k, e.ns));
        worst                  = fmax(worst, largest(image, "Albedo.", "RGB", k, e.albedo));
        worst                  = fmax(worst, largest(image, "UV.", "UV", k, e.uv));
        worst                  = fmax(worst, largest(image, "", "Z", k, &e.z));
        worst                  = fmax(worst, whole_number(image, "MaterialId", k) != e.material);
        worst                  = fmax(worst, whole_number(image, "PrimitiveId", k) != e.primitive);
        found[e.material == UINT32_MAX ? 0 : e.material]++;
    }
    return worst;
}

static void gbuffer(void **state)
{
    (void)state;
    const setting  settings[] = {{"spp", "1"}, {NULL, NULL}};
    int            found[3]   = {0};
    assay_context *context    = measure_context(1);
    assay_scene   *scene      = three_quads(context);
    assay_image   *image      = measure_render(scene, settings, 62, 47, "gbuffer");
    /* Floats of numbers up to 5. */
    const double worst = deviation(image, 0.5, found);
    assert_near(worst, 0.0, 5.0 * 0x1p-24 + 1e-9);
    assert_true(found[0] > 200 && found[1] > 200 && found[2] > 200);
    /* Mutant: the corner of the pixel instead of its centre. */
    assert_true(deviation(image, 0.0, found) > 1e-2);
    assay_image_destroy(image);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(parts_add_up),
        cmocka_unit_test(few_bounces),
        cmocka_unit_test(gbuffer),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
