/* test_environment.c - a latitude-longitude map: where it looks, and what is drawn from it. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "assay/image.h"
#include "core/random.h"
#include "scene/environment.h"
#include "support/failing_context.h"
#include "support/near.h"
#include "support/statistics.h"

static const long double PI_L = 3.14159265358979323846264338327950288L;

/* ---- maps ---- */

typedef assay_rgb (*texel_function)(int column, int row);

static assay_rgb numbered(int column, int row)
{
    return rgb(column + 1.0, row + 1.0, 1.0 + 100.0 * column + row);
}

static assay_rgb black(int column, int row)
{
    (void)column;
    (void)row;
    return rgb_grey(0.0);
}

static assay_rgb white(int column, int row)
{
    (void)column;
    (void)row;
    return rgb_grey(1.0);
}

/* Bright spots, dark areas, and black ones. */
static assay_rgb spotty(int column, int row)
{
    const int hash = (column * 7919 + row * 104729 + column * row * 31) % 17;
    return hash == 0   ? rgb(50.0, 20.0, 5.0)
           : hash < 5  ? rgb_grey(0.0)
           : hash < 10 ? rgb(0.01, 0.02, 0.5)
                       : rgb(1.0, 0.5 + row, 0.25);
}

static assay_rgb pole_alone(int column, int row)
{
    return row == 0 && column == 3 ? rgb(1.0, 2.0, 3.0) : rgb_grey(0.0);
}

static assay_image *make_map(assay_context *context, int width, int height, texel_function texel)
{
    static const char *const names[] = {"R", "G", "B"};
    assay_image             *image   = NULL;
    assert_int_equal(assay_image_create(context, width, height, &image), ASSAY_OK);
    for (int c = 0; c < 3; c++) {
        assay_channel channel;
        assert_int_equal(assay_image_add_channel(image, names[c], ASSAY_CHANNEL_FLOAT, &channel),
                         ASSAY_OK);
        for (int i = 0; i < width * height; i++) {
            const assay_rgb value = texel(i % width, i / width);
            channel.data.f32[i]   = (float)(c == 0 ? value.r : c == 1 ? value.g : value.b);
        }
    }
    return image;
}

static assay_environment *make_environment(assay_context *context, int width, int height,
                                           texel_function texel, double scale, double rotation)
{
    assay_environment *e     = NULL;
    assay_image       *image = make_map(context, width, height, texel);
    assert_int_equal(assay_environment_create(context, image, scale, rotation, "map", &e),
                     ASSAY_OK);
    assay_image_destroy(image);
    return e;
}

/* The direction at (x, y) of the map, in texels, from the definition: row 0 up, the middle to -Z,
 * columns to the right of who looks there from inside, with up +Y: to +X. */
static assay_vec3 direction_at(double x, double y, int width, int height)
{
    const double phi = 2.0 * (double)PI_L * (x / width - 0.5), theta = (double)PI_L * y / height;
    return vec3(sin(theta) * sin(phi), cos(theta), -sin(theta) * cos(phi));
}

/* About +Y, counter-clockwise as seen from above. */
static assay_vec3 turned(assay_vec3 d, double angle)
{
    return vec3(d.x * cos(angle) + d.z * sin(angle), d.y, d.z * cos(angle) - d.x * sin(angle));
}

static long double texel_angle(int row, int width, int height)
{
    return 2.0L * PI_L / width * (cosl(PI_L * row / height) - cosl(PI_L * (row + 1) / height));
}

/* ---- where it looks ---- */

static void check_texel(const assay_environment *e, assay_vec3 d, int column, int row)
{
    const assay_rgb value = assay_environment_radiance(e, d);
    assert_near(value.r, column + 1.0, 0.0);
    assert_near(value.g, row + 1.0, 0.0);
}

