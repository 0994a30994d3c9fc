/* verify.h - is an image, or are several runs of it, the same light as a reference?
 *
 * Both have noise.  Tests are made on pixels, on tiles and on the whole image; together they say
 * FAIL of two images of the same light with a probability of at most `level`.  What is tested how,
 * and what it rests on: docs/verdicts.md. */
#ifndef ASSAY_VERIFY_H
#define ASSAY_VERIFY_H

#include "assay/image.h"
#include "assay/precision.h"
#include "assay/verdict.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum {
    ASSAY_CORRECTION_HOLM, /* no false alarm at all, with probability 1 - level             */
    ASSAY_CORRECTION_BH    /* Benjamini and Hochberg: of the pixels named, a share of `level`
                              may be false; finds more of them                              */
} assay_correction;

/* Largest number of runs of a candidate. */
#define ASSAY_VERIFY_MAX_RUNS 64

typedef struct {
    double           level;      /* of all tests together, in (0, 0.5)                            */
    assay_correction correction; /* of the tests on pixels                                        */
    int              tile;       /* side of the smallest tiles, pixels, 4 to 256; the next are 4
                                    and 16 times as wide, as far as the image holds four of them  */
    double allow;                /* NaN: any difference fails.  Else equivalence is tested: a bias
                                    of this share of the reference's mean in a tile, and in the
                                    whole, passes                                                 */
    double allow_absolute;       /* in the channel's unit, beside or instead; NaN          */
    double detect;               /* cannot tell unless a bias of the whole image of this
                                    share of its mean would have been seen; NaN: all of it */
    double          detect_tile; /* likewise of every tile, in parts of the image's mean   */
    uint32_t        candidate_samples; /* of a pixel, where SampleCount does not say; 0: unknown */
    uint32_t        reference_samples;
    bool            reference_exact; /* the reference has no noise                             */
    assay_precision precision;       /* of the candidate's arithmetic; a file holds floats     */
    const char     *channels;        /* "R,G,B"; NULL: all that both have, of those that
                                        docs/conventions.md lists as estimated                 */
    bool ignore_metadata;            /* compare also where scene or camera differ              */
} assay_verify_options;

ASSAY_API assay_verify_options assay_verify_options_default(void);

/* Adds findings of the images to a verdict.  Several candidates are runs that differ in their
 * random numbers alone.  What cannot be tested (a channel that is missing, a NaN, a variance that
 * is not there) is a finding that cannot tell.
 * Errors: ARGUMENT (an option out of its range, sizes that differ, nothing to compare, metadata
 * that contradict one another), MEMORY, CANCELLED; the verdict then holds nothing new. */
ASSAY_API assay_status assay_verify_images(const assay_image *const *candidates, int count,
                                           const assay_image          *reference,
                                           const assay_verify_options *options,
                                           assay_verdict              *verdict);

/* The same for OpenEXR files, of which only the channels that are needed are read.
 * Errors: as above, and those of assay_image_read. */
ASSAY_API assay_status assay_verify_files(assay_context *context, const char *const *candidates,
                                          int count, const char *reference,
                                          const assay_verify_options *options,
                                          assay_verdict             **verdict_out);

#ifdef __cplusplus
}
#endif
#endif
