/* random.h - counter-based random numbers.
 *
 * Philox4x32-10 [salmon11] through Random123: number k of a stream is a pure function of (seed,
 * stage, item, sample, k), so no state travels between items and no order of work changes it. */
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
    ASSAY_STAGE_PROJECTION = 5  /* item: sample; direction to project a function    */
} assay_stage;

typedef struct {
    philox4x32_ctr_t counter; /* [0] block, [1] sample, [2] item low, [3] item high */
    philox4x32_key_t key;     /* seed mixed with stage                              */
    double           spare;
    int              has_spare;
} assay_random;

/* The stream of an item's sample. item < 2^56 (its top byte carries the stage). */
static inline assay_random assay_random_start(uint64_t seed, assay_stage stage, uint64_t item,
                                              uint32_t sample)
{
    assay_random random = {0};
    random.counter.v[1] = sample;
    random.counter.v[2] = (uint32_t)item;
    random.counter.v[3] = (uint32_t)(item >> 32) | ((uint32_t)stage << 24);
    random.key.v[0]     = (uint32_t)seed;
    random.key.v[1]     = (uint32_t)(seed >> 32);
    return random;
}

static inline double assay_random_unit53(uint32_t high, uint32_t low)
{
    const uint64_t bits = ((uint64_t)high << 32 | low) >> 11;
    return (double)bits * 0x1p-53;
}

/* The next number of the stream, uniform in [0, 1), 53 bits. */
static inline double assay_random_next(assay_random *random)
{
    if (random->has_spare) {
        random->has_spare = 0;
        return random->spare;
    }
    const philox4x32_ctr_t r = philox4x32(random->counter, random->key);
    random->counter.v[0]++;
    random->spare     = assay_random_unit53(r.v[3], r.v[2]);
    random->has_spare = 1;
    return assay_random_unit53(r.v[1], r.v[0]);
}

#endif
