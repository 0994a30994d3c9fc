/* basis_draw.c - a function of a basis as lobes, as in figure 3.4 of [gautron06].
 *
 * Invariant: the scene is in units in which the largest |f| is 1; the eye looks along -forward
 * without perspective, and +z is up in the picture.  The picture is drawn SAMPLES times as large
 * each way and averaged: smooth edges without any order of drawing. */
#include "assay/plot.h"
#include "basis/triangle_raster.h"
#include "core/alloc.h"
#include "core/context.h"
#include "core/numerics.h"
#include "math/vec.h"

enum { MIN_SIZE = 64, MAX_SIZE = 2048, SAMPLES = 3, RINGS = 180, SECTORS = 360, RING_SIDES = 120 };

static const double AXIS_LENGTH = 1.22, AXIS_RADIUS = 0.008, LINE_RADIUS = 0.005, REACH = 1.32;

static const assay_rgb POSITIVE = {0.80, 0.20, 0.05}, NEGATIVE = {0.04, 0.22, 0.70},
                       AXIS = {0.10, 0.10, 0.10}, HORIZON = {0.55, 0.55, 0.55};

typedef struct {
    assay_triangle_raster raster;
    assay_vec3            right, up, forward; /* of the picture; forward towards the eye */
    assay_vec3            light;
    double                scale;       /* pixels a unit                           */
    double                column, row; /* of the origin, pixels */
} drawing;

static assay_vec3 to_pixels(const drawing *d, assay_vec3 p)
{
    return (assay_vec3){d->column + d->scale * vec3_dot(p, d->right),
                        d->row - d->scale * vec3_dot(p, d->up), vec3_dot(p, d->forward)};
}

/* Both sides of a surface look the same; light comes from over the eye's left shoulder. */
static void add_triangle(drawing *d, assay_vec3 a, assay_vec3 b, assay_vec3 c, assay_rgb color)
{
    const assay_vec3 normal = vec3_cross(vec3_sub(b, a), vec3_sub(c, a));
    const double     length = sqrt(vec3_dot(normal, normal));
    if (length == 0.0) {
        return;
    }
    const double side    = vec3_dot(normal, d->forward) < 0.0 ? -1.0 : 1.0;
    const double lit     = fmax(0.0, side * vec3_dot(normal, d->light) / length);
    const double squared = lit * lit, shine = squared * squared * squared * squared;
    const double shade = 0.25 + 0.75 * lit, white = 0.25 * shine * shine;
    assay_triangle_raster_add(&d->raster, to_pixels(d, a), to_pixels(d, b), to_pixels(d, c),
                              (assay_rgb){fmin(1.0, shade * color.r + white),
                                          fmin(1.0, shade * color.g + white),
                                          fmin(1.0, shade * color.b + white)});
}

/* A thin bar with four sides. */
static void add_bar(drawing *d, assay_vec3 from, assay_vec3 to, double radius, assay_rgb color)
{
    const assay_vec3 along  = vec3_sub(to, from);
    const assay_vec3 helper = fabs(along.z) > fabs(along.x) + fabs(along.y)
                                  ? (assay_vec3){1.0, 0.0, 0.0}
                                  : (assay_vec3){0.0, 0.0, 1.0};
    assay_vec3       s[2]   = {vec3_cross(along, helper), {0.0, 0.0, 0.0}};
    s[1]                    = vec3_cross(along, s[0]);
    assay_vec3 corner[4];
    for (int i = 0; i < 4; i++) {
        const assay_vec3 v = s[i % 2];
        corner[i]          = vec3_scale(v, (i < 2 ? radius : -radius) / sqrt(vec3_dot(v, v)));
    }
    for (int i = 0; i < 4; i++) {
        const assay_vec3 p = corner[i], q = corner[(i + 1) % 4];
        const assay_vec3 a = vec3_add(from, p), b = vec3_add(from, q);
        const assay_vec3 e = vec3_add(to, p), f = vec3_add(to, q);
        add_triangle(d, a, b, f, color);
        add_triangle(d, a, f, e, color);
    }
}

