/* lobe_rule.c - coordinates in which a lobe is smooth, wide or narrow.
 *
 * Three kinds, each a product of Gauss's rule along a row and a rule over the rows.
 *
 * Phong, exponent up to WIDEST_FOCUS.  Where the lobe is clamped at 90 degrees it has an edge.  In
 * polar coordinates about y,
 *
 *     w = (cos psi sin alpha, sin psi, cos psi cos alpha),   dw = cos psi dpsi dalpha,
 *
 * turned so that the mirror direction lies at psi = 0, alpha = -theta_out, the lobe is
 * (cos psi cos(alpha + theta_out))^k on a rectangle and smooth inside.
 *
 * Phong, larger exponents.  In polar coordinates (alpha, psi) about the mirror direction, alpha
 * goes from 0 to where the lobe is e^-REACH or to the horizon, whichever comes first; at psi from
 * the highest direction the horizon lies at cot alpha_h = -tan(theta_out) cos psi, and z =
 * sqrt(cos^2 theta_out + sin^2 theta_out cos^2 psi) sin(alpha_h - alpha).
 *
 * Ward.  The half vector's slopes over the widths, (hx / hz / alpha_x, hy / hz / alpha_y) =
 * s (cos psi, sin psi), make a Gaussian of it whatever the widths:
 *
 *     f dw = sqrt(wi.z / wo.z) (wo . h) h.z^3 exp(-s^2) / pi  s ds dpsi,
 *
 * for dw = 4 (wo . h) dw_h, dw_h = h.z^3 d(slopes).  With v the slope of s = 1 and t that of wo,
 * wi.z = h.z^2 wo.z (1 + 2 s v.t - s^2 v.v), whose root s_h is the horizon.
 *
 * In the last two the integrand is analytic and of period 2 pi in psi: the trapezium rule.  (Where
 * the two ends of a row meet the lobe is e^-REACH, so that the change is not seen.)  What is left
 * are powers of the distance from the ends (sqrt(z) at the horizon); a node at x in [-1, 1] goes to
 * the share (1 + x)^2 (2 - x) / 4, which makes them harmless.
 *
 * Invariant: directions have z >= 0; nodes depend on lobe and number alone. */
#include "basis/lobe_rule.h"

#include "basis/lobe.h"
#include "core/alloc.h"
#include "core/context.h"
#include "core/numerics.h"
#include "math/quadrature.h"

static const double WIDEST_FOCUS = 64.0;
static const double REACH        = 56.0;
/* Smaller values of the lobe, relative to its bound, are left out. */
static const double NEGLIGIBLE = 0x1p-64;

/* An angle in [-pi/2, pi/2], by way of its distance from the nearer end, so that its cosine keeps
 * all digits there. */
typedef struct {
    double sin, cos, weight;
} angle_node;

struct assay_lobe_rule {
    assay_context *context;
    assay_lobe     lobe;
    assay_vec3     outgoing;
    assay_sincos   turn, tilt; /* of azimuth and polar angle of the outgoing direction */
    bool           rectangle;
    double         limit, scale, negligible;
    int            nodes;
    double        *node, *weight; /* Gauss on [-1, 1] */
    angle_node    *psi, *alpha;   /* of the rectangle */
};

/* Angles over [-pi/2, pi/2 - gap]. */
static void place_angles(const assay_lobe_rule *rule, double gap, angle_node *out)
{
    const double width = ASSAY_PI - gap;
    for (int i = 0; i < rule->nodes; i++) {
        const double s     = rule->node[i];
        const bool   right = s > 0.0;
        const double r     = right ? 1.0 - s : 1.0 + s; /* to the nearer end */
        /* (1 + s)^2 (2 - s) / 4 from the left; the mirror image of it from the right. */
        const double       distance = width * r * r * (3.0 - r) * 0.25 + (right ? gap : 0.0);
        const assay_sincos d        = assay_sincos_radians(distance);
        out[i].cos                  = d.sin;
        out[i].sin                  = right ? d.cos : -d.cos;
        out[i].weight               = rule->weight[i] * width * 0.75 * (1.0 - s) * (1.0 + s);
    }
}

