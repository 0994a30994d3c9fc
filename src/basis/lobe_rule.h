/* lobe_rule.h - nodes for integrals of a lobe over the hemisphere, close where the lobe is. */
#ifndef ASSAY_BASIS_LOBE_RULE_H
#define ASSAY_BASIS_LOBE_RULE_H

#include "assay/basis.h"

typedef struct {
    assay_vec3 direction;
    double     value; /* the lobe's                                                       */
    double     share; /* value times solid angle, in units of assay_lobe_rule_scale       */
} assay_lobe_node;

typedef struct assay_lobe_rule assay_lobe_rule;

/* most: the largest number of nodes a row that will be asked for.  The lobe must be free of
 * problems; it is copied.  Errors: MEMORY. */
assay_status assay_lobe_rule_create(assay_context *context, const assay_lobe *lobe, int most,
                                    assay_lobe_rule **rule_out);
void         assay_lobe_rule_destroy(assay_lobe_rule *rule);

/* Makes it the rule of `nodes` a row; answers the number of rows. */
int assay_lobe_rule_begin(assay_lobe_rule *rule, int nodes);
/* Writes a row's nodes, without those where the lobe is negligible; answers how many. */
int assay_lobe_rule_row(const assay_lobe_rule *rule, int row, assay_lobe_node *nodes_out);

/* sr; keeps the shares of the narrowest lobes within double's range. */
double assay_lobe_rule_scale(const assay_lobe_rule *rule);

#endif
