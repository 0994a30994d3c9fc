/* test_plot.c - strokes, letters, curves and lobes: are they where they should be. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <string.h>

#include "assay/plot.h"
#include "io/canvas.h"
#include "io/stroke_font.h"
#include "support/failing_context.h"
#include "support/near.h"

static const assay_rgb BLACK = {0.0, 0.0, 0.0};

/* What is missing to white, in pixels. */
static double ink(const assay_canvas *c)
{
    double sum = 0.0;
    for (int i = 0; i < c->width * c->height; i++) {
        sum += 1.0 - (double)c->plane[1][i];
    }
    return sum;
}

static float pixel(const assay_image *image, int channel, double x, double y)
{
    static const char *const names[3] = {"R", "G", "B"};
    assay_channel            c;
    assert_true(assay_image_find_channel(image, names[channel], &c));
    return c.data.f32[(size_t)y * (size_t)assay_image_width(image) + (size_t)x];
}

/* A stroke of length L and width w has the area L w + pi w^2 / 4; the smooth edge keeps that of its
 * straight sides, whatever its direction. */
static void strokes_have_their_area(void **state)
{
    for (int k = 0; k < 7; k++) {
        assay_image *image = NULL;
        assay_canvas canvas;
        assert_int_equal(assay_canvas_create(*state, 200, 200, &image), ASSAY_OK);
        assert_true(assay_canvas_open(image, &canvas));
        const double dx = 80.0 * cos(0.9 * k), dy = 80.0 * sin(0.9 * k);
        assay_canvas_stroke(&canvas, 100.3 - dx, 99.1 - dy, 100.3 + dx, 99.1 + dy, 4.0, BLACK);
        assert_near(ink(&canvas), 160.0 * 4.0 + 3.14159265 * 4.0, 3.0);
        assay_image_destroy(image);
    }
}

/* Strokes far outside leave nothing and reach nowhere. */
static void strokes_are_cut_off(void **state)
{
    assay_image *image = NULL;
    assay_canvas canvas;
    assert_int_equal(assay_canvas_create(*state, 20, 10, &image), ASSAY_OK);
    assert_true(assay_canvas_open(image, &canvas));
    assay_canvas_stroke(&canvas, -50.0, -50.0, -3.0, 1e7, 4.0, BLACK);
    assay_canvas_stroke(&canvas, 30.0, 5.0, 1e8, 5.0, 4.0, BLACK);
    assert_near(ink(&canvas), 0.0, 0.0);
    assay_canvas_stroke(&canvas, -1e6, 5.0, 1e6, 5.0, 2.0, BLACK);
    assert_near(ink(&canvas), 40.0, 1e-3);
    assay_image_destroy(image);
}

/* Every letter is made of whole strokes on its grid, and drawn inside its box. */
static void letters_stay_in_their_boxes(void **state)
{
    for (int code = 33; code < 127; code++) {
        const char   text[2] = {(char)code, '\0'};
        const char  *glyph   = assay_stroke_glyph((char)code);
        assay_image *image   = NULL;
        assay_canvas canvas;
        assert_true(strlen(glyph) >= 4);
        assert_true(strspn(glyph, "0123456789abc ") == strlen(glyph));
        assert_int_equal(assay_canvas_create(*state, 60, 80, &image), ASSAY_OK);
        assert_true(assay_canvas_open(image, &canvas));
        assert_int_equal(assay_image_draw_text(image, 10.0, 60.0, 32.0, BLACK, text), ASSAY_OK);
        assert_true(ink(&canvas) > 10.0);
        /* Baseline at 60, capitals 32 high, a unit is 4 pixels, the pen 4 wide. */
        for (int y = 0; y < 80; y++) {
            for (int x = 0; x < 60; x++) {
                const bool inside =
                    x >= 7 && x <= 13 + assay_text_width(32.0, text) && y >= 21 && y <= 60 + 15;
                assert_true(inside || canvas.plane[0][y * 60 + x] == 1.0f);
            }
        }
        assay_image_destroy(image);
    }
    assert_near(assay_text_width(8.0, "HH"), 6.0 + STROKE_GAP + 6.0, 1e-12);
    assert_near(assay_text_width(8.0, ""), 0.0, 0.0);
    assert_string_equal(assay_stroke_glyph('\x80'), "");
    assert_string_equal(assay_stroke_glyph('\n'), "");
}

