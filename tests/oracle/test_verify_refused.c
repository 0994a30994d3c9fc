/* test_verify_refused.c - each thing that forbids a verdict on images: named, and never a pass. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "assay/verify.h"
#include "support/failing_context.h"
#include "support/normal_images.h"

enum { SIDE = NORMAL_IMAGES_SIDE };

static void expect_problem(assay_context *context, const assay_image *c, const assay_image *r,
                           const char *channels, const char *test, const char *words)
{
    assay_verify_options o = assay_verify_options_default();
    o.channels             = channels;
    assay_verdict      *v  = normal_images_verify(context, c, r, &o);
    const assay_finding f  = normal_images_find(v, test);
    assert_int_equal(assay_verdict_whole(v), ASSAY_VERDICT_CANNOT_TELL);
    assert_int_equal(f.kind, ASSAY_VERDICT_CANNOT_TELL);
    assert_non_null(strstr(f.meaning, words));
    assay_verdict_destroy(v);
}

static void bad_values(void **state)
{
    static const float BAD[] = {NAN, INFINITY, -INFINITY};
    for (int k = 0; k < 3; k++) {
        assay_image *c                  = normal_images_make(*state, 9, 0.5, 64),
                    *r                  = normal_images_make(*state, 10, 0.5, 256);
        normal_images_values(c, "R")[5] = BAD[k];
        expect_problem(*state, c, r, NULL, "finite", "candidate");
        normal_images_values(c, "R")[5] = 1.0F;
        normal_images_values(r, "R")[6] = BAD[k];
        expect_problem(*state, c, r, NULL, "finite", "reference");
        normal_images_values(r, "R")[6]          = 1.0F;
        normal_images_values(c, "Variance.R")[7] = k == 0 ? -1.0F : BAD[k];
        expect_problem(*state, c, r, NULL, "variance", "candidate");
        normal_images_values(c, "Variance.R")[7] = 1.0F;
        normal_images_values(r, "Variance.R")[8] = BAD[k];
        expect_problem(*state, c, r, NULL, "variance", "reference");
        assay_image_destroy(c);
        assay_image_destroy(r);
    }
}

static void missing_channels(void **state)
{
    assay_image *c = normal_images_make(*state, 9, 0.5, 64),
                *r = normal_images_make(*state, 10, 0.5, 256);
    expect_problem(*state, c, r, "R,G", "channel", "candidate does not have");
    normal_images_add(c, "G");
    expect_problem(*state, c, r, "R,G", "channel", "reference does not have");
    assay_channel whole;
    assert_int_equal(assay_image_add_channel(c, "Layer.R", ASSAY_CHANNEL_UINT, &whole), ASSAY_OK);
    normal_images_add(r, "Layer.R");
    expect_problem(*state, c, r, "SampleCount", "channel", "candidate's channel is not of floats");
    expect_problem(*state, c, r, "R,Layer.R", "channel", "candidate's channel is not of floats");
    expect_problem(*state, r, c, "R,Layer.R", "channel", "reference's channel is not of floats");
    /* Half a layer is no layer, a whole one may be left out. */
    expect_problem(*state, c, r, NULL, "channel", "reference does not have");
    expect_problem(*state, r, c, NULL, "channel", "candidate does not have");
    normal_images_add(c, "Direct.R");
    normal_images_add(r, "G");
    normal_images_add(r, "Irradiance.G");
    assay_verdict *v = normal_images_verify(*state, r, c, NULL);
    assert_true(assay_verdict_count(v) > 1);
    for (int i = 0; i < assay_verdict_count(v); i++) {
        assert_string_equal(assay_verdict_at(v, i).stage, "image");
    }
    assay_verdict_destroy(v);
    assay_image_destroy(c);
    assay_image_destroy(r);
}