assay_status assay_lobe_rule_create(assay_context *context, const assay_lobe *lobe, int most,
                                    assay_lobe_rule **rule_out)
{
    assay_lobe_rule *rule = assay_allocate(context, 1, sizeof *rule);
    if (!rule) {
        return assay_fail_memory(context, "a lobe's quadrature");
    }
    const bool phong = lobe->kind == ASSAY_LOBE_PHONG;
    rule->context    = context;
    rule->lobe       = *lobe;
    rule->outgoing   = assay_lobe_outgoing(lobe);
    rule->turn       = assay_sincos_radians(lobe->phi_out);
    rule->tilt       = assay_sincos_radians(lobe->theta_out);
    rule->rectangle  = phong && lobe->exponent <= WIDEST_FOCUS;
    rule->scale      = 1.0;
    rule->limit      = sqrt(REACH);
    if (phong && !rule->rectangle) {
        /* cos^k = e^-REACH */
        rule->limit = 2.0 * assay_asin(sqrt(-0.5 * assay_expm1(-REACH / lobe->exponent)));
        rule->scale = rule->limit;
    }
    rule->negligible = phong ? NEGLIGIBLE : NEGLIGIBLE / sqrt(rule->outgoing.z);
    rule->node       = assay_allocate(context, 2 * (size_t)most, sizeof(double));
    rule->weight     = rule->node ? rule->node + most : NULL;
    rule->psi        = assay_allocate(context, 2 * (size_t)most, sizeof(angle_node));
    rule->alpha      = rule->psi ? rule->psi + most : NULL;
    if (!rule->node || !rule->psi) {
        assay_lobe_rule_destroy(rule);
        return assay_fail_memory(context, "a lobe's quadrature");
    }
    *rule_out = rule;
    return ASSAY_OK;
}

void assay_lobe_rule_destroy(assay_lobe_rule *rule)
{
    if (rule) {
        assay_release(rule->context, rule->node);
        assay_release(rule->context, rule->psi);
        assay_release(rule->context, rule);
    }
}

double assay_lobe_rule_scale(const assay_lobe_rule *rule) { return rule->scale * rule->scale; }

int assay_lobe_rule_begin(assay_lobe_rule *rule, int nodes)
{
    rule->nodes = nodes;
    assay_gauss_legendre(nodes, rule->node, rule->weight);
    if (rule->rectangle) {
        place_angles(rule, 0.0, rule->psi);
        place_angles(rule, rule->lobe.theta_out, rule->alpha);
    }
    return rule->rectangle ? nodes : 2 * nodes;
}

static int rectangle_row(const assay_lobe_rule *rule, int row, assay_lobe_node *out)
{
    const angle_node *psi   = &rule->psi[row];
    int               count = 0;
    for (int i = 0; i < rule->nodes; i++) {
        const angle_node *alpha = &rule->alpha[i];
        const double      x = psi->cos * alpha->sin, y = psi->sin;
        const assay_vec3  d = {x * rule->turn.cos - y * rule->turn.sin,
                               x * rule->turn.sin + y * rule->turn.cos, psi->cos * alpha->cos};
        const double      f = assay_lobe_at(&rule->lobe, rule->outgoing, d);
        if (f > rule->negligible) {
            out[count++] = (assay_lobe_node){d, f, f * psi->cos * psi->weight * alpha->weight};
        }
    }
    return count;
}

/* A node's distance from the end, in units of the stretch, and its weight in the same. */
static double from_end(const assay_lobe_rule *rule, int i, double *weight_out)
{
    const double x = rule->node[i], r = 1.0 - x;
    *weight_out = rule->weight[i] * 0.75 * r * (1.0 + x);
    return 0.25 * r * r * (3.0 - r);
}

