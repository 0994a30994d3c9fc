/* accuracy.c - the share of a lobe's energy that a basis captures, [gautron06] eq. 3.32.
 *
 * Made well defined: the sum runs over l < n; SH are integrated over the sphere with the lobe 0
 * below the horizon; ESH and LSOSH live on the hemisphere alone, LSOSH's numerator is the energy of
 * the best fit (which needs no solution of a linear system: it is the energy in an orthonormal
 * basis of the same space); Makhotkin's plain functions use their weight in numerator and
 * denominator.
 *
 * The product rule of projection.c would stumble over the edge where a Phong lobe is clamped: it
 * crosses all rings.  In polar coordinates about y,
 *
 *     w = (cos psi sin alpha, sin psi, cos psi cos alpha),   dw = cos psi dpsi dalpha,
 *
 * turned so that the mirror direction lies at psi = 0, alpha = -theta_out, the lobe is
 * (cos psi cos(alpha + theta_out))^k on a rectangle and smooth inside.  What is left are powers of
 * the distance from the sides (sqrt(z) at the horizon); a node at s in [-1, 1] goes to the share
 * (1 + s)^2 (2 - s) / 4 of a side, which makes them harmless.
 *
 * Invariant: numerator and denominator come from the same nodes, doubled until no accuracy moves by
 * more than TOLERANCE. */
#include "basis/analysis.h"
#include "basis/lobe.h"
#include "core/alloc.h"
#include "core/context.h"
#include "core/numerics.h"
#include "math/quadrature.h"

enum { FIRST_NODES = 32, MOST_NODES = 2048 };
static const double TOLERANCE = 1e-13;
/* What still counts as converged when the nodes are used up. */
static const double LAST_TOLERANCE = 1e-9;

/* An angle in [-pi/2, pi/2], by way of its distance from the nearer end, so that its cosine keeps
 * all digits there. */
typedef struct {
    double sin, cos, weight;
} angle_node;

typedef struct {
    const assay_basis    *basis;
    const assay_lobe     *lobe;
    const assay_analysis *analysis;
    size_t                count;
    assay_sincos          turn;                  /* of the lobe's azimuth                    */
    double                gap;                   /* between the last alpha and pi/2          */
    angle_node           *psi, *alpha;           /* MOST_NODES                             */
    double               *node, *weight;         /* MOST_NODES: of Gauss on [-1, 1]      */
    double               *functions, *row, *sum; /* count */
    double                row_energy, energy;
    assay_vec3            outgoing;
    double                negligible; /* of the lobe's values: 2^-64 of their bound */
} measure;

/* Angles over [-pi/2, pi/2 - gap]. */
static void place_angles(const double *node, const double *weight, int count, double gap,
                         angle_node *out)
{
    const double width = ASSAY_PI - gap;
    for (int i = 0; i < count; i++) {
        const double s     = node[i];
        const bool   right = s > 0.0;
        const double r     = right ? 1.0 - s : 1.0 + s; /* to the nearer end */
        /* (1 + s)^2 (2 - s) / 4 from the left; the mirror image of it from the right. */
        const double       distance = width * r * r * (3.0 - r) * 0.25 + (right ? gap : 0.0);
        const assay_sincos d        = assay_sincos_radians(distance);
        out[i].cos                  = d.sin;
        out[i].sin                  = right ? d.cos : -d.cos;
        out[i].weight               = weight[i] * width * 0.75 * (1.0 - s) * (1.0 + s);
    }
}

static assay_status add_node(measure *m, const angle_node *psi, const angle_node *alpha)
{
    const double     x = psi->cos * alpha->sin, y = psi->sin;
    const assay_vec3 d  = {x * m->turn.cos - y * m->turn.sin, x * m->turn.sin + y * m->turn.cos,
                           psi->cos * alpha->cos};
    const double     f  = assay_lobe_at(m->lobe, m->outgoing, d);
    const double     dw = psi->cos * psi->weight * alpha->weight;
    if (!(f > m->negligible)) {
        return ASSAY_OK;
    }
    const assay_status status = assay_analysis_evaluate(m->analysis, d, m->functions);
    if (status != ASSAY_OK) {
        return status;
    }
    for (size_t k = 0; k < m->count; k++) {
        m->row[k] += dw * f * m->functions[k];
    }
    m->row_energy +=
        dw * f * f * (assay_basis_kind_of(m->basis) == ASSAY_BASIS_MAKHOTKIN ? d.z : 1.0);
    return ASSAY_OK;
}

/* Sums of rows, then their sum: the rounding of a thousand terms, not of a million. */
static assay_status add_row(measure *m, int nodes, const angle_node *psi)
{
    m->row_energy = 0.0;
    for (size_t k = 0; k < m->count; k++) {
        m->row[k] = 0.0;
    }
    for (int j = 0; j < nodes; j++) {
        const assay_status status = add_node(m, psi, &m->alpha[j]);
        if (status != ASSAY_OK) {
            return status;
        }
    }
    m->energy += m->row_energy;
    for (size_t k = 0; k < m->count; k++) {
        m->sum[k] += m->row[k];
    }
    return ASSAY_OK;
}

