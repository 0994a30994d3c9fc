/* hsh_overlap.c - the one integral behind M(beta) and M_R(beta).
 *
 * Invariant: the integrand is analytic in the two variables of the rule up to the edges, so Gauss
 * converges geometrically; the nodes leave less than 1e-15 (docs/methods/basis-rotation.md).
 *
 * In polar coordinates about the y axis the region is a rectangle and the turn adds to d.  At the
 * horizon H_l^m behaves as z^(m/2), z = cos(psi) sin(d):
 *   - in psi, a map that is flat at both ends makes a power of the distance of it;
 *   - in d there are two such roots, sqrt(sin d) and sqrt(sin(d + turn)), the second as close
 * behind the end as the turn is small; d = turn sinh^2(s), d + turn = turn cosh^2(s) undoes both.
 * Functions are even in y (cosines) or odd (sines): a quarter of the sphere serves, and the matrix
 * falls into two blocks.  What is left is a product of two tall matrices, done in blocks of nodes,
 * each sum in the order of the nodes. */
#include "basis/hsh_overlap.h"

#include <string.h>

#include "core/alloc.h"
#include "core/context.h"
#include "core/numerics.h"
#include "math/quadrature.h"

enum { BLOCK = 32 }; /* nodes at a time, a multiple of 4 */

/* No smaller turn comes here (hsh_rotation.c takes it for none); the digon's has no turn inside. */
static const double SMALLEST_TURN = 0x1p-68;

/* The functions of one parity in y, and their sums. */
typedef struct {
    size_t  count;
    size_t *index;        /* in the basis                          */
    double *left, *right; /* BLOCK rows of count: weighted, turned */
    double *sum;          /* count * count                         */
} parity_block;

typedef struct {
    parity_block even, odd;
    size_t       count;       /* of the basis                          */
    double      *values;      /* BLOCK rows of count                   */
    double      *node[2];     /* d: nodes and weights in s             */
    double      *psi_node[2]; /* psi: nodes and weights of [-1, 1]     */
    int          d_nodes, psi_nodes;
    assay_vec3   here[BLOCK], there[BLOCK]; /* w, and what is turned to it   */
    double       weight[BLOCK];
    size_t       filled;
} overlap;

struct assay_hsh_turn_scratch {
    assay_context     *context;
    const assay_basis *hsh;
    overlap            work;
};

double assay_hsh_mirror_sign(const assay_basis *hsh, size_t i)
{
    int l = 0, m = 0;
    assay_basis_function(hsh, i, &l, &m);
    return ((m & 1) != 0) == (m > 0) && m ? -1.0 : 1.0;
}

static bool allocate_block(assay_context *context, size_t count, parity_block *block)
{
    block->count = count;
    block->index = assay_allocate(context, count, sizeof *block->index);
    block->left  = assay_allocate(context, BLOCK * count, sizeof(double));
    block->right = assay_allocate(context, BLOCK * count, sizeof(double));
    block->sum   = assay_allocate(context, count * count, sizeof(double));
    return block->index && block->left && block->right && block->sum;
}

static void release_block(assay_context *context, parity_block *block)
{
    assay_release(context, block->index);
    assay_release(context, block->left);
    assay_release(context, block->right);
    assay_release(context, block->sum);
}

static void release(assay_context *context, overlap *o)
{
    release_block(context, &o->even);
    release_block(context, &o->odd);
    assay_release(context, o->values);
    for (int i = 0; i < 2; i++) {
        assay_release(context, o->node[i]);
        assay_release(context, o->psi_node[i]);
    }
}

static assay_status allocate(assay_context *context, const assay_basis *hsh, int d_nodes,
                             int psi_nodes, overlap *o)
{
    const size_t n = (size_t)assay_basis_order(hsh);
    *o             = (overlap){.count = n * n, .d_nodes = d_nodes, .psi_nodes = psi_nodes};
    bool have      = allocate_block(context, n * (n + 1) / 2, &o->even);
    have           = allocate_block(context, n * (n - 1) / 2, &o->odd) && have;
    o->values      = assay_allocate(context, BLOCK * o->count, sizeof(double));
    for (int i = 0; i < 2; i++) {
        o->node[i]     = assay_allocate(context, (size_t)d_nodes, sizeof(double));
        o->psi_node[i] = assay_allocate(context, (size_t)psi_nodes, sizeof(double));
        have           = have && o->node[i] && o->psi_node[i];
    }
    if (!have || !o->values) {
        release(context, o);
        return assay_fail_memory(context, "the overlap of hemispherical harmonics");
    }
    size_t even = 0, odd = 0;
    for (size_t i = 0; i < o->count; i++) {
        int l = 0, m = 0;
        assay_basis_function(hsh, i, &l, &m);
        if (m < 0) {
            o->odd.index[odd++] = i;
        } else {
            o->even.index[even++] = i;
        }
    }
    return ASSAY_OK;
}

