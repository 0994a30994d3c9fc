/* arc_rule.h - nodes along an arc of a circle on the sphere, over the part with z > 0. */
#ifndef ASSAY_BASIS_ARC_RULE_H
#define ASSAY_BASIS_ARC_RULE_H

#include "assay/basis.h"

/* Points centre + cosine cos u + sine sin u, from <= u <= to, at most a full turn. */
typedef struct {
    assay_vec3 centre, cosine, sine;
    double     from, to; /* rad */
} assay_arc;

/* weight: du of the node. */
typedef struct {
    double u, weight;
} assay_arc_node;

typedef struct assay_arc_rule assay_arc_rule;

/* For integrands that are sums of basis functions of an order, times du, dz or dphi.
 * Errors: MEMORY. */
assay_status assay_arc_rule_create(assay_context *context, int order, assay_arc_rule **rule_out);
void         assay_arc_rule_destroy(assay_arc_rule *rule);

/* Calls `take` with the nodes of each piece in turn, at most ASSAY_ARC_MAX_NODES at a time, u
 * ascending from piece to piece; stops at what it answers but ASSAY_OK. */
enum { ASSAY_ARC_MAX_NODES = 48 };
typedef assay_status (*assay_arc_taker)(void *user, const assay_arc *arc, int count,
                                        const assay_arc_node *nodes);
assay_status assay_arc_integrate(const assay_arc_rule *rule, const assay_arc *arc,
                                 assay_arc_taker take, void *user);

#endif