static void add_axes(drawing *d)
{
    const assay_vec3 origin = {0.0, 0.0, 0.0};
    add_bar(d, origin, (assay_vec3){AXIS_LENGTH, 0.0, 0.0}, AXIS_RADIUS, AXIS);
    add_bar(d, origin, (assay_vec3){0.0, AXIS_LENGTH, 0.0}, AXIS_RADIUS, AXIS);
    add_bar(d, origin, (assay_vec3){0.0, 0.0, AXIS_LENGTH}, AXIS_RADIUS, AXIS);
    for (int i = 0; i < RING_SIDES; i++) {
        const assay_sincos a = assay_sincos_turns((double)i / RING_SIDES);
        const assay_sincos b = assay_sincos_turns((double)(i + 1) / RING_SIDES);
        add_bar(d, (assay_vec3){a.cos, a.sin, 0.0}, (assay_vec3){b.cos, b.sin, 0.0}, LINE_RADIUS,
                HORIZON);
    }
}

static assay_vec3 grid_direction(bool hemisphere, int ring, int sector)
{
    const double       turns = (double)ring / RINGS * (hemisphere ? 0.25 : 0.5);
    const assay_sincos theta = assay_sincos_turns(turns);
    const assay_sincos phi   = assay_sincos_turns((double)(sector % SECTORS) / SECTORS);
    const bool         last  = hemisphere && ring == RINGS;
    return (assay_vec3){theta.sin * phi.cos, theta.sin * phi.sin, last ? 0.0 : theta.cos};
}

/* radius_out: (RINGS + 1) rows of SECTORS, f scaled to a largest |f| of 1. */
static assay_status sample(const assay_basis *basis, size_t function, bool hemisphere,
                           double *values, double *radius_out)
{
    double largest = 0.0;
    for (int i = 0; i <= RINGS; i++) {
        for (int j = 0; j < SECTORS; j++) {
            const assay_status status =
                assay_basis_evaluate(basis, grid_direction(hemisphere, i, j), values);
            if (status != ASSAY_OK) {
                return status;
            }
            radius_out[i * SECTORS + j] = values[function];
            largest                     = fmax(largest, fabs(values[function]));
        }
    }
    for (int i = 0; i < (RINGS + 1) * SECTORS && largest > 0.0; i++) {
        radius_out[i] /= largest;
    }
    return ASSAY_OK;
}

static void add_lobes(drawing *d, bool hemisphere, const double *radius)
{
    for (int i = 0; i < RINGS; i++) {
        for (int j = 0; j < SECTORS; j++) {
            assay_vec3 corner[4];
            double     sum = 0.0;
            for (int k = 0; k < 4; k++) {
                const int    ring = i + k / 2, sector = j + (k == 1 || k == 2);
                const double r = radius[ring * SECTORS + sector % SECTORS];
                corner[k]      = vec3_scale(grid_direction(hemisphere, ring, sector), fabs(r));
                sum += r;
            }
            const assay_rgb color = sum < 0.0 ? NEGATIVE : POSITIVE;
            add_triangle(d, corner[0], corner[1], corner[2], color);
            add_triangle(d, corner[0], corner[2], corner[3], color);
        }
    }
}

/* The origin of a hemisphere is below the middle: there is nothing to be seen under it. */
static void look(drawing *d, int side, bool hemisphere)
{
    const assay_sincos azimuth   = assay_sincos_turns(33.0 / 360.0);
    const assay_sincos elevation = assay_sincos_turns(24.0 / 360.0);
    d->right                     = (assay_vec3){-azimuth.sin, azimuth.cos, 0.0};
    d->forward =
        (assay_vec3){elevation.cos * azimuth.cos, elevation.cos * azimuth.sin, elevation.sin};
    d->up     = vec3_cross(d->forward, d->right);
    d->light  = vec3_add(d->forward, vec3_add(vec3_scale(d->up, 0.7), vec3_scale(d->right, -0.5)));
    d->light  = vec3_scale(d->light, 1.0 / sqrt(vec3_dot(d->light, d->light)));
    d->scale  = 0.5 * side / REACH;
    d->column = 0.5 * side;
    d->row    = (hemisphere ? 0.62 : 0.5) * side;
}