static void scatter(const parity_block *block, const overlap *o, bool weighted, double *rows)
{
    for (size_t q = 0; q < o->filled; q++) {
        const double  weight = weighted ? o->weight[q] : 1.0;
        const double *values = o->values + q * o->count;
        double       *row    = rows + q * block->count;
        for (size_t i = 0; i < block->count; i++) {
            row[i] = weight * values[block->index[i]];
        }
    }
}

/* sum += left' right over a whole block. */
static void accumulate(parity_block *block)
{
    const size_t n = block->count;
    for (size_t i = 0; i < n; i++) {
        double *restrict sum = block->sum + i * n;
        for (size_t q = 0; q < BLOCK; q += 4) {
            const double *a  = block->left + q * n + i;
            const double *b  = block->right + q * n;
            const double  a0 = a[0], a1 = a[n], a2 = a[2 * n], a3 = a[3 * n];
            for (size_t j = 0; j < n; j++) {
                sum[j] += (a0 * b[j] + a1 * b[n + j]) + (a2 * b[2 * n + j] + a3 * b[3 * n + j]);
            }
        }
    }
}

/* Takes in the nodes that have come together. */
static assay_status flush(const assay_basis *hsh, overlap *o)
{
    parity_block *blocks[2] = {&o->even, &o->odd};
    assay_status  status    = assay_basis_evaluate_many(hsh, o->filled, o->here, o->values);
    for (int k = 0; k < 2 && !status; k++) {
        scatter(blocks[k], o, true, blocks[k]->left);
    }
    status = status ? status : assay_basis_evaluate_many(hsh, o->filled, o->there, o->values);
    for (int k = 0; k < 2 && !status; k++) {
        parity_block *block = blocks[k];
        const size_t  n     = block->count;
        scatter(block, o, false, block->right);
        memset(block->left + o->filled * n, 0, (BLOCK - o->filled) * n * sizeof(double));
        memset(block->right + o->filled * n, 0, (BLOCK - o->filled) * n * sizeof(double));
        accumulate(block);
    }
    o->filled = 0;
    return status;
}

/* Nodes enough for order n: in psi; and in a piece of s that is `length` long and reaches up to the
 * range's end.  A piece no longer than its distance from there needs LOWER nodes only.  What goes
 * as exp(k s) is at most exp(-k length) of its largest on the piece, and of that Gauss leaves (k
 * length)^48 (24!)^4 / (49 (48!)^3): together below 1e-30 for any k. */
enum { LOWER = 24 };
static int psi_nodes_for(int order) { return 2 * (2 * order + 10); }
static int d_nodes_for(int order, double length)
{
    return (int)((1.5 * order + 14.0) * (1.0 + 0.5 * length));
}

/* Ends of the pieces of [0, range] in s, from the range's end downwards: a full one, then each as
 * far from the end as all before it. */
enum { MAX_PIECES = 8 };
static int cut(double range, double *ends)
{
    static const double FULL  = 2.0;
    int                 count = 0;
    double              below = 0.0;
    ends[0]                   = range;
    while (range - below > FULL && count < MAX_PIECES - 2) {
        below         = count == 0 ? FULL : 2.0 * below;
        ends[++count] = fmax(range - below, 0.0);
    }
    if (ends[count] > 0.0) {
        ends[++count] = 0.0;
    }
    return count;
}

static int place_d_nodes(int order, double range, double *node, double *weight)
{
    double    ends[MAX_PIECES + 1];
    const int pieces = cut(range, ends);
    int       placed = 0;
    for (int i = 0; i < pieces; i++) {
        const int n = i > 0 ? LOWER : d_nodes_for(order, ends[i] - ends[i + 1]);
        if (node) {
            assay_gauss_legendre_on(ends[i + 1], ends[i], n, node + placed, weight + placed);
        }
        placed += n;
    }
    return placed;
}

static double asinh_of(double x) { return assay_log(x + sqrt(x * x + 1.0)); }

/* sinh(s), s >= 0. */
static double sinh_of(double s)
{
    const double e = assay_expm1(s);
    return 0.5 * (e + e / (1.0 + e));
}

/* Without a turn the second root is the first, and any scale undoes it. */
static double scale_for(double turn, double width)
{
    return turn == 0.0 ? width : fmax(turn, SMALLEST_TURN);
}

static assay_status integrate(const assay_basis *hsh, double turn, double scale, overlap *o)
{
    assay_status status = ASSAY_OK;
    for (int k = 0; k < o->d_nodes && !status; k++) {
        const double       sh = sinh_of(o->node[0][k]), ch = sqrt(1.0 + sh * sh);
        const double       d = scale * sh * sh, d_weight = o->node[1][k] * 2.0 * scale * sh * ch;
        const assay_sincos here = assay_sincos_radians(d), there = assay_sincos_radians(d + turn);
        for (int j = 0; j < o->psi_nodes / 2 && !status; j++) {
            /* From the end of psi: e^2 (3 - e) pi / 4, a cubic that is flat at both ends. */
            const double       e   = 1.0 - o->psi_node[0][o->psi_nodes - 1 - j];
            const assay_sincos psi = assay_sincos_radians(0.25 * ASSAY_PI * e * e * (3.0 - e));
            const double       c = psi.sin, y = psi.cos, slope = 0.75 * ASSAY_PI * e * (2.0 - e);
            const size_t       q = o->filled++;
            o->weight[q]         = 2.0 * d_weight * c * slope * o->psi_node[1][j];
            o->here[q]           = (assay_vec3){c * here.cos, y, c * here.sin};
            o->there[q]          = (assay_vec3){c * there.cos, y, c * there.sin};
            status               = o->filled == BLOCK ? flush(hsh, o) : ASSAY_OK;
        }
    }
    return status || !o->filled ? status : flush(hsh, o);
}

