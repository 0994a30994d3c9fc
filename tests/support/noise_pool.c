/* noise_pool.c - samples kept, and drawn again.
 *
 * Invariant: an image's number, its pixels and nothing else decide what is drawn; a defect changes
 * the samples after they were drawn, but for the shift, which draws from two pixels. */
#include "support/noise_pool.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "assay/render.h"
#include "core/numerics.h"
#include "core/random.h"

const char *const noise_defect_names[DEFECT_COUNT] = {"none",
                                                      "light leak in one tile",
                                                      "1 percent energy loss",
                                                      "missing bounces",
                                                      "shifted half a pixel",
                                                      "wrong colour space",
                                                      "clamped highlights"};

static void require(bool ok, const char *what)
{
    if (!ok) {
        fprintf(stderr, "noise pool: %s\n", what);
        exit(1);
    }
}

static noise_pool *pool_of(int side)
{
    noise_pool *pool = calloc(1, sizeof *pool);
    require(pool != NULL, "memory");
    const size_t count = (size_t)side * (size_t)side * NOISE_POOL_SAMPLES * 3;
    *pool              = (noise_pool){side, calloc(count, sizeof(float))};
    require(pool->values != NULL, "memory");
    return pool;
}

void noise_pool_free(noise_pool *pool)
{
    if (pool) {
        free(pool->values);
        free(pool);
    }
}

static float *sample_of(const noise_pool *pool, size_t pixel, size_t sample)
{
    return pool->values + (pixel * NOISE_POOL_SAMPLES + sample) * 3;
}

noise_pool *noise_pool_render(assay_context *context, assay_scene *scene, int side,
                              const char *parameter, const char *value)
{
    noise_pool   *pool   = pool_of(side);
    assay_params *params = NULL;
    require(assay_method_params(context, "path", &params) == ASSAY_OK &&
                assay_params_set(params, "spp", "1") == ASSAY_OK &&
                (!parameter || assay_params_set(params, parameter, value) == ASSAY_OK),
            assay_context_error(context));
    assay_render_options options = assay_render_options_default();
    options.width = options.height = side;
    options.layers                 = "color";
    for (uint64_t s = 0; s < NOISE_POOL_SAMPLES; s++) {
        assay_image  *image = NULL;
        assay_channel channel[3];
        options.seed = 1000 + s;
        require(assay_render(scene, "path", params, &options, &image, NULL) == ASSAY_OK,
                assay_context_error(context));
        for (int c = 0; c < 3; c++) {
            const char name[2] = {"RGB"[c], '\0'};
            require(assay_image_find_channel(image, name, &channel[c]), "no colour");
        }
        for (size_t i = 0; i < (size_t)side * (size_t)side; i++) {
            for (int c = 0; c < 3; c++) {
                sample_of(pool, i, s)[c] = channel[c].data.f32[i];
            }
        }
        assay_image_destroy(image);
    }
    assay_params_destroy(params);
    return pool;
}

static double normal(assay_random *random)
{
    const double u = assay_random_next(random), v = assay_random_next(random);
    return sqrt(-2.0 * assay_log1p(-u)) * assay_cos(ASSAY_TWO_PI * v);
}

/* Light falls off from a corner, and noise is larger in every fifth column. */
noise_pool *noise_pool_made_up(noise_kind kind, int side)
{
    noise_pool *pool = pool_of(side);
    for (size_t i = 0; i < (size_t)side * (size_t)side; i++) {
        assay_random random = assay_random_start(99, ASSAY_STAGE_TEST, i, (uint64_t)kind);
        const int    x = (int)(i % (size_t)side), y = (int)(i / (size_t)side);
        const double light  = 1.0 / (1.0 + 0.05 * (x + 2.0 * y));
        const double spread = i % 5 == (kind == NOISE_ELSEWHERE ? 2 : 0) ? 0.8 : 0.2;
        for (size_t s = 0; s < NOISE_POOL_SAMPLES; s++) {
            const double n = normal(&random);
            double       v = 1.0 + spread * n;
            if (kind == NOISE_LOGNORMAL) {
                v = assay_exp(1.5 * n);
            } else if (kind == NOISE_RARE) {
                v = 0.5 + assay_random_next(&random);
                v *= assay_random_next(&random) < 1.0 / 300.0 ? 200.0 : 1.0;
            }
            float *sample = sample_of(pool, i, s);
            sample[0]     = (float)(light * v);
            sample[1]     = (float)(0.7 * light * v);
            sample[2]     = (float)(0.2 * light * (0.5 + 0.5 * v));
        }
    }
    return pool;
}