static void main_directions(void **state)
{
    const double       quarter = 0.5 * (double)PI_L;
    const double       a       = 1e-3; /* off the borders of the texels */
    assay_environment *e       = make_environment(*state, 8, 5, numbered, 1.0, 0.0);
    /* All columns meet at the poles. */
    assert_near(assay_environment_radiance(e, vec3(0.0, 1.0, 0.0)).g, 1.0, 0.0);
    assert_near(assay_environment_radiance(e, vec3(0.0, -1.0, 0.0)).g, 5.0, 0.0);
    check_texel(e, vec3(a, 0.0, -1.0), 4, 2);
    check_texel(e, vec3(-a, 0.0, -1.0), 3, 2);
    check_texel(e, vec3(1.0, 0.0, a), 6, 2);
    check_texel(e, vec3(-1.0, 0.0, -a), 2, 2);
    check_texel(e, vec3(a, 0.0, 1.0), 7, 2);
    check_texel(e, vec3(-a, 0.0, 1.0), 0, 2);
    assay_environment_destroy(e);
    /* A quarter turn counter-clockwise from above takes what was at -Z to -X. */
    e = make_environment(*state, 8, 5, numbered, 1.0, quarter);
    check_texel(e, vec3(-1.0, 0.0, -a), 4, 2);
    check_texel(e, vec3(a, 0.0, -1.0), 6, 2);
    assay_environment_destroy(e);
}

typedef assay_vec3 (*turner)(assay_vec3 d, double angle);

static assay_vec3 turned_back(assay_vec3 d, double angle) { return turned(d, -angle); }

/* Every texel at five places inside. */
static bool finds_every_texel(const assay_environment *e, int width, int height, double rotation,
                              turner turn)
{
    static const double in[][2] = {
        {0.5, 0.5}, {0.01, 0.01}, {0.99, 0.01}, {0.01, 0.99}, {0.99, 0.99}};
    for (int i = 0; i < width * height * 5; i++) {
        const int        column = i / 5 % width, row = i / 5 / width;
        const assay_vec3 d = direction_at(column + in[i % 5][0], row + in[i % 5][1], width, height);
        const assay_rgb  value = assay_environment_radiance(e, turn(d, rotation));
        if (value.r != column + 1.0 || value.g != row + 1.0) {
            return false;
        }
    }
    return true;
}

static void every_texel_is_where_it_should_be(void **state)
{
    static const double rotations[] = {0.0, 0.7, -2.0, 3.14159, 100.0};
    for (int i = 0; i < 5; i++) {
        assay_environment *e = make_environment(*state, 13, 9, numbered, 1.0, rotations[i]);
        assert_true(finds_every_texel(e, 13, 9, rotations[i], turned));
        assert_true(i == 0 || i == 3 || !finds_every_texel(e, 13, 9, rotations[i], turned_back));
        assay_environment_destroy(e);
    }
}

/* ---- integrals ---- */

/* Solid angle of a texel as one takes it at the centre of its row: the mutant. */
static long double rough_angle(int row, int width, int height)
{
    return 2.0L * PI_L / width * PI_L / height * sinl(PI_L * (row + 0.5L) / height);
}

typedef long double (*angle_function)(int row, int width, int height);

static long double pdf_integral(const assay_environment *e, int width, int height,
                                angle_function angle)
{
    long double sum = 0.0L;
    for (int i = 0; i < width * height; i++) {
        sum += assay_environment_pdf(
                   e, direction_at(i % width + 0.5, i / width + 0.5, width, height)) *
               angle(i / width, width, height);
    }
    return sum;
}

static void densities_integrate_to_one(void **state)
{
    static const int      sizes[][2] = {{1, 1}, {2, 1}, {1, 2}, {13, 9}, {64, 32}};
    static texel_function maps[]     = {numbered, white, spotty};
    for (int i = 0; i < 15; i++) {
        const int          width = sizes[i % 5][0], height = sizes[i % 5][1];
        assay_environment *e = make_environment(*state, width, height, maps[i / 5], 2.5, 0.0);
        if (!(i / 5 == 2 && width * height < 3)) { /* there the spotty map is one spot or black */
            const long double integral = pdf_integral(e, width, height, texel_angle);
            assert_near((double)integral, 1.0, 1e-13);
            assert_true(fabsl(pdf_integral(e, width, height, rough_angle) - 1.0L) > 1e-5L);
        }
        assay_environment_destroy(e);
    }
}

