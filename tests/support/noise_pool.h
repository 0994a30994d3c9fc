/* noise_pool.h - images with the noise of a path tracer, as many as are wanted, of one known mean.
 *
 * A pool holds samples of every pixel: real ones, of renders with one sample a pixel, or made-up
 * ones.  An image draws from them, with replacement, and has means, variances and counts like a
 * render.  So two images of one pool have the very same expectation: a null hypothesis that is
 * exactly true, with tails that no formula was asked for. */
#ifndef ASSAY_TESTS_NOISE_POOL_H
#define ASSAY_TESTS_NOISE_POOL_H

#include "assay/image.h"
#include "assay/scene.h"

enum { NOISE_POOL_SAMPLES = 1024 };

typedef struct {
    int    side;   /* pixels; images are square             */
    float *values; /* [pixel][sample][R G B]                */
} noise_pool;

typedef enum {
    NOISE_GAUSS,     /* each pixel normal, every fifth column with a large deviation */
    NOISE_ELSEWHERE, /* likewise, but in other columns                               */
    NOISE_LOGNORMAL, /* log-normal with a deviation of 1.5: skewed                   */
    NOISE_RARE,      /* one sample in 300 is some 200 times as bright as the others  */
    NOISE_KINDS
} noise_kind;

/* What is wrong with an image. */
typedef enum {
    DEFECT_NONE,
    DEFECT_LEAK,   /* one tile of an eighth of the side is a fifth too bright     */
    DEFECT_ENERGY, /* all samples 1 percent too dark                              */
    DEFECT_BOUNCE, /* drawn from a pool with fewer bounces                        */
    DEFECT_SHIFT,  /* half a pixel to the left                                    */
    DEFECT_COLOUR, /* linear colours with the primaries of Rec. 2020              */
    DEFECT_CLAMP,  /* samples above ten times the image's mean are clamped        */
    DEFECT_COUNT
} noise_defect;

extern const char *const noise_defect_names[DEFECT_COUNT];

/* Renders of our Cornell box by `path`, with parameter = value (NULL: none). Ends the program where
 * it cannot. */
noise_pool *noise_pool_render(assay_context *context, assay_scene *scene, int side,
                              const char *parameter, const char *value);
noise_pool *noise_pool_made_up(noise_kind kind, int side);
/* Dull walls, and on 6 x 6 pixels of them a pool of light, three times as bright, that one sample
 * in `rare` (a power of 2) finds.  lit: false leaves it out, all else is the same. */
noise_pool *noise_pool_of_rare_light(int side, int rare, bool lit);
/* Each sample the mean of `batch` of the other pool's: as if each stood for so many. */
noise_pool *noise_pool_batches(const noise_pool *pool, int batch);
/* Shifts samples so that each pixel's mean becomes that of the other pool: another estimator of the
 * same light. */
void noise_pool_match(noise_pool *pool, const noise_pool *other);
void noise_pool_free(noise_pool *pool);

/* An image of `samples` samples a pixel; number tells images of one pool apart.  NULL without
 * memory. */
assay_image *noise_pool_draw(assay_context *context, const noise_pool *pool, int samples,
                             uint64_t number, noise_defect defect);

/* The image, which is destroyed, without its variance, or its number of samples.  NULL without
 * memory. */
assay_image *noise_pool_without(assay_context *context, assay_image *image, bool variance,
                                bool count);

/* The pool's very means, with the variances of `samples` samples. */
assay_image *noise_pool_exact(assay_context *context, const noise_pool *pool, int samples);

#endif
