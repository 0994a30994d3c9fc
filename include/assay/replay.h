/* replay.h - one stage of a renderer on given arrays: what should have come out, and whether what
 * came out of another renderer is that, within what its precision allows.
 *
 * Bundles: docs/bundle.md.  Bounds: docs/verdicts-stages.md. */
#ifndef ASSAY_REPLAY_H
#define ASSAY_REPLAY_H

#include "assay/params.h"
#include "assay/precision.h"
#include "assay/scene.h"
#include "assay/verdict.h"

#ifdef __cplusplus
extern "C" {
#endif

/* An array of a stage. */
typedef struct {
    const char *name;     /* "records/position"; '#' in it stands for a whole number; NULL ends a
                             table                                                            */
    const char *unit;     /* as the manifest has it; "" where it has none; NULL: any, and an output
                             has that of the first such input                                    */
    const char *channels; /* "X Y Z": of an image, and how many columns a table has; NULL: any */
    const char *rows;     /* "record": what a row is, in words                                */
    const char *what;     /* in words                                                         */
    bool        optional;
    bool        may_be_nan, may_be_infinite;
} assay_stage_array;

typedef struct {
    const char              *name, *summary;
    const assay_param_desc  *params; /* looked up in the manifest where they are not given        */
    const assay_stage_array *inputs, *outputs;
    bool                     needs_scene;
} assay_stage_info;

/* In the order of the data's way. */
ASSAY_API int              assay_stage_count(void);
ASSAY_API assay_stage_info assay_stage_at(int index);

typedef struct {
    const char            *stage;
    const char            *in, *out; /* bundles; out is made                                 */
    const assay_scene     *scene;    /* NULL without                                         */
    const assay_precision *bounds;   /* adds NAME_bound for each array NAME; NULL: none      */
    bool                   inputs;   /* the inputs are written, too: a reference for candidates  */
    int                    param_count;
    const char *const     *params; /* "key=value", before what the manifest says           */
} assay_replay_options;

/* Errors: ARGUMENT (no such stage or parameter; a scene is missing), NOT_FOUND, FORMAT, DOMAIN,
 * UNSUPPORTED, LIMIT, MEMORY, WRITE. */
ASSAY_API assay_status assay_replay(assay_context *context, const assay_replay_options *options);

/* Replays every stage whose inputs and outputs the candidate has on the candidate's own inputs, and
 * adds a finding for each array.  Errors: ARGUMENT (candidate and reference are of other scenes,
 * parameters, cameras: the message names what), FORMAT (an array that the reference lacks, of
 * another shape, dtype or unit; a broken file), DOMAIN (NaN), and the others of assay_replay; the
 * verdict is then worthless.  Arrays that no stage judges stand in its setting "not judged", stages
 * that ran and have no bound of any number in "blind".
 *
 * reference NULL: nothing is said of the inputs themselves; for stages that are tested alone, on
 * inputs that no render made. */
ASSAY_API assay_status assay_verify_bundle(assay_context *context, const char *candidate,
                                           const char *reference, const assay_scene *scene,
                                           assay_precision precision, assay_verdict *verdict);

/* Adds a finding that cannot tell for each of the stages (names, with commas between them) of which
 * the verdict has none yet: what was to be judged and was not does not pass.  Errors: ARGUMENT (no
 * such stage), MEMORY. */
ASSAY_API assay_status assay_verify_require(assay_verdict *verdict, const char *stages);

/* What a pass shall be worth, of every array that a stage judged: findings that pass cannot tell
 * where a typical number may be off by more than `detect` of itself within its bound (the finding's
 * width; of numbers that are all 0 nothing is asked; NaN: of none), or where less than the part
 * `judged` of the numbers has a bound (NaN: not asked; less than half never passes).  With
 * `judged`, stages of the setting "blind" cannot tell either.  Errors: ARGUMENT (detect <= 0,
 * judged not in [0, 1]), MEMORY. */
ASSAY_API assay_status assay_verify_insist(assay_verdict *verdict, double detect, double judged);

#ifdef __cplusplus
}
#endif
#endif