static void gather(const parity_block *block, size_t count, double *matrix_out)
{
    for (size_t i = 0; i < block->count; i++) {
        for (size_t j = 0; j < block->count; j++) {
            matrix_out[block->index[i] * count + block->index[j]] =
                block->sum[i * block->count + j];
        }
    }
}

/* o holds at least as many nodes as are wanted. */
static assay_status overlap_with(const assay_basis *hsh, overlap *o, double turn, double width,
                                 double *matrix_out)
{
    const size_t count = assay_basis_count(hsh);
    memset(matrix_out, 0, count * count * sizeof *matrix_out);
    if (!(width > 0.0)) {
        return ASSAY_OK;
    }
    const double scale = scale_for(turn, width);
    const double range = asinh_of(sqrt(width / scale));
    const int    order = assay_basis_order(hsh);
    o->d_nodes         = place_d_nodes(order, range, o->node[0], o->node[1]);
    memset(o->even.sum, 0, o->even.count * o->even.count * sizeof(double));
    memset(o->odd.sum, 0, o->odd.count * o->odd.count * sizeof(double));
    const assay_status status = integrate(hsh, turn, scale, o);
    if (status == ASSAY_OK) {
        gather(&o->even, count, matrix_out);
        gather(&o->odd, count, matrix_out);
    }
    return status;
}

static assay_status open_overlap(assay_context *context, const assay_basis *hsh, double range,
                                 overlap *o)
{
    const int          order = assay_basis_order(hsh);
    const assay_status status =
        allocate(context, hsh, place_d_nodes(order, range, NULL, NULL), psi_nodes_for(order), o);
    if (status == ASSAY_OK) {
        assay_gauss_legendre(o->psi_nodes, o->psi_node[0], o->psi_node[1]);
    }
    return status;
}

assay_status assay_hsh_overlap(const assay_basis *hsh, assay_context *context, double turn,
                               double width, double *matrix_out)
{
    const double range = width > 0.0 ? asinh_of(sqrt(width / scale_for(turn, width))) : 0.0;
    overlap      o;
    assay_status status = open_overlap(context, hsh, range, &o);
    if (status == ASSAY_OK) {
        status = overlap_with(hsh, &o, turn, width, matrix_out);
        release(context, &o);
    }
    return status;
}

/* ---- without an allocation ---- */

assay_status assay_hsh_turn_scratch_create(assay_context *context, const assay_basis *hsh,
                                           assay_hsh_turn_scratch **scratch_out)
{
    assay_hsh_turn_scratch *scratch = assay_allocate(context, 1, sizeof *scratch);
    if (!scratch) {
        return assay_fail_memory(context, "the overlap of hemispherical harmonics");
    }
    scratch->context = context;
    scratch->hsh     = hsh;
    const assay_status status =
        open_overlap(context, hsh, asinh_of(sqrt(ASSAY_PI / SMALLEST_TURN)), &scratch->work);
    if (status != ASSAY_OK) {
        assay_release(context, scratch);
        return status;
    }
    *scratch_out = scratch;
    return ASSAY_OK;
}

void assay_hsh_turn_scratch_destroy(assay_hsh_turn_scratch *scratch)
{
    if (scratch) {
        release(scratch->context, &scratch->work);
        assay_release(scratch->context, scratch);
    }
}

assay_status assay_hsh_turn_exactly(assay_hsh_turn_scratch *scratch, double beta,
                                    double *matrix_out)
{
    const assay_status status =
        overlap_with(scratch->hsh, &scratch->work, beta, 0.5 * (ASSAY_PI - beta), matrix_out);
    if (status == ASSAY_OK) {
        assay_hsh_add_mirrored(scratch->hsh, matrix_out);
    }
    return status;
}

void assay_hsh_add_mirrored(const assay_basis *hsh, double *matrix)
{
    const size_t n = assay_basis_count(hsh);
    for (size_t i = 0; i < n; i++) {
        const double si = assay_hsh_mirror_sign(hsh, i);
        for (size_t j = 0; j <= i; j++) {
            const double sign = si * assay_hsh_mirror_sign(hsh, j);
            const double sum  = matrix[i * n + j] + sign * matrix[j * n + i];
            matrix[i * n + j] = sum;
            matrix[j * n + i] = sign * sum;
        }
    }
}