noise_pool *noise_pool_of_rare_light(int side, int rare, bool lit)
{
    enum { CORNER = 8, WIDTH = 6 };
    noise_pool *pool = pool_of(side);
    for (size_t i = 0; i < (size_t)side * (size_t)side; i++) {
        assay_random random = assay_random_start(96, ASSAY_STAGE_TEST, i, 0);
        const int    x = (int)(i % (size_t)side) - CORNER, y = (int)(i / (size_t)side) - CORNER;
        const bool   pooled = lit && x >= 0 && x < WIDTH && y >= 0 && y < WIDTH;
        for (size_t s = 0; s < NOISE_POOL_SAMPLES; s++) {
            const double v =
                1.0 + 0.2 * normal(&random) + (pooled && s % (size_t)rare == 0 ? 3.0 * rare : 0.0);
            for (int c = 0; c < 3; c++) {
                sample_of(pool, i, s)[c] = (float)((1.0 - 0.3 * c) * v);
            }
        }
    }
    return pool;
}

noise_pool *noise_pool_batches(const noise_pool *pool, int batch)
{
    noise_pool *made = pool_of(pool->side);
    for (size_t i = 0; i < (size_t)pool->side * (size_t)pool->side; i++) {
        assay_random random = assay_random_start(98, ASSAY_STAGE_TEST, i, (uint64_t)batch);
        for (size_t s = 0; s < NOISE_POOL_SAMPLES; s++) {
            double sum[3] = {0};
            for (int k = 0; k < batch; k++) {
                const float *from = sample_of(pool, i, assay_random_bits(&random) >> 54);
                for (int c = 0; c < 3; c++) {
                    sum[c] += from[c];
                }
            }
            for (int c = 0; c < 3; c++) {
                sample_of(made, i, s)[c] = (float)(sum[c] / batch);
            }
        }
    }
    return made;
}
_Static_assert(NOISE_POOL_SAMPLES == 1 << 10, "ten bits choose a sample");

static double mean_of_pixel(const noise_pool *pool, size_t pixel, int channel)
{
    double sum = 0.0;
    for (size_t s = 0; s < NOISE_POOL_SAMPLES; s++) {
        sum += sample_of(pool, pixel, s)[channel];
    }
    return sum / NOISE_POOL_SAMPLES;
}

void noise_pool_match(noise_pool *pool, const noise_pool *other)
{
    for (size_t i = 0; i < (size_t)pool->side * (size_t)pool->side; i++) {
        for (int c = 0; c < 3; c++) {
            const double shift = mean_of_pixel(other, i, c) - mean_of_pixel(pool, i, c);
            for (size_t s = 0; s < NOISE_POOL_SAMPLES; s++) {
                sample_of(pool, i, s)[c] += (float)shift;
            }
        }
    }
}

/* ---- images ---- */

typedef struct {
    const noise_pool *pool;
    noise_defect      defect;
    double            ceiling; /* of clamped samples */
} drawing;

static double mean_of_pool(const noise_pool *pool)
{
    double       sum   = 0.0;
    const size_t count = (size_t)pool->side * (size_t)pool->side * NOISE_POOL_SAMPLES * 3;
    const size_t taken = count / 64;
    for (size_t i = 0; i < count; i += 64) {
        sum += pool->values[i];
    }
    return sum / (double)taken;
}

static void spoil(const drawing *d, size_t pixel, double v[3])
{
    /* Rec. 709 to Rec. 2020, D65. */
    static const double WIDE[3][3] = {{0.627404, 0.329283, 0.043313},
                                      {0.069097, 0.919540, 0.011362},
                                      {0.016391, 0.088013, 0.895595}};
    const int           side = d->pool->side, tile = side / 8;
    const int           x = (int)(pixel % (size_t)side), y = (int)(pixel / (size_t)side);
    const double        in[3] = {v[0], v[1], v[2]};
    for (int c = 0; c < 3; c++) {
        switch (d->defect) {
        case DEFECT_LEAK: v[c] *= x / tile == 4 && y / tile == 5 ? 1.2 : 1.0; break;
        case DEFECT_ENERGY: v[c] *= 0.99; break;
        case DEFECT_COLOUR:
            v[c] = WIDE[c][0] * in[0] + WIDE[c][1] * in[1] + WIDE[c][2] * in[2];
            break;
        case DEFECT_CLAMP: v[c] = fmin(v[c], d->ceiling); break;
        default: break;
        }
    }
}

typedef struct {
    double mean[3], variance[3];
} estimate;

