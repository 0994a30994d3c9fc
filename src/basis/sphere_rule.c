/* sphere_rule.c - why these nodes.
 *
 * On the sphere the part of f times a harmonic that the trapezium rule leaves is a polynomial in
 * z = cos theta where f is one, for the factors sin^m theta come in pairs.  On the hemisphere HSH
 * and Makhotkin's functions go as sqrt(z)^m at the horizon, against which Gauss in z converges as a
 * power only; in t, z = t^2, everything is smooth again at both ends:
 *
 *     integral of g(z) dz over [0, 1] = integral of g(t^2) 2 t dt.                              */
#include "basis/sphere_rule.h"

#include "core/alloc.h"
#include "core/context.h"
#include "core/numerics.h"
#include "math/quadrature.h"

static void place_rings(assay_sphere_rule *rule, bool hemisphere)
{
    const double sector = ASSAY_TWO_PI / rule->sectors;
    for (int i = 0; i < rule->rings; i++) {
        const double node = rule->z[i];
        if (hemisphere) {
            rule->z[i]    = node * node;
            rule->sine[i] = sqrt((1.0 - node) * (1.0 + node) * (1.0 + node * node));
            rule->weight[i] *= 2.0 * node * sector;
        } else {
            rule->sine[i] = sqrt((1.0 - node) * (1.0 + node));
            rule->weight[i] *= sector;
        }
    }
    for (int j = 0; j < rule->sectors; j++) {
        const assay_sincos phi = assay_sincos_turns((double)j / rule->sectors);
        rule->cos_phi[j]       = phi.cos;
        rule->sin_phi[j]       = phi.sin;
    }
}

assay_status assay_sphere_rule_create(assay_context *context, bool hemisphere, int theta_nodes,
                                      int phi_nodes, assay_sphere_rule *rule_out)
{
    const int most = ASSAY_SPHERE_RULE_MAX_NODES;
    if (theta_nodes < 1 || phi_nodes < 1 || theta_nodes > most || phi_nodes > most) {
        return assay_fail(context, ASSAY_ERR_ARGUMENT,
                          "%d x %d quadrature nodes: from 1 to %d each way are possible",
                          theta_nodes, phi_nodes, most);
    }
    const size_t      rings = (size_t)theta_nodes, sectors = (size_t)phi_nodes;
    assay_sphere_rule rule = {.context = context, .rings = theta_nodes, .sectors = phi_nodes};
    rule.z                 = assay_allocate(context, rings, sizeof(double));
    rule.sine              = assay_allocate(context, rings, sizeof(double));
    rule.weight            = assay_allocate(context, rings, sizeof(double));
    rule.cos_phi           = assay_allocate(context, sectors, sizeof(double));
    rule.sin_phi           = assay_allocate(context, sectors, sizeof(double));
    if (!rule.z || !rule.sine || !rule.weight || !rule.cos_phi || !rule.sin_phi) {
        assay_sphere_rule_destroy(&rule);
        return assay_fail_memory(context, "a quadrature rule");
    }
    assay_gauss_legendre_on(hemisphere ? 0.0 : -1.0, 1.0, theta_nodes, rule.z, rule.weight);
    place_rings(&rule, hemisphere);
    *rule_out = rule;
    return ASSAY_OK;
}

void assay_sphere_rule_destroy(assay_sphere_rule *rule)
{
    assay_release(rule->context, rule->z);
    assay_release(rule->context, rule->sine);
    assay_release(rule->context, rule->weight);
    assay_release(rule->context, rule->cos_phi);
    assay_release(rule->context, rule->sin_phi);
}