static void integrals_are_sums_over_texels(void **state)
{
    assay_environment *e      = make_environment(*state, 32, 17, spotty, 3.0, 0.4);
    long double        sum[3] = {0.0L};
    for (int i = 0; i < 32 * 17; i++) {
        const assay_rgb   value = spotty(i % 32, i / 32);
        const long double angle = 3.0L * texel_angle(i / 32, 32, 17);
        sum[0] += (float)value.r * angle;
        sum[1] += (float)value.g * angle;
        sum[2] += (float)value.b * angle;
    }
    const assay_rgb integral = assay_environment_integral(e);
    assert_near(integral.r, (double)sum[0], 1e-12 * (double)sum[0]);
    assert_near(integral.g, (double)sum[1], 1e-12 * (double)sum[1]);
    assert_near(integral.b, (double)sum[2], 1e-12 * (double)sum[2]);
    assay_environment_destroy(e);
    e = make_environment(*state, 7, 3, white, 1.0, 0.0);
    assert_near(assay_environment_integral(e).g, 4.0 * (double)PI_L, 1e-14);
    assay_environment_destroy(e);
}

/* ---- samples ---- */

static double random_pair(uint32_t k, double *u2_out)
{
    assay_random random = assay_random_start(17, ASSAY_STAGE_TEST, k, 0);
    const double u1     = assay_random_next(&random);
    *u2_out             = assay_random_next(&random);
    return u1;
}

/* What sample says of its density is what pdf says of its direction, but where a direction within
 * rounding of a border is found on the other side. */
static void samples_know_their_density(void **state)
{
    assay_environment *e         = make_environment(*state, 64, 32, spotty, 1.0, 0.3);
    int                different = 0;
    for (uint32_t k = 0; k < 20000; k++) {
        double           u2, pdf;
        const double     u1 = random_pair(k, &u2);
        const assay_vec3 d  = assay_environment_sample(e, u1, u2, &pdf);
        assert_near(vec3_length(d), 1.0, 1e-15);
        assert_true(pdf > 0.0);
        assert_true(!rgb_is_black(assay_environment_radiance(e, d)));
        different += assay_environment_pdf(e, d) != pdf;
    }
    assert_int_equal(different, 0);
    assay_environment_destroy(e);
}

/* Radiance over density has the integral for its mean.  Of luminance it is the same number for
 * every sample: importance sampling without any variance. */
static void luminance_over_density_is_constant(void **state)
{
    assay_environment *e     = make_environment(*state, 64, 32, spotty, 1.0, 0.0);
    const double       total = rgb_luminance(assay_environment_integral(e));
    statistics_mean    red   = {0};
    for (uint32_t k = 0; k < 20000; k++) {
        double           u2, pdf;
        const double     u1       = random_pair(k, &u2);
        const assay_vec3 d        = assay_environment_sample(e, u1, u2, &pdf);
        const assay_rgb  radiance = assay_environment_radiance(e, d);
        assert_near(rgb_luminance(radiance) / pdf, total, 1e-9 * total);
        statistics_mean_add(&red, radiance.r / pdf);
    }
    const double error = statistics_mean_error(&red);
    assert_near(red.mean, assay_environment_integral(e).r, 4.0 * error);
    assert_true(fabs(red.mean - 1.05 * assay_environment_integral(e).r) > 4.0 * error);
    assay_environment_destroy(e);
}

/* The density as one would have it without the solid angle of the rows: the mutant. */
static double flat_pdf(const void *context, assay_vec3 d)
{
    const double sine = sqrt(fmax(0.0, 1.0 - d.y * d.y));
    return assay_environment_pdf(context, d) / fmax(sine, 1e-6) * 0.7;
}

static double real_pdf(const void *context, assay_vec3 d)
{
    return assay_environment_pdf(context, d);
}

static bool draw(const void *context, const double u[3], assay_vec3 *direction_out)
{
    double pdf;
    *direction_out = assay_environment_sample(context, u[0], u[1], &pdf);
    return true;
}

/* The statistics' poles are at +-Z; the map's borders run across its cells, so cells are small and
 * the quadrature adaptive. */
static void samples_follow_the_density(void **state)
{
    assay_environment       *e    = make_environment(*state, 6, 3, numbered, 1.0, 0.25);
    const statistics_grid    grid = statistics_grid_between(-1.0, 1.0, 24, 24);
    const statistics_verdict good = statistics_test_sampler(&grid, real_pdf, draw, e, 100000, 4);
    assert_true(good.p > 1e-3);
    assert_near(good.mass, 1.0, 1e-4);
    const statistics_verdict bad = statistics_test_sampler(&grid, flat_pdf, draw, e, 100000, 4);
    assert_true(bad.p < 1e-6);
    assay_environment_destroy(e);
}