static estimate draw_pixel(const drawing *d, size_t pixel, int samples, uint64_t number)
{
    assay_random random = assay_random_start(97, ASSAY_STAGE_TEST, pixel, number);
    const size_t right  = (pixel + 1) % (size_t)d->pool->side ? pixel + 1 : pixel;
    double       sum[3] = {0}, squares[3] = {0};
    /* About a guess near the mean: with sums of squares nothing much cancels. */
    const float *guess = sample_of(d->pool, pixel, 0);
    uint64_t     bits  = 0;
    for (int s = 0; s < samples; s++, bits >>= 11) {
        bits              = s % 5 == 0 ? assay_random_bits(&random) : bits;
        const size_t from = d->defect == DEFECT_SHIFT && (bits >> 10 & 1) ? right : pixel;
        const float *f    = sample_of(d->pool, from, bits & 1023);
        double       v[3] = {f[0], f[1], f[2]};
        spoil(d, pixel, v);
        for (int c = 0; c < 3; c++) {
            const double delta = v[c] - guess[c];
            sum[c] += delta;
            squares[c] += delta * delta;
        }
    }
    estimate e;
    for (int c = 0; c < 3; c++) {
        const double mean = sum[c] / samples;
        e.mean[c]         = guess[c] + mean;
        e.variance[c] = fmax(0.0, squares[c] / samples - mean * mean) / fmax(1.0, samples - 1.0);
    }
    return e;
}

static const char *const NAMES[] = {"R",          "G",          "B",          "Variance.R",
                                    "Variance.G", "Variance.B", "SampleCount"};

static assay_image *create(assay_context *context, int side, int samples, assay_channel channel[7])
{
    assay_image *image = NULL;
    bool         ok    = assay_image_create(context, side, side, &image) == ASSAY_OK;
    for (int c = 0; ok && c < 7; c++) {
        ok = assay_image_add_channel(image, NAMES[c],
                                     c < 6 ? ASSAY_CHANNEL_FLOAT : ASSAY_CHANNEL_UINT,
                                     &channel[c]) == ASSAY_OK;
    }
    if (!ok) {
        assay_image_destroy(image);
        return NULL;
    }
    for (int i = 0; i < side * side; i++) {
        channel[6].data.u32[i] = (uint32_t)samples;
    }
    return image;
}

static void store(assay_channel channel[7], size_t pixel, const estimate *e)
{
    for (int c = 0; c < 3; c++) {
        channel[c].data.f32[pixel]     = (float)e->mean[c];
        channel[3 + c].data.f32[pixel] = (float)e->variance[c];
    }
}

assay_image *noise_pool_draw(assay_context *context, const noise_pool *pool, int samples,
                             uint64_t number, noise_defect defect)
{
    const drawing d = {pool, defect, 10.0 * mean_of_pool(pool)};
    assay_channel channel[7];
    assay_image  *image = create(context, pool->side, samples, channel);
    for (size_t i = 0; image && i < (size_t)pool->side * (size_t)pool->side; i++) {
        const estimate e = draw_pixel(&d, i, samples, number);
        store(channel, i, &e);
    }
    return image;
}

assay_image *noise_pool_exact(assay_context *context, const noise_pool *pool, int samples)
{
    assay_channel channel[7];
    assay_image  *image = create(context, pool->side, samples, channel);
    for (size_t i = 0; image && i < (size_t)pool->side * (size_t)pool->side; i++) {
        estimate e = {{0}, {0}};
        for (int c = 0; c < 3; c++) {
            e.mean[c] = mean_of_pixel(pool, i, c);
            for (size_t s = 0; s < NOISE_POOL_SAMPLES; s++) {
                const double delta = sample_of(pool, i, s)[c] - e.mean[c];
                e.variance[c] += delta * delta / NOISE_POOL_SAMPLES / samples;
            }
        }
        store(channel, i, &e);
    }
    return image;
}

static bool copy_channel(const assay_image *from, assay_image *to, int channel)
{
    const size_t  size = (size_t)assay_image_width(from) * (size_t)assay_image_height(from) * 4;
    assay_channel source, target;
    require(assay_image_find_channel(from, NAMES[channel], &source), NAMES[channel]);
    if (assay_image_add_channel(to, NAMES[channel], source.type, &target) != ASSAY_OK) {
        return false;
    }
    memcpy(target.data.u32, source.data.u32, size);
    return true;
}

assay_image *noise_pool_without(assay_context *context, assay_image *image, bool variance,
                                bool count)
{
    const int    side = assay_image_width(image);
    assay_image *copy = NULL;
    bool         ok   = assay_image_create(context, side, side, &copy) == ASSAY_OK;
    for (int c = 0; c < 7 && ok; c++) {
        const bool is_dropped = c < 3 ? false : c < 6 ? variance : count;
        ok                    = is_dropped || copy_channel(image, copy, c);
    }
    assay_image_destroy(image);
    if (!ok) {
        assay_image_destroy(copy);
        return NULL;
    }
    return copy;
}