/* A straight curve through the corners of the frame is seen on its diagonal. */
static void curves_are_where_their_points_are(void **state)
{
    const double           x[] = {0.0, 10.0}, y[] = {0.0, 1.0}, flat[] = {0.25, 0.25};
    const assay_plot_curve curves[] = {{"rise", 2, x, y}, {"flat", 2, x, flat}};
    const assay_plot       plot     = {.title       = "t",
                                       .x_label     = "x",
                                       .y_label     = "y",
                                       .x_max       = 10.0,
                                       .y_max       = 1.0,
                                       .curve_count = 2,
                                       .curves      = curves};
    assay_image           *image    = NULL;
    assert_int_equal(assay_plot_draw(*state, &plot, 500, 500, &image), ASSAY_OK);
    /* The frame of 500 x 500: letters 11 high, as plot.c lays it out. */
    const double left = 93.5, right = 478.0, top = 44.0, bottom = 439.5;
    for (int i = 1; i < 5; i++) {
        const double t  = 0.2 * i + 0.03;
        const double px = left + t * (right - left), py = bottom - t * (bottom - top);
        assert_true(pixel(image, 0, px, py) > 2.0f * pixel(image, 2, px, py)); /* red */
    }
    const double level = bottom - 0.25 * (bottom - top), at = left + 0.13 * (right - left);
    assert_true(pixel(image, 2, at, level) > 2.0f * pixel(image, 0, at, level)); /* blue */
    assert_true(pixel(image, 0, left + 0.53 * (right - left), bottom - 0.13 * (bottom - top)) >
                0.99f);
    assay_image_destroy(image);
}

static void bad_plots(void **state)
{
    const double           x[]   = {0.0, NAN};
    const assay_plot_curve curve = {"c", 2, x, x};
    const assay_plot good = {.title = "", .x_label = "", .y_label = "", .x_max = 1.0, .y_max = 1.0};
    assay_image     *image = NULL;
    assay_plot       plot  = good;
    assert_int_equal(assay_plot_draw(*state, &plot, 199, 300, &image), ASSAY_ERR_ARGUMENT);
    assert_int_equal(assay_plot_draw(*state, &plot, 300, 5000, &image), ASSAY_ERR_ARGUMENT);
    plot.y_max = 0.0;
    assert_int_equal(assay_plot_draw(*state, &plot, 300, 300, &image), ASSAY_ERR_ARGUMENT);
    plot       = good;
    plot.x_min = -INFINITY;
    assert_int_equal(assay_plot_draw(*state, &plot, 300, 300, &image), ASSAY_ERR_ARGUMENT);
    plot             = good;
    plot.curves      = &curve;
    plot.curve_count = 1;
    assert_int_equal(assay_plot_draw(*state, &plot, 300, 300, &image), ASSAY_ERR_DOMAIN);
    plot.curve_count = ASSAY_PLOT_MAX_CURVES + 1;
    assert_int_equal(assay_plot_draw(*state, &plot, 300, 300, &image), ASSAY_ERR_ARGUMENT);
    assert_null(image);
    assert_int_equal(assay_image_create(*state, 4, 4, &image), ASSAY_OK);
    assert_int_equal(assay_image_draw_text(image, 0, 0, 8, BLACK, "x"), ASSAY_ERR_ARGUMENT);
    assay_image_destroy(image);
}