/* Runs that are one run have no spread, and would make noise a difference. */
static void runs_that_are_one(void **state)
{
    const assay_verify_options o       = assay_verify_options_default();
    assay_verdict             *v       = NULL;
    assay_image               *runs[3] = {normal_images_make(*state, 9, 0.5, 64),
                                          normal_images_make(*state, 10, 0.5, 64),
                                          normal_images_make(*state, 9, 0.5, 64)};
    const assay_image *const  *c       = (const assay_image *const *)runs;
    assay_image               *r       = normal_images_make(*state, 11, 0.5, 256);
    assert_int_equal(assay_verdict_create(*state, "c", "r", &v), ASSAY_OK);
    assert_int_equal(assay_verify_images(c, 2, r, &o, v), ASSAY_OK);
    assert_int_equal(assay_verify_images(c, 3, r, &o, v), ASSAY_ERR_ARGUMENT);
    assert_non_null(strstr(assay_context_error(*state), "runs 1 and 3"));
    for (int k = 0; k < 2; k++) {
        assay_image_set_attribute(runs[k], "assay:method", "path");
        assay_image_set_attribute(runs[k], "assay:version", "1");
        assay_image_set_attribute(runs[k], "assay:seed", k == 0 ? "4" : "5");
    }
    assert_int_equal(assay_verify_images(c, 2, r, &o, v), ASSAY_OK);
    assay_image_set_attribute(runs[1], "assay:seed", "4");
    assert_int_equal(assay_verify_images(c, 2, r, &o, v), ASSAY_ERR_ARGUMENT);
    assert_non_null(strstr(assay_context_error(*state), "seed"));
    assay_verdict_destroy(v);
    for (int k = 0; k < 3; k++) {
        assay_image_destroy(runs[k]);
    }
    assay_image_destroy(r);
}

/* A reference of one sample a pixel, or without variance: not known, whatever its file holds. */
static void reference_without_variance(void **state)
{
    assay_image *c = normal_images_make(*state, 9, 0.5, 64),
                *r = normal_images_make(*state, 10, 0.5, 256);
    assay_channel count;
    assert_true(assay_image_find_channel(r, "SampleCount", &count));
    count.data.u32[100] = 1;
    expect_problem(*state, c, r, NULL, "variance", "two samples");
    assay_verify_options o = assay_verify_options_default();
    o.reference_exact      = true;
    assay_image *better    = normal_images_make(*state, 9, 0.5, 65536);
    assert_int_equal(normal_images_kind(*state, c, better, &o), ASSAY_VERDICT_PASS);
    /* ... and is said to have none: what is better is taken for wrong. */
    assert_int_equal(normal_images_kind(*state, better, r, &o), ASSAY_VERDICT_FAIL);
    assay_image_destroy(better);
    assay_image_destroy(c);
    assay_image_destroy(r);
}

static void refused(void **state)
{
    const assay_image   *c = normal_images_make(*state, 9, 0.5, 64);
    assay_image         *r = normal_images_make(*state, 10, 0.5, 256), *small = NULL;
    assay_verify_options o = assay_verify_options_default();
    assay_verdict       *v = NULL;
    assert_int_equal(assay_verdict_create(*state, "c", "r", &v), ASSAY_OK);
    assert_int_equal(assay_image_create(*state, SIDE, SIDE - 1, &small), ASSAY_OK);
    assert_int_equal(assay_verify_images(&c, 1, small, &o, v), ASSAY_ERR_ARGUMENT);
    assert_non_null(strstr(assay_context_error(*state), "64 x 64"));
    assay_image_destroy(small);
    assert_int_equal(assay_image_create(*state, SIDE, SIDE, &small), ASSAY_OK);
    assert_int_equal(assay_verify_images(&c, 1, small, &o, v), ASSAY_ERR_ARGUMENT);
    assert_non_null(strstr(assay_context_error(*state), "no channel"));
    const struct {
        double level, allow, detect;
        int    tile, count;
    } BAD[] = {{0.0, NAN, NAN, 16, 1},  {0.5, NAN, NAN, 16, 1},  {NAN, NAN, NAN, 16, 1},
               {0.01, 0.0, NAN, 16, 1}, {0.01, NAN, -1, 16, 1},  {0.01, NAN, NAN, 3, 1},
               {0.01, NAN, NAN, 16, 0}, {0.01, NAN, NAN, 16, 65}};
    for (size_t i = 0; i < sizeof BAD / sizeof BAD[0]; i++) {
        o        = assay_verify_options_default();
        o.level  = BAD[i].level;
        o.allow  = BAD[i].allow;
        o.detect = BAD[i].detect;
        o.tile   = BAD[i].tile;
        assert_int_equal(assay_verify_images(&c, BAD[i].count, r, &o, v), ASSAY_ERR_ARGUMENT);
    }
    o                                = assay_verify_options_default();
    static const char *const LISTS[] = {"", "R,", ",R", "R,R"};
    for (int i = 0; i < 4; i++) {
        o.channels = LISTS[i];
        assert_int_equal(assay_verify_images(&c, 1, r, &o, v), ASSAY_ERR_ARGUMENT);
    }
    assert_int_equal(assay_verdict_count(v), 0);
    assay_verdict_destroy(v);
    assay_image_destroy((assay_image *)c);
    assay_image_destroy(small);
    assay_image_destroy(r);
}

