/* test_texture.c - texture look-ups against a second implementation, written from the OpenGL
 * specification (4.6, section 8.14.2) in long double, with whole-number wrapping. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/alloc.h"
#include "core/random.h"
#include "scene/scene_data.h"
#include "scene/texture.h"
#include "support/near.h"

/* ---- the second implementation ---- */

static long double srgb_value(long double c)
{
    return c <= 0.04045L ? c / 12.92L : powl((c + 0.055L) / 1.055L, 2.4L);
}

/* Table 8.22: the texel that a wrapped index means. */
static long wrap_index(long i, long n, assay_wrap wrap)
{
    const long period = 2 * n;
    switch (wrap) {
    case ASSAY_WRAP_CLAMP: return i < 0 ? 0 : i >= n ? n - 1 : i;
    case ASSAY_WRAP_REPEAT: return ((i % n) + n) % n;
    case ASSAY_WRAP_MIRROR: break;
    }
    i = ((i % period) + period) % period;
    return i < n ? i : period - 1 - i;
}

/* What a mutant does wrong. */
typedef enum {
    MUTANT_NONE,
    MUTANT_HALF_TEXEL,   /* centres at whole numbers              */
    MUTANT_FILTER_FIRST, /* sRGB decoded after filtering          */
    MUTANT_CLAMP_AS_REPEAT,
    MUTANT_MIRROR_OFF_BY_ONE,
    MUTANT_UPSIDE_DOWN,  /* v = 0 at the bottom row               */
    MUTANT_SWAPPED_WRAP, /* u's mode for v                        */
    MUTANT_COUNT
} mutant;

static long double component(const assay_texture_image *image, long x, long y, int c)
{
    const size_t at = ((size_t)y * image->width + (size_t)x) * 4 + (size_t)c;
    return image->bits == 8 ? ((const uint8_t *)image->texels)[at] / 255.0L
                            : ((const uint16_t *)image->texels)[at] / 65535.0L;
}

static long double plain_texel(const assay_texture_image *image, const assay_texture *t, long i,
                               long j, int c, bool srgb, mutant m)
{
    assay_wrap wrap_u = t->wrap_u, wrap_v = m == MUTANT_SWAPPED_WRAP ? t->wrap_u : t->wrap_v;
    if (m == MUTANT_CLAMP_AS_REPEAT) {
        wrap_u = wrap_u == ASSAY_WRAP_CLAMP ? ASSAY_WRAP_REPEAT : wrap_u;
    }
    if (m == MUTANT_MIRROR_OFF_BY_ONE && wrap_u == ASSAY_WRAP_MIRROR) {
        i += i < 0;
    }
    const long        x = wrap_index(i, (long)image->width, wrap_u);
    const long        y = wrap_index(j, (long)image->height, wrap_v);
    const long double value =
        component(image, x, m == MUTANT_UPSIDE_DOWN ? (long)image->height - 1 - y : y, c);
    return srgb && c < 3 && m != MUTANT_FILTER_FIRST ? srgb_value(value) : value;
}

static long double plain_sample(const assay_texture_image *image, const assay_texture *t,
                                const double uv[2], int c, bool srgb, mutant m)
{
    const long double u = (long double)uv[0] * image->width, v = (long double)uv[1] * image->height;
    if (t->nearest) {
        return plain_texel(image, t, (long)floorl(u), (long)floorl(v), c, srgb,
                           m == MUTANT_FILTER_FIRST ? MUTANT_NONE : m);
    }
    const long double shift = m == MUTANT_HALF_TEXEL ? 0.0L : 0.5L;
    const long        i = (long)floorl(u - shift), j = (long)floorl(v - shift);
    const long double a = u - shift - i, b = v - shift - j;
    const long double value = (1 - a) * (1 - b) * plain_texel(image, t, i, j, c, srgb, m) +
                              a * (1 - b) * plain_texel(image, t, i + 1, j, c, srgb, m) +
                              (1 - a) * b * plain_texel(image, t, i, j + 1, c, srgb, m) +
                              a * b * plain_texel(image, t, i + 1, j + 1, c, srgb, m);
    return srgb && c < 3 && m == MUTANT_FILTER_FIRST ? srgb_value(value) : value;
}

/* ---- a scene of one texture ---- */

typedef struct {
    assay_scene         scene;
    assay_texture       texture;
    assay_texture_image image;
    uint16_t            texels[64 * 64 * 4];
    assay_texture_ref   ref;
} one_texture;

