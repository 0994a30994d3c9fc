/* environment.c - a latitude-longitude map as a piecewise constant light.
 *
 * Texel (column c of w, row r of h) is the patch of azimuth [c, c + 1] / w and polar angle
 * [r, r + 1] pi / h.  Heights on the sphere are kept as the pair
 *     top = cos^2(theta / 2), bottom = sin^2(theta / 2),     top + bottom = 1,
 * both linear in the area above them, so that a uniform point of a patch needs one product and one
 * square root, and stays exact at both poles:
 *     y = top - bottom,     sin theta = 2 sqrt(top bottom).
 *
 * Invariant: a patch is drawn with probability proportional to luminance times solid angle, and
 * uniformly inside, so the density is constant over a patch: what pdf returns is what sample used.
 */
#include "scene/environment.h"

#include "assay/image.h"
#include "core/alloc.h"
#include "core/context.h"
#include "core/numerics.h"
#include "math/distribution.h"

static const uint64_t MAX_TEXELS = 1u << 27;

struct assay_environment {
    assay_context       *context;
    uint32_t             width, height;
    float               *texels; /* R, G, B, row by row, unscaled                           */
    double               scale;
    assay_sincos         turn;      /* of the rotation about +Y                             */
    double              *top;       /* height + 1: cos^2(theta / 2) at the edges of the rows */
    double              *bottom;    /* height + 1: sin^2(theta / 2)                         */
    double              *row_angle; /* height: solid angle of one texel of the row, sr      */
    assay_distribution2 *choice;    /* luminance * solid angle                              */
    assay_rgb            integral;  /* W/m2                                                 */
};

typedef struct {
    uint32_t row, column;
} texel_index;

static inline assay_rgb texel_at(const assay_environment *e, uint32_t row, uint32_t column)
{
    const float *t = e->texels + ((size_t)row * e->width + column) * 3;
    return rgb_scale(rgb(t[0], t[1], t[2]), e->scale);
}

static assay_status take_texels(assay_environment *e, const assay_image *image, const char *path)
{
    static const char *const names[3] = {"R", "G", "B"};
    const size_t             count    = (size_t)e->width * e->height;
    for (size_t c = 0; c < 3; c++) {
        assay_channel channel;
        if (!assay_image_find_channel(image, names[c], &channel) ||
            channel.type != ASSAY_CHANNEL_FLOAT) {
            return assay_fail(e->context, ASSAY_ERR_FORMAT,
                              "%s: an environment map needs float channels R, G and B; '%s' is "
                              "missing",
                              path, names[c]);
        }
        for (size_t i = 0; i < count; i++) {
            const float value = channel.data.f32[i];
            if (!(value >= 0.0f) || isinf(value)) {
                return assay_fail(e->context, ASSAY_ERR_FORMAT,
                                  "%s: environment map: channel %s at column %zu, row %zu is %g; "
                                  "radiance must be finite and >= 0",
                                  path, names[c], i % e->width, i / e->width, (double)value);
            }
            e->texels[3 * i + c] = value + 0.0f; /* -0 becomes 0 */
        }
    }
    return ASSAY_OK;
}

static void measure_rows(assay_environment *e)
{
    const double half_step = 0.5 * ASSAY_PI / e->height;
    for (uint32_t r = 0; r <= e->height; r++) {
        /* From the nearer pole, so that both ends are exact. */
        const bool         lower = 2 * r > e->height;
        const uint32_t     steps = lower ? e->height - r : r;
        const assay_sincos half  = assay_sincos_radians(half_step * steps);
        e->top[r]                = lower ? half.sin * half.sin : half.cos * half.cos;
        e->bottom[r]             = lower ? half.cos * half.cos : half.sin * half.sin;
    }
    for (uint32_t r = 0; r < e->height; r++) {
        const bool   lower = 2 * r >= e->height;
        const double share = lower ? e->top[r] - e->top[r + 1] : e->bottom[r + 1] - e->bottom[r];
        e->row_angle[r]    = 4.0 * ASSAY_PI * share / e->width;
    }
}

/* Weights of the texels, and on the way the integral. */
static assay_status weigh_texels(assay_environment *e, const char *path)
{
    double *weights = assay_allocate(e->context, (size_t)e->width * e->height, sizeof *weights);
    if (!weights) {
        return assay_fail_memory(e->context, path);
    }
    for (uint32_t r = 0; r < e->height; r++) {
        assay_rgb row = rgb_grey(0.0);
        for (uint32_t c = 0; c < e->width; c++) {
            const assay_rgb texel             = texel_at(e, r, c);
            weights[(size_t)r * e->width + c] = rgb_luminance(texel) * e->row_angle[r];
            row                               = rgb_add(row, texel);
        }
        e->integral = rgb_add(e->integral, rgb_scale(row, e->row_angle[r]));
    }
    assay_status status;
    if (rgb_finite(e->integral)) {
        status = assay_distribution2_create(e->context, weights, e->height, e->width, &e->choice);
    } else {
        status = assay_fail(e->context, ASSAY_ERR_LIMIT,
                            "%s: environment map: the scaled radiance is too large to sum", path);
    }
    assay_release(e->context, weights);
    return status;
}