static void metadata(void **state)
{
    static const char *const   PAIRS[][3] = {{"assay:scene.digest", "a", "b"},
                                             {"assay:camera.position", "0 0 1", "0 0 2"},
                                             {"assay:scene.time", "0", "1"},
                                             {"assay:scene.background", "0 0 0", "1 1 1"},
                                             {"assay:scene.force_diffuse", "on", "off"}};
    const assay_verify_options o          = assay_verify_options_default();
    for (size_t i = 0; i < sizeof PAIRS / sizeof PAIRS[0]; i++) {
        assay_image *r       = normal_images_make(*state, 10, 0.5, 256),
                    *made    = normal_images_make(*state, 9, 0.5, 64);
        const assay_image *c = made;
        assay_verdict     *v = NULL;
        assert_int_equal(assay_verdict_create(*state, "c", "r", &v), ASSAY_OK);
        assay_image_set_attribute(made, PAIRS[i][0], PAIRS[i][1]);
        assert_int_equal(assay_verify_images(&c, 1, r, &o, v), ASSAY_OK);
        assay_image_set_attribute(r, PAIRS[i][0], PAIRS[i][2]);
        assert_int_equal(assay_verify_images(&c, 1, r, &o, v), ASSAY_ERR_ARGUMENT);
        assert_non_null(strstr(assay_context_error(*state), PAIRS[i][0]));
        assay_verify_options ignore = o;
        ignore.ignore_metadata      = true;
        assert_int_equal(assay_verify_images(&c, 1, r, &ignore, v), ASSAY_OK);
        assay_verdict_destroy(v);
        assay_image_destroy(made);
        assay_image_destroy(r);
    }
}

/* Bounces stand under each method's own name; a picture of records is no light; colours that are
 * said to be encoded are no light either. */
static void metadata_of_methods(void **state)
{
    const assay_verify_options o = assay_verify_options_default();
    assay_image               *r = normal_images_make(*state, 10, 0.5, 256),
                *made            = normal_images_make(*state, 9, 0.5, 64);
    const assay_image *c         = made;
    assay_verdict     *v         = NULL;
    assert_int_equal(assay_verdict_create(*state, "c", "r", &v), ASSAY_OK);
    assay_image_set_attribute(made, "assay:method", "splat");
    assay_image_set_attribute(made, "assay:splat.bounces", "3");
    assay_image_set_attribute(made, "assay:splat.debug", "off");
    assay_image_set_attribute(made, "oiio:ColorSpace", "lin_rec709");
    assay_image_set_attribute(r, "assay:method", "path");
    assay_image_set_attribute(r, "assay:path.bounces", "3");
    assert_int_equal(assay_verify_images(&c, 1, r, &o, v), ASSAY_OK);
    assay_image_set_attribute(r, "assay:path.bounces", "4");
    assert_int_equal(assay_verify_images(&c, 1, r, &o, v), ASSAY_ERR_ARGUMENT);
    assert_non_null(strstr(assay_context_error(*state), "bounces"));
    assay_image_set_attribute(r, "assay:path.bounces", "3");
    assay_image_set_attribute(made, "assay:splat.debug", "weights");
    assert_int_equal(assay_verify_images(&c, 1, r, &o, v), ASSAY_ERR_ARGUMENT);
    assay_image_set_attribute(made, "assay:splat.debug", "off");
    assay_image_set_attribute(made, "oiio:ColorSpace", "sRGB");
    assert_int_equal(assay_verify_images(&c, 1, r, &o, v), ASSAY_ERR_ARGUMENT);
    assert_non_null(strstr(assay_context_error(*state), "sRGB"));
    assay_verdict_destroy(v);
    assay_image_destroy(made);
    assay_image_destroy(r);
}

/* Each way in which an OpenEXR file tells its colours.  Rec. 709, with white in
 * two roundings [bt709, section 1]; Rec. 601 of 625 lines, which has one primary 0.01 away; Display
 * P3; ACES AP0. */
