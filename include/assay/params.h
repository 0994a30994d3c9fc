/* params.h - tunable parameters: one table each method, from which the command line's flags, the
 * help, the defaults and the metadata of results are made. */
#ifndef ASSAY_PARAMS_H
#define ASSAY_PARAMS_H

#include "assay/context.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum {
    ASSAY_PARAM_INT,    /* whole number in [minimum, maximum]; "inf" where the maximum is
                           ASSAY_PARAM_INF                                                     */
    ASSAY_PARAM_REAL,   /* finite number in [minimum, maximum]                                 */
    ASSAY_PARAM_BOOL,   /* on | off                                                           */
    ASSAY_PARAM_CHOICE, /* one of the words of `choices`, separated by '|'                    */
    ASSAY_PARAM_PATH    /* of a file or folder; "" is none                                    */
} assay_param_type;

/* Stands for "inf" in a whole number: exact in a double. */
#define ASSAY_PARAM_INF 2147483647.0

typedef struct {
    const char      *name; /* "roulette_depth"; NULL ends a table  */
    assay_param_type type;
    const char      *unit;          /* "" where it has none                 */
    const char      *default_value; /* as the user would type it            */
    double           minimum, maximum;
    const char      *choices; /* "nee|bsdf|mis", or NULL              */
    const char      *summary; /* one sentence                         */
    const char      *source;  /* paper and equation, or ""            */
} assay_param_desc;

typedef struct assay_params assay_params;

/* Values for a table, all at their defaults.  The table is borrowed and must outlive them. */
ASSAY_API assay_status assay_params_create(assay_context *context, const assay_param_desc *table,
                                           assay_params **params_out);
ASSAY_API void         assay_params_destroy(assay_params *params);

/* Errors: ARGUMENT with a message that names the parameter and what it takes. */
ASSAY_API assay_status assay_params_set(assay_params *params, const char *name, const char *value);

/* The value as it was set, in canonical form; borrowed; NULL for an unknown name. */
ASSAY_API const char *assay_params_text(const assay_params *params, const char *name);

/* Asking for a name that is not in the table, or by another type, is a programmer's error. */
ASSAY_API double assay_params_real(const assay_params *params, const char *name);
ASSAY_API int    assay_params_int(const assay_params *params, const char *name);
ASSAY_API bool   assay_params_bool(const assay_params *params, const char *name);
/* Index of the chosen word among the choices. */
ASSAY_API int assay_params_choice(const assay_params *params, const char *name);

ASSAY_API const assay_param_desc *assay_params_table(const assay_params *params);

#ifdef __cplusplus
}
#endif
#endif