static void make_texture(one_texture *t, uint32_t width, uint32_t height, uint8_t bits)
{
    memset(t, 0, sizeof *t);
    for (size_t i = 0; i < (size_t)width * height * 4; i++) {
        assay_random   random = assay_random_start(bits, ASSAY_STAGE_TEST, i, width);
        const double   u      = assay_random_next(&random);
        const uint16_t value  = (uint16_t)(u * (bits == 8 ? 256.0 : 65536.0));
        if (bits == 8) {
            ((uint8_t *)t->texels)[i] = (uint8_t)value;
        } else {
            t->texels[i] = value;
        }
    }
    t->image          = (assay_texture_image){NULL, width, height, bits, false, t->texels};
    t->scene.images   = &t->image;
    t->scene.textures = &t->texture;
    t->ref.scale[0] = t->ref.scale[1] = 1.0;
    assay_texture_ref_prepare(&t->ref);
}

/* Largest difference over many coordinates in [-3, 4), the borders of texels among them (where,
 * with nearest, both neighbours are right, so those are left out). */
static double largest_difference(const one_texture *t, bool srgb, mutant m)
{
    double largest = 0.0;
    for (uint32_t k = 0; k < 600; k++) {
        assay_random random = assay_random_start(2, ASSAY_STAGE_TEST, k, 0);
        double       uv[2], rgba[4];
        for (int i = 0; i < 2; i++) {
            uv[i] = 7.0 * assay_random_next(&random) - 3.0;
            if (k % 3 == 0 && !t->texture.nearest) {
                const double size = i ? t->image.height : t->image.width;
                uv[i]             = floor(uv[i] * 2.0 * size) / (2.0 * size);
            }
        }
        assay_texture_sample(&t->scene, &t->ref, uv, srgb, rgba);
        for (int c = 0; c < 4; c++) {
            const long double expected = plain_sample(&t->image, &t->texture, uv, c, srgb, m);
            largest                    = fmax(largest, fabs((double)(rgba[c] - expected)));
            assert_true(rgba[c] >= 0.0 && rgba[c] <= 1.0);
        }
    }
    return largest;
}

/* u is off by its rounding times the size (64 * 4 * 2^-53); the filter's slope is at most 1 a
 * texel. */
static const double SLACK = 1e-13;

static void look_ups_agree_with_the_specification(void **state)
{
    static const uint32_t sizes[][2] = {{1, 1}, {2, 3}, {7, 5}, {64, 64}, {1, 64}};
    static one_texture    t;
    double                seen[MUTANT_COUNT] = {0.0};
    (void)state;
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++) {
        for (int mode = 0; mode < 36; mode++) {
            const bool srgb = mode / 18 == 1;
            make_texture(&t, sizes[s][0], sizes[s][1], mode % 2 ? 16 : 8);
            t.texture.wrap_u  = (assay_wrap)(mode % 3);
            t.texture.wrap_v  = (assay_wrap)(mode / 3 % 3);
            t.texture.nearest = mode / 9 % 2;
            for (int m = 0; m < MUTANT_COUNT; m++) {
                seen[m] = fmax(seen[m], largest_difference(&t, srgb, (mutant)m));
            }
        }
    }
    assert_near(seen[MUTANT_NONE], 0.0, SLACK);
    for (int m = MUTANT_NONE + 1; m < MUTANT_COUNT; m++) {
        assert_true(seen[m] > 1e-3);
    }
}

static void texel_centres_give_texels(void **state)
{
    static one_texture t;
    (void)state;
    make_texture(&t, 8, 4, 8);
    for (int i = 0; i < 32; i++) {
        const double uv[2] = {(i % 8 + 0.5) / 8.0, (i / 8 + 0.5) / 4.0};
        double       rgba[4];
        assay_texture_sample(&t.scene, &t.ref, uv, false, rgba);
        for (int c = 0; c < 4; c++) {
            assert_true(rgba[c] == ((const uint8_t *)t.texels)[4 * i + c] / 255.0);
        }
        assay_texture_sample(&t.scene, &t.ref, uv, true, rgba);
        assert_true(rgba[1] == assay_srgb_decode8(((const uint8_t *)t.texels)[4 * i + 1]));
        assert_true(rgba[3] == ((const uint8_t *)t.texels)[4 * i + 3] / 255.0);
    }
}

static void a_constant_image_is_constant(void **state)
{
    static one_texture t;
    (void)state;
    make_texture(&t, 5, 7, 8);
    for (int value = 0; value < 256; value++) {
        memset(t.texels, value, 5 * 7 * 4);
        for (uint32_t k = 0; k < 40; k++) {
            assay_random random = assay_random_start(3, ASSAY_STAGE_TEST, k, 0);
            const double x      = assay_random_next(&random);
            const double uv[2]  = {9.0 * x - 4.0, 9.0 * assay_random_next(&random) - 4.0};
            double       rgba[4];
            assay_texture_sample(&t.scene, &t.ref, uv, false, rgba);
            assert_true(rgba[0] == value / 255.0 && rgba[3] == value / 255.0);
        }
    }
}