/* Counts in the map's own texels, halved: uniform inside too. */
static void samples_are_uniform_inside_texels(void **state)
{
    enum { WIDTH = 5, HEIGHT = 4, DRAWS = 200000 };
    assay_environment *e = make_environment(*state, WIDTH, HEIGHT, numbered, 1.0, 0.0);
    double             counts[HEIGHT * 2][WIDTH * 2] = {{0.0}};
    double             chi = 0.0, total = 0.0;
    for (uint32_t k = 0; k < DRAWS; k++) {
        double           u2, pdf;
        const double     u1 = random_pair(k, &u2);
        const assay_vec3 d  = assay_environment_sample(e, u1, u2, &pdf);
        const double     x  = (atan2(d.x, -d.z) / (2.0 * (double)PI_L) + 0.5) * WIDTH * 2.0;
        const double     y  = acos(d.y) / (double)PI_L * HEIGHT * 2.0;
        counts[(int)y][(int)x] += 1.0;
    }
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        total += rgb_luminance(numbered(i % WIDTH, i / WIDTH)) *
                 (double)texel_angle(i / WIDTH, WIDTH, HEIGHT);
    }
    for (int i = 0; i < WIDTH * HEIGHT * 4; i++) {
        const int    column = i % (2 * WIDTH), row = i / (2 * WIDTH);
        const double expected = DRAWS * rgb_luminance(numbered(column / 2, row / 2)) *
                                (double)texel_angle(row, 2 * WIDTH, 2 * HEIGHT) / total;
        chi += (counts[row][column] - expected) * (counts[row][column] - expected) / expected;
    }
    assert_true(statistics_chi_square_tail(chi, WIDTH * HEIGHT * 4 - 1) > 1e-3);
    assay_environment_destroy(e);
}

static void poles_are_like_any_place(void **state)
{
    assay_environment *e     = make_environment(*state, 8, 6, pole_alone, 1.0, 0.0);
    const double       angle = (double)texel_angle(0, 8, 6);
    for (uint32_t k = 0; k < 1000; k++) {
        double           u2, pdf;
        const double     u1 = k == 0 ? 0.0 : random_pair(k, &u2);
        const assay_vec3 d  = assay_environment_sample(e, u1, k == 0 ? 0.0 : u2, &pdf);
        assert_near(pdf, 1.0 / angle, 1e-14 / angle);
        assert_true(d.y >= cos((double)PI_L / 6.0) - 1e-15 && vec3_finite(d));
    }
    assert_true(assay_environment_pdf(e, vec3(0.0, -1.0, 0.0)) == 0.0);
    assert_true(assay_environment_pdf(e, vec3(0.0, 1.0, 0.0)) == 0.0);
    assay_environment_destroy(e);
}

static void a_black_map_is_legal(void **state)
{
    assay_environment *e   = make_environment(*state, 4, 2, black, 1.0, 0.0);
    double             pdf = -1.0;
    const assay_vec3   d   = assay_environment_sample(e, 0.3, 0.6, &pdf);
    assert_true(pdf == 0.0 && vec3_finite(d));
    assert_true(assay_environment_pdf(e, vec3(0.0, 0.0, 1.0)) == 0.0);
    assert_true(rgb_is_black(assay_environment_integral(e)));
    assay_environment_destroy(e);
    e = make_environment(*state, 4, 2, white, 0.0, 0.0);
    assert_true(rgb_is_black(assay_environment_radiance(e, d)));
    assay_environment_destroy(e);
    assay_environment_destroy(NULL);
}

/* ---- what is refused ---- */

static void bad_maps_are_refused(void **state)
{
    static const float bad[] = {NAN, -1e-30f, INFINITY, -INFINITY};
    assay_image       *image = make_map(*state, 4, 2, white), *grey = NULL;
    assay_environment *e = NULL;
    assay_channel      green;
    assert_true(assay_image_find_channel(image, "G", &green));
    for (int i = 0; i < 4; i++) {
        green.data.f32[5] = bad[i];
        assert_int_equal(assay_environment_create(*state, image, 1.0, 0.0, "map.exr", &e),
                         ASSAY_ERR_FORMAT);
        assert_non_null(strstr(assay_context_error(*state), "map.exr"));
        assert_non_null(strstr(assay_context_error(*state), "column 1, row 1"));
    }
    green.data.f32[5] = 3e38f;
    assert_int_equal(assay_environment_create(*state, image, 1e300, 0.0, "map.exr", &e),
                     ASSAY_ERR_LIMIT);
    assert_int_equal(assay_image_create(*state, 4, 2, &grey), ASSAY_OK);
    assert_int_equal(assay_image_add_channel(grey, "Y", ASSAY_CHANNEL_FLOAT, NULL), ASSAY_OK);
    assert_int_equal(assay_environment_create(*state, grey, 1.0, 0.0, "map.exr", &e),
                     ASSAY_ERR_FORMAT);
    assert_non_null(strstr(assay_context_error(*state), "R, G and B"));
    assert_null(e);
    assay_image_destroy(image);
    assay_image_destroy(grey);
}

