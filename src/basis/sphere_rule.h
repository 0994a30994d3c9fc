/* sphere_rule.h - nodes on the sphere or the hemisphere: Gauss in theta, trapezium in phi. */
#ifndef ASSAY_BASIS_SPHERE_RULE_H
#define ASSAY_BASIS_SPHERE_RULE_H

#include "assay/basis.h"

#define ASSAY_SPHERE_RULE_MAX_NODES 65536

/* rings * sectors directions; those of a ring share z and weight. */
typedef struct {
    assay_context *context;
    int            rings, sectors;
    double        *z, *sine, *weight; /* rings: cos theta, sin theta; solid angle of a node, sr */
    double        *cos_phi, *sin_phi; /* sectors                                                */
} assay_sphere_rule;

/* Errors: ARGUMENT (a number of nodes < 1 or > ASSAY_SPHERE_RULE_MAX_NODES), MEMORY; the rule then
 * holds nothing. */
assay_status assay_sphere_rule_create(assay_context *context, bool hemisphere, int theta_nodes,
                                      int phi_nodes, assay_sphere_rule *rule_out);
void         assay_sphere_rule_destroy(assay_sphere_rule *rule);

static inline assay_vec3 assay_sphere_rule_direction(const assay_sphere_rule *rule, int ring,
                                                     int sector)
{
    return (assay_vec3){rule->sine[ring] * rule->cos_phi[sector],
                        rule->sine[ring] * rule->sin_phi[sector], rule->z[ring]};
}

#endif