static assay_image *draw(assay_context *context, assay_basis_kind kind, int l, int m)
{
    assay_basis *basis = NULL;
    assay_image *image = NULL;
    assert_int_equal(assay_basis_create(context, kind, l + 1, ASSAY_CONVENTION_PLAIN, &basis),
                     ASSAY_OK);
    assert_int_equal(assay_basis_draw(context, basis, (size_t)(l * l + l + m), 120, &image),
                     ASSAY_OK);
    assay_basis_destroy(basis);
    return image;
}

/* +1 warm, -1 cool, 0 white: at a place given in shares of the picture. */
static int color_at(const assay_image *image, double x, double y)
{
    const float r = pixel(image, 0, x * 120.0, y * 120.0),
                b = pixel(image, 2, x * 120.0, y * 120.0);
    return r > 1.5f * b ? 1 : b > 1.5f * r ? -1 : 0;
}

/* z above, x to the lower left and y to the lower right. */
static void lobes_point_along_their_axes(void **state)
{
    static const struct {
        int    m;
        double x, y;
    } cases[] = {{0, 0.5, 0.35}, {1, 0.40, 0.57}, {-1, 0.68, 0.55}};
    for (size_t i = 0; i < 3; i++) {
        assay_image *image = draw(*state, ASSAY_BASIS_SH, 1, cases[i].m);
        assert_int_equal(color_at(image, cases[i].x, cases[i].y), 1);
        assert_int_equal(color_at(image, 1.0 - cases[i].x, 1.0 - cases[i].y), -1);
        assert_int_equal(color_at(image, 0.02, 0.02), 0);
        assay_image_destroy(image);
    }
}

static assay_status draw_both(assay_context *context, void *user)
{
    const assay_plot plot = {.title = "", .x_label = "", .y_label = "", .x_max = 1.0, .y_max = 1.0};
    assay_basis     *basis = NULL;
    assay_image     *image = NULL;
    assay_status     status =
        assay_basis_create(context, ASSAY_BASIS_HSH, 2, ASSAY_CONVENTION_THESIS, &basis);
    (void)user;
    if (status == ASSAY_OK) {
        status = assay_basis_draw(context, basis, 1, 64, &image);
    }
    assay_image_destroy(image);
    image = NULL;
    if (status == ASSAY_OK) {
        status = assay_plot_draw(context, &plot, 200, 200, &image);
    }
    assay_image_destroy(image);
    assay_basis_destroy(basis);
    return status;
}

static void refused_memory_and_bad_functions(void **state)
{
    assay_context *context = *state;
    assay_basis   *basis   = NULL;
    assay_image   *image   = NULL;
    assert_int_equal(
        assay_basis_create(context, ASSAY_BASIS_HSH, 2, ASSAY_CONVENTION_THESIS, &basis), ASSAY_OK);
    assert_int_equal(assay_basis_draw(context, basis, 4, 64, &image), ASSAY_ERR_ARGUMENT);
    assert_int_equal(assay_basis_draw(context, basis, 0, 63, &image), ASSAY_ERR_ARGUMENT);
    assert_int_equal(assay_basis_draw(context, basis, 0, 2049, &image), ASSAY_ERR_ARGUMENT);
    assay_basis_destroy(basis);
    assert_true(failing_each(draw_both, NULL) > 10);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(strokes_have_their_area, counted_set_up, counted_tear_down),
        cmocka_unit_test_setup_teardown(strokes_are_cut_off, counted_set_up, counted_tear_down),
        cmocka_unit_test_setup_teardown(letters_stay_in_their_boxes, counted_set_up,
                                        counted_tear_down),
        cmocka_unit_test_setup_teardown(curves_are_where_their_points_are, counted_set_up,
                                        counted_tear_down),
        cmocka_unit_test_setup_teardown(bad_plots, counted_set_up, counted_tear_down),
        cmocka_unit_test_setup_teardown(lobes_point_along_their_axes, counted_set_up,
                                        counted_tear_down),
        cmocka_unit_test_setup_teardown(refused_memory_and_bad_functions, counted_set_up,
                                        counted_tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
