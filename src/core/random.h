/* random.h - counter-based random numbers.
 *
 * Philox4x64-10 [salmon11] through Random123: number k of a stream is a pure function of (seed,
 * stage, item, sample, k), so no state travels between items and no order of work changes it.
 * docs/determinism.md says how to have the same numbers from another program. */
#ifndef ASSAY_CORE_RANDOM_H
#define ASSAY_CORE_RANDOM_H

#include <stdint.h>

#include <Random123/philox.h>

/* One number for each use, so that two uses never share a stream. Never renumber. */
typedef enum {
    ASSAY_STAGE_TEST       = 0,
    ASSAY_STAGE_CAMERA     = 1, /* item: pixel; radiance through the pixel          */
    ASSAY_STAGE_IRRADIANCE = 2, /* item: pixel; irradiance at the visible point     */
    ASSAY_STAGE_PROBE      = 3, /* item: probe                                      */
    ASSAY_STAGE_LIGHTS     = 4, /* item: triangle; power of textured emitters       */
    ASSAY_STAGE_PROJECTION = 5, /* item: sample; direction to project a function    */
    ASSAY_STAGE_GATHER     = 6, /* item: record; sample: cell of its hemisphere     */
    ASSAY_STAGE_SCRAMBLE   = 7  /* item: pixel; of its points of the unit square    */
} assay_stage;

typedef struct {
    philox4x64_ctr_t counter; /* [0] block, from 1; [1] sample; [2] item; [3] stage */
    philox4x64_key_t key;     /* [0] seed                                           */
    philox4x64_ctr_t block;   /* the block that numbers are taken from              */
    unsigned         taken;   /* of its four                                        */
} assay_random;

/* The stream of an item's sample. */
static inline assay_random assay_random_start(uint64_t seed, assay_stage stage, uint64_t item,
                                              uint64_t sample)
{
    return (assay_random){
        .counter = {{0, sample, item, (uint64_t)stage}}, .key = {{seed, 0}}, .taken = 4};
}

/* 64 random bits. */
static inline uint64_t assay_random_bits(assay_random *random)
{
    if (random->taken == 4) {
        random->counter.v[0]++;
        random->block = philox4x64(random->counter, random->key);
        random->taken = 0;
    }
    return random->block.v[random->taken++];
}

/* The next number of the stream, uniform in [0, 1), 53 bits. */
static inline double assay_random_next(assay_random *random)
{
    return (double)(assay_random_bits(random) >> 11) * 0x1p-53;
}

/* The next four numbers of the stream, instead of those that would come: what is drawn first from
 * it is so chosen by another rule.  u in [0, 1). */
static inline void assay_random_choose(assay_random *random, const double u[4])
{
    for (int i = 0; i < 4; i++) {
        random->block.v[i] = (uint64_t)(u[i] * 0x1p53) << 11;
    }
    random->taken = 0;
}

#endif
