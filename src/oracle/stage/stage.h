/* stage.h - one step of a renderer as a function of arrays: what it reads, what it writes, and how
 * far a correct implementation of less precision may be from that.
 *
 * A stage is one file, stage_NAME.c, and one line in stage_list.c.  Its values come from the code
 * that the methods run; its bounds are analysed apart, in tracked.h's arithmetic
 * (docs/verdicts-stages.md). */
#ifndef ASSAY_ORACLE_STAGE_H
#define ASSAY_ORACLE_STAGE_H

#include "assay/replay.h"
#include "io/bundle_read.h"
#include "oracle/stage/tracked.h"
#include "trace/world.h"

enum { STAGE_MOST_ARRAYS = 16, STAGE_MOST_OUTPUTS = 128 };

/* An array that is read; values NULL where it is not there. */
typedef struct {
    char          name[ASSAY_BUNDLE_NAME]; /* "splat/batch.3/weight"                       */
    const double *values;                  /* rows of columns                              */
    size_t        rows, columns;
    double        roundoff; /* unit roundoff of the type that its file holds               */
    double        tiny;     /* and what a number may have lost to underflow there          */
    const char   *unit;     /* borrowed from the manifest */
} stage_table;

/* An array that is written. */
typedef struct {
    char        name[ASSAY_BUNDLE_NAME];
    const char *unit, *channels; /* as the stage's description has them */
    size_t      rows, columns;
    double     *values;
    double     *bounds; /* NULL where none are asked; NaN: of this number nothing is known   */
} stage_output;

/* One run of a stage. */
typedef struct {
    assay_context             *context;
    const struct oracle_stage *stage;
    assay_params              *params;
    assay_bundle_reader       *bundle;
    const assay_scene         *scene; /* NULL without */
    bool                       bounded;
    rounding                   rounding;     /* where bounded                             */
    stage_table   in[STAGE_MOST_ARRAYS];     /* in the order of the stage's inputs        */
    assay_array  *tables[STAGE_MOST_ARRAYS]; /* what they borrow                          */
    stage_output *out;                       /* STAGE_MOST_OUTPUTS                        */
    int           out_count;
} stage_run;

typedef struct oracle_stage {
    assay_stage_info info;
    assay_status (*run)(stage_run *run);
} oracle_stage;

/* The stages in the order of the data's way. */
extern const oracle_stage *const assay_stages[];
/* NULL where there is none of that name. */
const oracle_stage *assay_stage_find(const char *name);
/* ARGUMENT, in words: which stages there are. */
assay_status stage_fail_unknown(assay_context *context, const char *name);

/* Makes an output (zeros) of the stage's description `index`; number: for names with a '#'.
 * Errors: MEMORY, LIMIT. */
assay_status stage_output_make(stage_run *run, int index, int number, size_t rows, size_t columns,
                               stage_output **output_out);

/* Says that no bound is known of the output. */
void stage_output_unknown(const stage_output *output);

/* FORMAT: an input has not as many rows as another one. */
assay_status stage_fail_rows(const stage_run *run, int input, size_t wanted, const char *why);
/* FORMAT: an input has not so many columns. */
assay_status stage_fail_columns(const stage_run *run, int input, size_t wanted);
/* DOMAIN: a number of an input. */
assay_status stage_fail_value(const stage_run *run, int input, size_t row, size_t column,
                              const char *why);

/* Reads the inputs, checks them and runs.  precision: NULL for values alone.  overrides:
 * "key=value" texts before the manifest's.  Release either way.  Errors: those of bundles,
 * ARGUMENT, DOMAIN, the stage's own. */
assay_status stage_run_start(stage_run *run, assay_context *context, const oracle_stage *stage,
                             assay_bundle_reader *bundle, const assay_scene *scene,
                             const assay_precision *precision, int override_count,
                             const char *const *overrides);
void         stage_run_release(stage_run *run);

/* A text of the manifest as a method writes it ("assay:NAME", "assay:METHOD.NAME") or plain. */
const char *stage_manifest_text(const assay_bundle_reader *bundle, const char *name);

/* The listed name that a stage's name stands for: with '#' that of the largest number. */
bool stage_find_name(const assay_bundle_reader *bundle, const char *pattern,
                     char name[ASSAY_BUNDLE_NAME]);
/* Likewise of an input: without the last batch, where .../batch_end counts them, there is none. */
bool stage_find_input(const assay_bundle_reader *bundle, const char *pattern,
                      char name[ASSAY_BUNDLE_NAME]);
/* Of a candidate's operations, and of what it takes in. */
rounding stage_rounding_of(assay_precision precision);
/* Unit roundoff of an array's type, and what a number may lose to underflow when it is stored. */
double stage_roundoff_of(const assay_bundle_entry *entry);
double stage_tiny_of(const assay_bundle_entry *entry);

/* Whether the bundle has what the stage needs. */
bool stage_can_run(const oracle_stage *stage, const assay_bundle_reader *bundle);

#endif