/* Averages of SAMPLES * SAMPLES pixels. */
static void reduce(const assay_triangle_raster *raster, int size, const assay_channel out[3])
{
    for (int y = 0; y < size; y++) {
        for (int x = 0; x < size; x++) {
            float sum[3] = {0.0f, 0.0f, 0.0f};
            for (int i = 0; i < SAMPLES * SAMPLES; i++) {
                const int    row = y * SAMPLES + i / SAMPLES, column = x * SAMPLES + i % SAMPLES;
                const float *color =
                    raster->color + 3 * ((size_t)row * (size_t)raster->side) + 3 * (size_t)column;
                for (int c = 0; c < 3; c++) {
                    sum[c] += color[c];
                }
            }
            for (int c = 0; c < 3; c++) {
                out[c].data.f32[(size_t)y * (size_t)size + (size_t)x] =
                    sum[c] / (float)(SAMPLES * SAMPLES);
            }
        }
    }
}

static void name_axes(const drawing *d, int size, assay_image *image)
{
    static const char *const names[3] = {"x", "y", "z"};
    const double             height   = 0.032 * size;
    for (int i = 0; i < 3; i++) {
        const double     at    = AXIS_LENGTH + 0.05;
        const assay_vec3 tip   = {i == 0 ? at : 0.0, i == 1 ? at : 0.0, i == 2 ? at : 0.0};
        const assay_vec3 pixel = vec3_scale(to_pixels(d, tip), 1.0 / SAMPLES);
        assay_image_draw_text(image, pixel.x - 0.3 * height, pixel.y + 0.4 * height, height, AXIS,
                              names[i]);
    }
}

static assay_status make_image(assay_context *context, const drawing *d, int size,
                               assay_image **image_out)
{
    static const char *const names[3] = {"R", "G", "B"};
    assay_image             *image    = NULL;
    assay_channel            out[3];
    assay_status             status = assay_image_create(context, size, size, &image);
    for (int c = 0; c < 3 && status == ASSAY_OK; c++) {
        status = assay_image_add_channel(image, names[c], ASSAY_CHANNEL_FLOAT, &out[c]);
    }
    for (int c = 0; c < 3 && status == ASSAY_OK; c++) {
        assay_image_find_channel(image, names[c], &out[c]);
    }
    if (status != ASSAY_OK) {
        assay_image_destroy(image);
        return status;
    }
    reduce(&d->raster, size, out);
    name_axes(d, size, image);
    *image_out = image;
    return ASSAY_OK;
}

/* values: count; radius: (RINGS + 1) rows of SECTORS. */
static assay_status draw(assay_context *context, const assay_basis *basis, size_t i, int size,
                         double *values, double *radius, assay_image **image_out)
{
    const bool   hemisphere = assay_basis_kind_is_hemispherical(assay_basis_kind_of(basis));
    drawing      d          = {.raster.context = context};
    assay_status status     = sample(basis, i, hemisphere, values, radius);
    if (status == ASSAY_OK) {
        status = assay_triangle_raster_create(context, SAMPLES * size, &d.raster);
    }
    if (status == ASSAY_OK) {
        look(&d, SAMPLES * size, hemisphere);
        add_axes(&d);
        add_lobes(&d, hemisphere, radius);
        status = make_image(context, &d, size, image_out);
    }
    assay_triangle_raster_destroy(&d.raster);
    return status;
}

assay_status assay_basis_draw(assay_context *context, const assay_basis *basis, size_t i, int size,
                              assay_image **image_out)
{
    if (i >= assay_basis_count(basis) || size < MIN_SIZE || size > MAX_SIZE) {
        return assay_fail(context, ASSAY_ERR_ARGUMENT,
                          "function %zu at %d pixels: the basis has %zu functions, and pictures "
                          "have from %d to %d pixels",
                          i, size, assay_basis_count(basis), MIN_SIZE, MAX_SIZE);
    }
    double      *values = assay_allocate(context, assay_basis_count(basis), sizeof *values);
    double      *radius = assay_allocate(context, (RINGS + 1) * SECTORS, sizeof *radius);
    assay_status status = values && radius
                              ? draw(context, basis, i, size, values, radius, image_out)
                              : assay_fail_memory(context, "a picture");
    assay_release(context, values);
    assay_release(context, radius);
    return status;
}