static void colours_of_headers(void **state)
{
    static const struct {
        const char *name, *value;
        bool        fits;
    } CASES[] = {
        {"colorInteropID", "lin_rec709_scene", true},
        {"colorInteropID", "unknown", true},
        {"colorInteropID", "srgb_rec709_scene", false},
        {"colorInteropID", "lin_ap1_scene", false},
        {"colorInteropID", "data", false},
        {"oiio:ColorSpace", "lin_rec709_scene", true},
        {"exr:chromaticities", "0.64 0.33 0.3 0.6 0.15 0.06 0.3127 0.329", true},
        {"exr:chromaticities", "0.64 0.33 0.3 0.6 0.15 0.06 0.31271 0.32902", true},
        {"exr:chromaticities", "0.64 0.33 0.29 0.6 0.15 0.06 0.3127 0.329", false},
        {"exr:chromaticities", "0.68 0.32 0.265 0.69 0.15 0.06 0.3127 0.329", false},
        {"exr:chromaticities", "0.7347 0.2653 0 1 0.0001 -0.077 0.32168 0.33767", false},
        {"exr:chromaticities", "0.64 0.33 0.3 0.6 0.15 0.06 0.3127 nan", false},
        {"exr:chromaticities", "0.64 0.33", false},
        {"exr:acesImageContainerFlag", "0", true},
        {"exr:acesImageContainerFlag", "1", false},
    };
    for (size_t i = 0; i < 2 * sizeof CASES / sizeof CASES[0]; i++) {
        assay_verify_options o = assay_verify_options_default();
        assay_verdict       *v = NULL;
        assay_image         *c = normal_images_make(*state, 9, 0.5, 64),
                    *r         = normal_images_make(*state, 10, 0.5, 256);
        const assay_image *k   = c;
        assay_image_set_attribute(i % 2 ? c : r, CASES[i / 2].name, CASES[i / 2].value);
        assert_int_equal(assay_verdict_create(*state, "c", "r", &v), ASSAY_OK);
        assert_int_equal(assay_verify_images(&k, 1, r, &o, v),
                         CASES[i / 2].fits ? ASSAY_OK : ASSAY_ERR_ARGUMENT);
        if (!CASES[i / 2].fits) {
            assert_non_null(strstr(assay_context_error(*state), CASES[i / 2].value));
            assert_non_null(strstr(assay_context_error(*state), i % 2 ? "candidate" : "reference"));
        }
        o.ignore_metadata = true;
        assert_int_equal(assay_verify_images(&k, 1, r, &o, v), ASSAY_OK);
        assay_verdict_destroy(v);
        assay_image_destroy(c);
        assay_image_destroy(r);
    }
}

static assay_status compare_runs(assay_context *context, void *user)
{
    const assay_image *const  *images = user;
    const assay_verify_options o      = assay_verify_options_default();
    assay_verdict             *v      = NULL;
    assay_status               status = assay_verdict_create(context, "c", "r", &v);
    if (status == ASSAY_OK) {
        status = assay_verify_images(images, 2, images[2], &o, v);
        assert_true(status == ASSAY_OK || assay_verdict_count(v) == 0);
    }
    assay_verdict_destroy(v);
    return status;
}

static void every_refused_block(void **state)
{
    const assay_image *images[3] = {normal_images_make(*state, 50, 0.5, 64),
                                    normal_images_make(*state, 51, 0.5, 64),
                                    normal_images_make(*state, 52, 0.5, 256)};
    assert_true(failing_each(compare_runs, images) > 20);
    for (int k = 0; k < 3; k++) {
        assay_image_destroy((assay_image *)images[k]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(bad_values, counted_set_up, counted_tear_down),
        cmocka_unit_test_setup_teardown(missing_channels, counted_set_up, counted_tear_down),
        cmocka_unit_test_setup_teardown(runs_that_are_one, counted_set_up, counted_tear_down),
        cmocka_unit_test_setup_teardown(reference_without_variance, counted_set_up,
                                        counted_tear_down),
        cmocka_unit_test_setup_teardown(refused, counted_set_up, counted_tear_down),
        cmocka_unit_test_setup_teardown(metadata, counted_set_up, counted_tear_down),
        cmocka_unit_test_setup_teardown(metadata_of_methods, counted_set_up, counted_tear_down),
        cmocka_unit_test_setup_teardown(colours_of_headers, counted_set_up, counted_tear_down),
        cmocka_unit_test_setup_teardown(every_refused_block, counted_set_up, counted_tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