static assay_status fill(assay_environment *e, const assay_image *image, const char *path)
{
    const size_t rows = e->height;
    e->texels         = assay_allocate(e->context, rows * e->width, 3 * sizeof *e->texels);
    e->top            = assay_allocate(e->context, rows + 1, sizeof *e->top);
    e->bottom         = assay_allocate(e->context, rows + 1, sizeof *e->bottom);
    e->row_angle      = assay_allocate(e->context, rows, sizeof *e->row_angle);
    if (!e->texels || !e->top || !e->bottom || !e->row_angle) {
        return assay_fail_memory(e->context, path);
    }
    const assay_status status = take_texels(e, image, path);
    if (status != ASSAY_OK) {
        return status;
    }
    measure_rows(e);
    return weigh_texels(e, path);
}

assay_status assay_environment_create(assay_context *context, const struct assay_image *image,
                                      double scale, double rotation, const char *path,
                                      assay_environment **environment_out)
{
    const uint64_t width  = (uint64_t)assay_image_width(image);
    const uint64_t height = (uint64_t)assay_image_height(image);
    if (width * height > MAX_TEXELS) {
        return assay_fail(
            context, ASSAY_ERR_LIMIT,
            "%s: an environment map of %llu x %llu texels; at most %llu are used; make "
            "it smaller",
            path, (unsigned long long)width, (unsigned long long)height,
            (unsigned long long)MAX_TEXELS);
    }
    assay_environment *e = assay_allocate(context, 1, sizeof *e);
    if (!e) {
        return assay_fail_memory(context, path);
    }
    e->context                = context;
    e->width                  = (uint32_t)width;
    e->height                 = (uint32_t)height;
    e->scale                  = scale;
    e->turn                   = assay_sincos_radians(rotation);
    const assay_status status = fill(e, image, path);
    if (status != ASSAY_OK) {
        assay_environment_destroy(e);
        return status;
    }
    *environment_out = e;
    return ASSAY_OK;
}

void assay_environment_destroy(assay_environment *e)
{
    if (e) {
        assay_distribution2_destroy(e->choice);
        assay_release(e->context, e->texels);
        assay_release(e->context, e->top);
        assay_release(e->context, e->bottom);
        assay_release(e->context, e->row_angle);
        assay_release(e->context, e);
    }
}

/* The map's own frame is turned against the world by the rotation. */
static assay_vec3 to_map(const assay_environment *e, assay_vec3 d)
{
    return vec3(d.x * e->turn.cos - d.z * e->turn.sin, d.y, d.x * e->turn.sin + d.z * e->turn.cos);
}

static assay_vec3 to_world(const assay_environment *e, assay_vec3 d)
{
    return vec3(d.x * e->turn.cos + d.z * e->turn.sin, d.y, d.z * e->turn.cos - d.x * e->turn.sin);
}

static inline uint32_t clamp_index(double x, uint32_t count)
{
    return !(x > 0.0) ? 0 : x < count ? (uint32_t)x : count - 1;
}

static texel_index find_texel(const assay_environment *e, assay_vec3 direction)
{
    const assay_vec3 d     = to_map(e, direction);
    const double     theta = assay_atan2(sqrt(d.x * d.x + d.z * d.z), d.y);
    const double     phi   = assay_atan2(d.x, -d.z);
    return (texel_index){.row = clamp_index(theta * (e->height * ASSAY_INV_PI), e->height),
                         .column =
                             clamp_index((phi * (0.5 * ASSAY_INV_PI) + 0.5) * e->width, e->width)};
}

assay_rgb assay_environment_radiance(const assay_environment *e, assay_vec3 direction)
{
    const texel_index i = find_texel(e, direction);
    return texel_at(e, i.row, i.column);
}

assay_vec3 assay_environment_sample(const assay_environment *e, double u1, double u2,
                                    double *pdf_out)
{
    const assay_distribution2_cell cell = assay_distribution2_sample(e->choice, u1, u2);
    const double top = e->top[cell.row] + cell.in_row * (e->top[cell.row + 1] - e->top[cell.row]);
    const double bottom =
        e->bottom[cell.row] + cell.in_row * (e->bottom[cell.row + 1] - e->bottom[cell.row]);
    const double       sine = 2.0 * sqrt(top * bottom);
    const assay_sincos azimuth =
        assay_sincos_turns(((double)cell.column + cell.in_column) / e->width - 0.5);
    *pdf_out = cell.probability / e->row_angle[cell.row];
    return to_world(e, vec3(sine * azimuth.sin, top - bottom, -sine * azimuth.cos));
}

double assay_environment_pdf(const assay_environment *e, assay_vec3 direction)
{
    const texel_index i = find_texel(e, direction);
    return assay_distribution2_probability(e->choice, i.row, i.column) / e->row_angle[i.row];
}

assay_rgb assay_environment_integral(const assay_environment *e) { return e->integral; }

assay_status assay_environment_image(const assay_environment *environment, assay_image **image_out)
{
    static const char *const names[3] = {"R", "G", "B"};
    const assay_environment *e        = environment;
    const size_t             count    = (size_t)e->width * e->height;
    assay_image             *image    = NULL;
    assay_status status = assay_image_create(e->context, (int)e->width, (int)e->height, &image);
    for (size_t c = 0; c < 3 && status == ASSAY_OK; c++) {
        assay_channel channel;
        status = assay_image_add_channel(image, names[c], ASSAY_CHANNEL_FLOAT, &channel);
        for (size_t i = 0; i < count && status == ASSAY_OK; i++) {
            channel.data.f32[i] = e->texels[3 * i + c];
        }
    }
    if (status != ASSAY_OK) {
        assay_image_destroy(image);
        return status;
    }
    *image_out = image;
    return ASSAY_OK;
}

double assay_environment_scale(const assay_environment *environment) { return environment->scale; }