/* accuracy_out: order numbers. */
static assay_status integrate(measure *m, int nodes, double *accuracy_out)
{
    assay_status status = ASSAY_OK;
    assay_gauss_legendre(nodes, m->node, m->weight);
    place_angles(m->node, m->weight, nodes, 0.0, m->psi);
    place_angles(m->node, m->weight, nodes, m->gap, m->alpha);
    m->energy = 0.0;
    for (size_t k = 0; k < m->count; k++) {
        m->sum[k] = 0.0;
    }
    for (int i = 0; i < nodes && status == ASSAY_OK; i++) {
        status = add_row(m, nodes, &m->psi[i]);
    }
    const int order = assay_basis_order(m->basis);
    for (int n = 0; n < order; n++) {
        accuracy_out[n] = 0.0;
    }
    for (size_t k = 0; k < m->count; k++) {
        int l, azimuthal;
        assay_basis_function(m->basis, k, &l, &azimuthal);
        accuracy_out[l] += m->sum[k] * m->sum[k];
    }
    double captured = 0.0;
    for (int n = 0; n < order; n++) {
        captured += accuracy_out[n];
        accuracy_out[n] = captured / m->energy;
    }
    return status;
}

/* accuracy, previous: order numbers; the result is in the first. */
static assay_status refine(measure *m, assay_context *context, double *accuracy, double *previous)
{
    const int    order  = assay_basis_order(m->basis);
    double       change = INFINITY;
    assay_status status = integrate(m, FIRST_NODES, accuracy);
    for (int nodes = 2 * FIRST_NODES; status == ASSAY_OK && nodes <= MOST_NODES; nodes *= 2) {
        for (int n = 0; n < order; n++) {
            previous[n] = accuracy[n];
        }
        status = assay_progress(context, "accuracy", (uint64_t)nodes, 2 * MOST_NODES);
        if (status == ASSAY_OK) {
            status = integrate(m, nodes, accuracy);
        }
        change = 0.0;
        for (int n = 0; n < order; n++) {
            const double moved = fabs(accuracy[n] - previous[n]);
            change             = moved <= change ? change : moved;
        }
        if (change <= TOLERANCE) {
            break;
        }
    }
    if (status == ASSAY_OK && !(change <= LAST_TOLERANCE)) {
        status = assay_fail(context, ASSAY_ERR_DOMAIN,
                            "the lobe is too narrow to be integrated with %d x %d nodes: the "
                            "accuracy still moves by %.2g",
                            MOST_NODES, MOST_NODES, change);
    }
    return status;
}

static void count_functions(const assay_basis *basis, size_t *count_out)
{
    for (int n = 0; n < assay_basis_order(basis); n++) {
        count_out[n] = 0;
    }
    for (size_t k = 0; k < assay_basis_count(basis); k++) {
        int l, m;
        assay_basis_function(basis, k, &l, &m);
        count_out[l]++;
    }
    for (int n = 1; n < assay_basis_order(basis); n++) {
        count_out[n] += count_out[n - 1];
    }
}

/* No value of the lobe is larger. */
static double bound_of(const assay_lobe *lobe, assay_vec3 outgoing)
{
    return lobe->kind == ASSAY_LOBE_PHONG
               ? 1.0
               : 1.0 / (4.0 * ASSAY_PI * lobe->alpha_x * lobe->alpha_y * sqrt(outgoing.z));
}

static void prepare(measure *m, const assay_lobe *lobe, double *work)
{
    const double turn = lobe->kind == ASSAY_LOBE_PHONG ? lobe->phi_out : 0.0;

    m->lobe       = lobe;
    m->turn       = assay_sincos_radians(turn);
    m->gap        = lobe->kind == ASSAY_LOBE_PHONG ? lobe->theta_out : 0.0;
    m->node       = work;
    m->weight     = work + MOST_NODES;
    m->functions  = work + 2 * MOST_NODES;
    m->row        = m->functions + m->count;
    m->sum        = m->row + m->count;
    m->outgoing   = assay_lobe_outgoing(lobe);
    m->negligible = 0x1p-64 * bound_of(lobe, m->outgoing);
}

assay_status assay_basis_accuracy(const assay_basis *basis, assay_context *context,
                                  const assay_lobe *lobe, double *accuracy_out, size_t *count_out)
{
    const char *problem = assay_lobe_problem(lobe);
    if (problem) {
        return assay_fail(context, ASSAY_ERR_DOMAIN, "%s", problem);
    }
    const size_t    count = assay_basis_count(basis), order = (size_t)assay_basis_order(basis);
    measure         m        = {.basis = basis, .count = count};
    assay_analysis *analysis = NULL;
    assay_status    status   = assay_analysis_create(context, basis, false, &analysis);
    double *work = assay_allocate(context, 2 * MOST_NODES + 3 * count + 2 * order, sizeof *work);
    angle_node *angles = assay_allocate(context, 2 * MOST_NODES, sizeof *angles);
    if (!work || !angles) {
        status = status == ASSAY_OK ? assay_fail_memory(context, "an accuracy") : status;
    } else if (status == ASSAY_OK) {
        prepare(&m, lobe, work);
        m.analysis       = analysis;
        m.psi            = angles;
        m.alpha          = angles + MOST_NODES;
        double *accuracy = m.sum + count;
        status           = refine(&m, context, accuracy, accuracy + order);
        for (size_t n = 0; n < order && status == ASSAY_OK; n++) {
            accuracy_out[n] = accuracy[n];
        }
    }
    if (status == ASSAY_OK && count_out) {
        count_functions(basis, count_out);
    }
    assay_analysis_destroy(analysis);
    assay_release(context, work);
    assay_release(context, angles);
    return status;
}