static void no_texture_is_white(void **state)
{
    static one_texture t;
    const double       uv[2]   = {0.3, 0.7};
    double             rgba[4] = {0.0};
    (void)state;
    t.ref.texture = ASSAY_NONE;
    assay_texture_sample(&t.scene, &t.ref, uv, true, rgba);
    for (int c = 0; c < 4; c++) {
        assert_true(rgba[c] == 1.0);
    }
}

/* Not a number and infinite count as 0; what is finite is finite, whatever the size. */
static void any_coordinate_is_legal(void **state)
{
    static const double wild[] = {
        NAN,    INFINITY, -INFINITY, 1e30,    -1e30,      1e308,  -1e308, 0x1p52,
        0x1p53, 0x1p63,   0x1p64,    -0x1p31, -0x1p-1074, -1e-17, 1.0,    0x1.fffffffffffffp-1,
        -0.0};
    static one_texture t;
    (void)state;
    make_texture(&t, 7, 5, 8);
    for (int mode = 0; mode < 36; mode++) {
        t.texture.wrap_u  = (assay_wrap)(mode % 3);
        t.texture.wrap_v  = (assay_wrap)(mode / 3 % 3);
        t.texture.nearest = mode / 9 % 2;
        for (int transformed = 0; transformed < 2; transformed++) {
            t.ref.scale[0]  = transformed ? 1e300 : 1.0;
            t.ref.offset[0] = transformed ? -1e308 : 0.0;
            assay_texture_ref_prepare(&t.ref);
            for (size_t i = 0; i < sizeof wild / sizeof *wild; i++) {
                for (size_t j = 0; j < sizeof wild / sizeof *wild; j++) {
                    const double uv[2] = {wild[i], wild[j]};
                    double       rgba[4];
                    assay_texture_sample(&t.scene, &t.ref, uv, true, rgba);
                    for (int c = 0; c < 4; c++) {
                        assert_true(rgba[c] >= 0.0 && rgba[c] <= 1.0);
                    }
                }
            }
        }
        t.ref.scale[0]  = 1.0;
        t.ref.offset[0] = 0.0;
        assay_texture_ref_prepare(&t.ref);
        double       at_nan[4], at_zero[4];
        const double nan_uv[2] = {NAN, INFINITY}, zero_uv[2] = {0.0, 0.0};
        assay_texture_sample(&t.scene, &t.ref, nan_uv, false, at_nan);
        assay_texture_sample(&t.scene, &t.ref, zero_uv, false, at_zero);
        assert_memory_equal(at_nan, at_zero, sizeof at_nan);
    }
}

/* ---- KHR_texture_transform ---- */

static void transform(const assay_texture_ref *ref, const double uv[2], double out[2])
{
    for (int i = 0; i < 2; i++) {
        out[i] = ref->uv_matrix[i][0] * uv[0] + ref->uv_matrix[i][1] * uv[1] + ref->uv_matrix[i][2];
    }
}

static void no_transform_is_exactly_the_identity(void **state)
{
    static const double identity[2][3] = {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}};
    assay_texture_ref   ref            = {.scale = {1.0, 1.0}};
    (void)state;
    assay_texture_ref_prepare(&ref);
    for (int i = 0; i < 2; i++) {
        for (int j = 0; j < 3; j++) {
            assert_true(ref.uv_matrix[i][j] == identity[i][j]);
        }
    }
}

/* Scale, then a turn that is counter-clockwise where v points down, then offset: a quarter turn
 * takes right (1, 0) to up (0, -1). */
static void transforms_in_the_extensions_order(void **state)
{
    const double      quarter  = 1.57079632679489662;
    assay_texture_ref ref      = {.offset = {0.25, -0.5}, .rotation = quarter, .scale = {2.0, 3.0}};
    const double      right[2] = {1.0, 0.0}, down[2] = {0.0, 1.0};
    double            out[2];
    (void)state;
    assay_texture_ref_prepare(&ref);
    transform(&ref, right, out);
    assert_near(out[0], 0.25, 1e-15);
    assert_near(out[1], -2.5, 1e-15);
    transform(&ref, down, out);
    assert_near(out[0], 3.25, 1e-15);
    assert_near(out[1], -0.5, 1e-15);
}

/* Khronos's TextureTransformTest: where its green markers stand, the tip of the arrow must appear,
 * which without a transform is at (0.7778, 0.7778).  Its red marker is the other sense of rotation.
 */
