/* arc_rule.c - where the nodes go.
 *
 * On a circle z = a + r cos(u - top), and hemispherical functions are analytic in u but for powers
 * of sqrt(z).  Their branch points are the two ends of the arc z > 0 (with all turns of them), or,
 * where the circle stays above the horizon, a pair beside its lowest point, i acosh(a / r) off the
 * real axis.
 *
 * A piece is halved until it is shorter than LONGEST and, but for the one end e it lies next to,
 * nearer to no branch point than its own length.  The root at e is undone by u = e +- t^2.  So the
 * Bernstein ellipse in which a piece's integrand is analytic has the half-axes' sum rho >= 3.3 in t
 * (the branch point at twice the length: t = sqrt(2), the interval [0, 1]), >= 5.8 in u; and
 * larger, by the distance, for nearly all arcs.
 *
 * With N the order plus 1 and h half the length, what is integrated grows on the ellipse at most as
 * exp(N h (rho - 1 / rho) / 2) for a trigonometric polynomial of degree N; twice that is allowed
 * for, which covers the factors (1 + z)^(-m/2).  Gauss leaves some exp(growth) rho^(-2 n) of the
 * largest value; n is the least that makes it 2^-55 for any rho that the distance allows.
 *
 * Invariant: pieces in order of u; nodes of a piece depend on the arc alone. */
#include "basis/arc_rule.h"

#include "core/alloc.h"
#include "core/context.h"
#include "core/numerics.h"
#include "math/quadrature.h"

enum { DISTANCES = 4, LENGTHS = 48, MAX_NODES = ASSAY_ARC_MAX_NODES };

static const double LONGEST = 0.5;
/* Pieces this short are not halved for a branch point's sake: what they hold is rounding. */
static const double SHORTEST = 0x1p-46;

/* A piece that is this many of its lengths from branch points (the first row: in t) has the
 * ellipse. */
static const struct {
    double distance, rho;
} REACH[DISTANCES] = {{0.0, 3.3}, {1.0, 5.8}, {8.0, 33.0}, {64.0, 250.0}};

struct assay_arc_rule {
    assay_context *context;
    int            nodes[DISTANCES][LENGTHS]; /* by -log2 of the length, rounded down */
    double         x[MAX_NODES + 1][MAX_NODES], w[MAX_NODES + 1][MAX_NODES]; /* Gauss [-1, 1] */
};

static int nodes_for(int order, double length, double largest_rho)
{
    static const double trial[] = {1.5, 2.0, 3.3, 5.8, 12.0, 33.0, 90.0, 250.0};
    const double        phase   = (order + 1) * 0.5 * length;
    double              least   = MAX_NODES;
    for (size_t i = 0; i < sizeof trial / sizeof trial[0] && trial[i] <= largest_rho; i++) {
        const double growth = phase * (trial[i] - 1.0 / trial[i]);
        least = fmin(least, (growth + 55.0 * 0.6931471805599453) / (2.0 * assay_log(trial[i])));
    }
    return (int)fmin(floor(least) + 2.0, MAX_NODES);
}

assay_status assay_arc_rule_create(assay_context *context, int order, assay_arc_rule **rule_out)
{
    assay_arc_rule *rule = assay_allocate(context, 1, sizeof *rule);
    if (!rule) {
        return assay_fail_memory(context, "a rule along arcs");
    }
    rule->context = context;
    for (int d = 0; d < DISTANCES; d++) {
        double length = 1.0;
        for (int k = 0; k < LENGTHS; k++) {
            rule->nodes[d][k] = nodes_for(order, length, REACH[d].rho);
            length *= 0.5;
        }
    }
    for (int n = 1; n <= MAX_NODES; n++) {
        assay_gauss_legendre(n, rule->x[n], rule->w[n]);
    }
    *rule_out = rule;
    return ASSAY_OK;
}

void assay_arc_rule_destroy(assay_arc_rule *rule)
{
    if (rule) {
        assay_release(rule->context, rule);
    }
}

/* One arc at work. */
typedef struct {
    const assay_arc_rule *rule;
    const assay_arc      *arc;
    assay_arc_taker       take;
    void                 *user;
    bool                  crosses;
    double                first, last; /* ends of the arc z > 0, where the circle crosses        */
    double                below;       /* what lies between last and the next turn's first       */
    double                lowest;      /* else: u of the lowest point                            */
    double                aside;       /* and how far off the real axis the branch points are    */
} walk;

static int length_class(double length)
{
    int class = 0;
    while (class < LENGTHS - 1 && length <= 0.5) {
        length *= 2.0;
        class ++;
    }
    return class;
}