static int phong_row(const assay_lobe_rule *rule, int row, assay_lobe_node *out)
{
    const assay_sincos psi     = assay_sincos_turns((double)row / (2.0 * rule->nodes));
    const double       rise    = rule->tilt.sin * psi.cos;
    const double       slope   = sqrt(rule->tilt.cos * rule->tilt.cos + rise * rise);
    const double       horizon = assay_atan2(rule->tilt.cos, -rise);
    const double       end     = fmin(horizon, rule->limit);
    int                count   = 0;
    for (int i = 0; i < rule->nodes; i++) {
        double             weight;
        const double       rest  = from_end(rule, i, &weight);
        const double       angle = end * (1.0 - rest);
        const assay_sincos a     = assay_sincos_radians(angle);
        const double       half  = assay_sin(0.5 * angle);
        const double       f     = assay_exp(rule->lobe.exponent * assay_log1p(-2.0 * half * half));
        /* Away from the mirror direction: along the tilt, and aside. */
        const double     along = -rule->tilt.sin * a.cos + rule->tilt.cos * psi.cos * a.sin;
        const double     aside = psi.sin * a.sin;
        const assay_vec3 d     = {rule->turn.cos * along - rule->turn.sin * aside,
                                  rule->turn.sin * along + rule->turn.cos * aside,
                                  slope * assay_sin(horizon - end + end * rest)};
        const double     step  = ASSAY_PI / rule->nodes;
        if (f > rule->negligible) {
            out[count++] = (assay_lobe_node){
                d, f, f * step * (a.sin / rule->scale) * (end / rule->scale) * weight};
        }
    }
    return count;
}

static int ward_row(const assay_lobe_rule *rule, int row, assay_lobe_node *out)
{
    const assay_lobe  *lobe  = &rule->lobe;
    const assay_vec3   wo    = rule->outgoing;
    const assay_sincos psi   = assay_sincos_turns((double)row / (2.0 * rule->nodes));
    const double       large = fmax(lobe->alpha_x, lobe->alpha_y);
    const double       vx = lobe->alpha_x / large * psi.cos, vy = lobe->alpha_y / large * psi.sin;
    const double       length  = sqrt(vx * vx + vy * vy);
    const double       v       = length * large;
    const double       t       = (vx * wo.x + vy * wo.y) / (length * wo.z);
    const double       reach   = t > 0.0 ? t + sqrt(t * t + 1.0) : 1.0 / (sqrt(t * t + 1.0) - t);
    const double       horizon = reach / v;
    const double       end     = fmin(horizon, rule->limit);
    int                count   = 0;
    for (int i = 0; i < rule->nodes; i++) {
        double       weight;
        const double rest = from_end(rule, i, &weight);
        const double s = end * (1.0 - rest), slope = s * v;
        /* 1 - s / horizon, in the row's last part without a difference */
        const double under = end < horizon ? 1.0 - slope / reach : rest;
        const double hz    = 1.0 / sqrt(1.0 + slope * slope);
        const double hx = slope * hz * (vx / length), hy = slope * hz * (vy / length);
        const double dot   = wo.x * hx + wo.y * hy + wo.z * hz;
        const double wi_z  = hz * hz * wo.z * under * (1.0 + slope * reach);
        const double bell  = sqrt(wi_z / wo.z) * assay_exp(-s * s);
        const double value = bell / (4.0 * ASSAY_PI * lobe->alpha_x * lobe->alpha_y);
        if (bell > rule->negligible) {
            out[count++] =
                (assay_lobe_node){{2.0 * dot * hx - wo.x, 2.0 * dot * hy - wo.y, wi_z},
                                  value,
                                  bell * dot * hz * hz * hz * s * end * weight / rule->nodes};
        }
    }
    return count;
}

int assay_lobe_rule_row(const assay_lobe_rule *rule, int row, assay_lobe_node *nodes_out)
{
    if (rule->rectangle) {
        return rectangle_row(rule, row, nodes_out);
    }
    return rule->lobe.kind == ASSAY_LOBE_PHONG ? phong_row(rule, row, nodes_out)
                                               : ward_row(rule, row, nodes_out);
}