static void arrows_point_at_the_markers(void **state)
{
    static const struct {
        double offset[2], rotation, scale, green[2], slack;
    } rows[] = {
        {{0.0, 0.0}, 0.39269908169872414, 1.0, {0.42095177560159874, 1.0162674857624154}, 1e-7},
        {{0.0, 0.0}, 0.0, 1.5, {0.518544972870134853, 0.518544972870134853}, 1e-7},
        {{-0.2, -0.1}, 0.3, 1.5, {0.43, 0.75}, 0.03}};
    static const double tip    = 0.7778174593052023,
                        red[2] = {1.0162674857624154, 0.42095177560159874};
    double out[2];
    (void)state;
    for (int i = 0; i < 3; i++) {
        assay_texture_ref ref = {.offset   = {rows[i].offset[0], rows[i].offset[1]},
                                 .rotation = rows[i].rotation,
                                 .scale    = {rows[i].scale, rows[i].scale}};
        assay_texture_ref_prepare(&ref);
        transform(&ref, rows[i].green, out);
        assert_near(out[0], tip, rows[i].slack);
        assert_near(out[1], tip, rows[i].slack);
        transform(&ref, red, out);
        assert_true(fabs(out[0] - tip) > 0.1);
    }
}

static void look_ups_apply_the_transform(void **state)
{
    static one_texture t;
    (void)state;
    make_texture(&t, 7, 5, 8);
    const assay_texture_ref plain = t.ref;
    t.ref.offset[0] = 0.3, t.ref.offset[1] = -1.2, t.ref.rotation = 0.7;
    t.ref.scale[0] = 1.7, t.ref.scale[1] = -0.4;
    assay_texture_ref_prepare(&t.ref);
    for (uint32_t k = 0; k < 200; k++) {
        assay_random random = assay_random_start(5, ASSAY_STAGE_TEST, k, 0);
        const double x      = assay_random_next(&random);
        const double uv[2]  = {x, assay_random_next(&random)};
        double       moved[2], a[4], b[4];
        transform(&t.ref, uv, moved);
        assay_texture_sample(&t.scene, &t.ref, uv, true, a);
        assay_texture_sample(&t.scene, &plain, moved, true, b);
        assert_memory_equal(a, b, sizeof a);
        assay_texture_sample(&t.scene, &plain, uv, true, b);
        assert_memory_not_equal(a, b, sizeof a);
    }
}

/* The order of texels in memory changes no look-up; the mutant reads tiles as if they were rows. */
static void tiling_changes_nothing(void **state)
{
    static const uint32_t sizes[][2] = {{1, 1}, {2, 3}, {4, 4}, {7, 5}, {13, 9}, {1, 33}};
    assay_context        *context    = NULL;
    (void)state;
    assert_int_equal(assay_context_create(NULL, &context), ASSAY_OK);
    for (size_t s = 0; s < 2 * sizeof sizes / sizeof *sizes; s++) {
        static one_texture plain, tiled;
        make_texture(&plain, sizes[s / 2][0], sizes[s / 2][1], s % 2 ? 16 : 8);
        make_texture(&tiled, sizes[s / 2][0], sizes[s / 2][1], s % 2 ? 16 : 8);
        const size_t bytes = (size_t)plain.image.width * plain.image.height * plain.image.bits / 2;
        tiled.image.texels = assay_allocate(context, bytes, 1);
        memcpy(tiled.image.texels, plain.image.texels, bytes);
        assert_int_equal(assay_texture_image_tile(context, &tiled.image), ASSAY_OK);
        int seen = 0;
        for (uint32_t k = 0; k < 500; k++) {
            assay_random random = assay_random_start(8, ASSAY_STAGE_TEST, k, 0);
            const double x      = assay_random_next(&random);
            const double uv[2]  = {x, assay_random_next(&random)};
            double       a[4], b[4];
            assay_texture_sample(&plain.scene, &plain.ref, uv, true, a);
            assay_texture_sample(&tiled.scene, &tiled.ref, uv, true, b);
            assert_memory_equal(a, b, sizeof a);
            tiled.image.tiled = false;
            assay_texture_sample(&tiled.scene, &tiled.ref, uv, true, b);
            tiled.image.tiled = true;
            seen += memcmp(a, b, sizeof a) != 0;
        }
        assert_true(seen > 0 || plain.image.width * plain.image.height == 1 ||
                    (plain.image.width == 4 && plain.image.height == 4));
        assay_release(context, tiled.image.texels);
    }
    assay_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(look_ups_agree_with_the_specification),
                                       cmocka_unit_test(texel_centres_give_texels),
                                       cmocka_unit_test(a_constant_image_is_constant),
                                       cmocka_unit_test(no_texture_is_white),
                                       cmocka_unit_test(any_coordinate_is_legal),
                                       cmocka_unit_test(no_transform_is_exactly_the_identity),
                                       cmocka_unit_test(transforms_in_the_extensions_order),
                                       cmocka_unit_test(arrows_point_at_the_markers),
                                       cmocka_unit_test(look_ups_apply_the_transform),
                                       cmocka_unit_test(tiling_changes_nothing)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