static assay_status take_piece(walk *w, double from, double to, int distance)
{
    const assay_arc_rule *rule = w->rule;
    const int             n    = rule->nodes[distance][length_class(to - from)];
    assay_arc_node        nodes[MAX_NODES];
    const bool            by_root = distance == 0, right = w->last - to < from - w->first;
    const double          end = right ? w->last : w->first;
    const double          a   = by_root ? sqrt(fmax(right ? end - to : from - end, 0.0)) : from;
    const double          b   = by_root ? sqrt(right ? end - from : to - end) : to;
    for (int i = 0; i < n; i++) {
        /* From a right end t runs backwards. */
        const int    k  = by_root && right ? n - 1 - i : i;
        const double t  = 0.5 * (a + b) + 0.5 * (b - a) * rule->x[n][k];
        nodes[i].u      = !by_root ? t : right ? end - t * t : end + t * t;
        nodes[i].weight = 0.5 * (b - a) * rule->w[n][k] * (by_root ? 2.0 * t : 1.0);
    }
    return w->take(w->user, w->arc, n, nodes);
}

/* Distance of [from, to] to the nearest branch point; *next_out: without the end next to it. */
static double distance_of(const walk *w, double from, double to, double *next_out)
{
    if (w->crosses) {
        const double left = fmax(from - w->first, 0.0), right = fmax(w->last - to, 0.0);
        *next_out = fmin(fmax(left, right), fmin(left, right) + w->below);
        return fmin(left, right);
    }
    const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
    const double turns = assay_floor((middle - w->lowest) / ASSAY_TWO_PI + 0.5);
    const double off   = fmax(fabs(middle - w->lowest - turns * ASSAY_TWO_PI) - half, 0.0);
    const double d     = sqrt(off * off + w->aside * w->aside);
    *next_out          = d;
    return d;
}

static assay_status walk_over(walk *w, double from, double to)
{
    const double length = to - from;
    double       next;
    const double nearest = distance_of(w, from, to, &next);
    if (length > LONGEST || (next < length && length > SHORTEST)) {
        const double       middle = 0.5 * (from + to);
        const assay_status status = walk_over(w, from, middle);
        return status == ASSAY_OK ? walk_over(w, middle, to) : status;
    }
    int distance = w->crosses ? 0 : 1;
    for (int d = 1; d < DISTANCES; d++) {
        distance = nearest >= REACH[d].distance * length ? d : distance;
    }
    return take_piece(w, from, to, distance);
}

static assay_status walk_where_above(walk *w, double top, double half)
{
    const assay_arc *arc    = w->arc;
    const double     turn   = assay_floor((arc->from - (top + half)) / ASSAY_TWO_PI) + 1.0;
    assay_status     status = ASSAY_OK;
    w->crosses              = true;
    w->below                = ASSAY_TWO_PI - 2.0 * half;
    for (int k = 0; k < 3 && status == ASSAY_OK; k++) {
        const double middle = top + (turn + k) * ASSAY_TWO_PI;
        w->first            = middle - half;
        w->last             = middle + half;
        const double from = fmax(arc->from, w->first), to = fmin(arc->to, w->last);
        if (from < to) {
            status = walk_over(w, from, to);
        }
    }
    return status;
}

assay_status assay_arc_integrate(const assay_arc_rule *rule, const assay_arc *arc,
                                 assay_arc_taker take, void *user)
{
    walk         w = {.rule = rule, .arc = arc, .take = take, .user = user};
    const double a = arc->centre.z, b = arc->cosine.z, c = arc->sine.z;
    const double r = sqrt(b * b + c * c);
    if (a + r <= 0.0 || !(arc->from < arc->to)) {
        return ASSAY_OK;
    }
    const double top = r > 0.0 ? assay_atan2(c, b) : 0.0;
    if (a < r) {
        /* cos(half) = -a / r, half by its tangent's half angle: exact near both ends. */
        return walk_where_above(&w, top, 2.0 * assay_atan2(sqrt(r + a), sqrt(r - a)));
    }
    w.lowest = top + ASSAY_PI;
    /* acosh(a / r) = 2 asinh(sqrt((a - r) / (2 r))) */
    const double s = r > 0.0 ? sqrt(0.5 * (a - r) / r) : 1e9;
    w.aside        = s < 1e9 ? 2.0 * assay_log(s + sqrt(s * s + 1.0)) : 40.0;
    return walk_over(&w, arc->from, arc->to);
}