static assay_status make_one(assay_context *context, void *user)
{
    static const char *const names[] = {"R", "G", "B"};
    assay_image             *image   = NULL;
    assay_environment       *e       = NULL;
    assay_status             status  = assay_image_create(context, 4, 2, &image);
    (void)user;
    for (int c = 0; c < 3 && status == ASSAY_OK; c++) {
        status = assay_image_add_channel(image, names[c], ASSAY_CHANNEL_FLOAT, NULL);
    }
    if (status == ASSAY_OK) {
        status = assay_environment_create(context, image, 1.0, 0.0, "map", &e);
    }
    assay_image_destroy(image);
    assay_environment_destroy(e);
    return status;
}

static void refused_memory_is_reported(void **state)
{
    (void)state;
    assert_int_equal(failing_each(make_one, NULL), 8 + 1 + 4 + 1 + 4);
}

/* The maps that are read must be usable as they are. */
static void shared_maps_light_scenes(void **state)
{
    static const char *const files[] = {"grace_latlong.exr", "royal_esplanade_1k.hdr",
                                        "spiaggia_di_mondello_1k.hdr"};
    const char              *named   = getenv("ASSAY_SHARED_SCENES");
    const char              *root    = named ? named : "../shared/scenes";
    if (access(root, R_OK) != 0) {
        skip();
    }
    for (int i = 0; i < 3; i++) {
        char               path[600];
        assay_image       *image = NULL;
        assay_environment *e     = NULL;
        double             pdf;
        snprintf(path, sizeof path, "%s/hdri/%s", root, files[i]);
        assert_int_equal(assay_image_read(*state, path, &image), ASSAY_OK);
        assert_int_equal(assay_environment_create(*state, image, 1.0, 0.0, path, &e), ASSAY_OK);
        const assay_rgb integral = assay_environment_integral(e);
        assert_true(rgb_finite(integral) && rgb_luminance(integral) > 0.0);
        const assay_vec3 d = assay_environment_sample(e, 0.5, 0.5, &pdf);
        assert_near(rgb_luminance(assay_environment_radiance(e, d)) / pdf, rgb_luminance(integral),
                    1e-6 * rgb_luminance(integral));
        assay_environment_destroy(e);
        assay_image_destroy(image);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(main_directions, counted_set_up, counted_tear_down),
        cmocka_unit_test_setup_teardown(every_texel_is_where_it_should_be, counted_set_up,
                                        counted_tear_down),
        cmocka_unit_test_setup_teardown(densities_integrate_to_one, counted_set_up,
                                        counted_tear_down),
        cmocka_unit_test_setup_teardown(integrals_are_sums_over_texels, counted_set_up,
                                        counted_tear_down),
        cmocka_unit_test_setup_teardown(samples_know_their_density, counted_set_up,
                                        counted_tear_down),
        cmocka_unit_test_setup_teardown(luminance_over_density_is_constant, counted_set_up,
                                        counted_tear_down),
        cmocka_unit_test_setup_teardown(samples_follow_the_density, counted_set_up,
                                        counted_tear_down),
        cmocka_unit_test_setup_teardown(samples_are_uniform_inside_texels, counted_set_up,
                                        counted_tear_down),
        cmocka_unit_test_setup_teardown(poles_are_like_any_place, counted_set_up,
                                        counted_tear_down),
        cmocka_unit_test_setup_teardown(a_black_map_is_legal, counted_set_up, counted_tear_down),
        cmocka_unit_test_setup_teardown(bad_maps_are_refused, counted_set_up, counted_tear_down),
        cmocka_unit_test(refused_memory_is_reported),
        cmocka_unit_test_setup_teardown(shared_maps_light_scenes, counted_set_up,
                                        counted_tear_down)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
