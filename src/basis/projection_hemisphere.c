/* projection_hemisphere.c - a latitude-longitude map on the hemisphere about any axis, exactly but
 * for rounding.
 *
 * A texel is a patch T of constant radiance.  With a function g(z) r^m cos(m phi) = G cos(m phi)
 * of the hemisphere's own frame, dw = dphi dz, Stokes' theorem makes its integral over T, cut by
 * the horizon, one along the edge of that:
 *
 *     m > 0:  G cos(m phi) dphi dz = d( G sin(m phi) dz / m )
 *     m < 0:  G sin(|m| phi) dphi dz = -d( G cos(m phi) dz / |m| )
 *     m = 0:  g(z) dphi dz = d( F(z) dphi ),  F(z) = integral of g over [z, 1].
 *
 * So the functions themselves, each with its twin's sign, serve as integrands; neighbours share an
 * edge, and what counts there is the difference of their radiances.  Along the horizon dz = 0; for
 * m = 0, F(z) = F(0) (1 - z) + K(z): K is 0 at the horizon and at the pole, where dphi has no
 * bounds, and 1 - z is what makes solid angles, for which there is a closed form (cut_area).  So
 * nothing here depends on which side of the horizon rounding puts an edge that lies in it.
 *
 * Integrals along edges, circles on the sphere: arc_rule.c.
 *
 * Invariant: rows are added from the top, each by itself, then to the sum. */
#include <string.h>

#include "basis/analysis.h"
#include "basis/arc_rule.h"
#include "basis/euler_zyz.h"
#include "basis/projection.h"
#include "core/alloc.h"
#include "core/context.h"
#include "core/numerics.h"
#include "math/quadrature.h"

enum { CHANNELS = 3, SERIES = 2 * ASSAY_BASIS_MAX_ORDER + 4, MAX_NODES = ASSAY_ARC_MAX_NODES };

typedef struct {
    assay_context  *context;
    assay_analysis *analysis;
    assay_arc_rule *rule;
    size_t          count;
    int             width, height, order;
    assay_channel   channels[CHANNELS];
    double          rotation;
    assay_vec3      east, up, south; /* world x, y and z in the hemisphere's frame              */
    /* By function: the twin, and +-1 / m; 0 and l for m = 0. */
    size_t *twin;
    double *factor;
    int    *zonal;     /* l, or -1                                                               */
    double *series;    /* order rows of SERIES: K of g_l in Legendre polynomials of 2 sqrt(z) - 1 */
    double *whole;     /* order: F(0)                                                            */
    double *values;    /* MAX_NODES rows of count                                                */
    double *edge;      /* count: one edge's integrals                                            */
    double *row, *sum; /* CHANNELS rows of count */
    double *column_angle, *column_cos; /* width + 1: see area_of_row */
    double *column_turns;
} dome;

/* ---- zonal functions ---- */

/* Legendre polynomials of x up to degree count - 1. */
static void legendre(double x, int count, double *out)
{
    out[0] = 1.0;
    out[1] = x;
    for (int k = 1; k + 1 < count; k++) {
        out[k + 1] = ((2.0 * k + 1.0) * x * out[k] - k * out[k - 1]) / (k + 1.0);
    }
}

/* K and F(0) of every zonal function: g(t^2) 2 t is a polynomial in t = sqrt(z) of degree
 * 2 order + 1 at most. */
static assay_status prepare_zonal(dome *d)
{
    enum { NODES = SERIES };
    double x[NODES], w[NODES], p[SERIES];
    assay_gauss_legendre(NODES, x, w);
    for (int i = 0; i < NODES; i++) {
        const double       t = 0.5 * (1.0 + x[i]), z = t * t;
        const assay_vec3   at     = {sqrt((1.0 - z) * (1.0 + z)), 0.0, z};
        const assay_status status = assay_analysis_evaluate(d->analysis, at, d->values);
        if (status != ASSAY_OK) {
            return status;
        }
        legendre(x[i], SERIES, p);
        for (size_t f = 0; f < d->count; f++) {
            const int l = d->zonal[f];
            for (int k = 0; l >= 0 && k + 1 < SERIES; k++) {
                /* a_k = (2 k + 1) integral of g 2 t P_k over t in [0, 1]; and the integral of P_k
                 * from t to 1 is (P_{k-1} - P_{k+1}) / (2 (2 k + 1)), for k = 0 (P_0 - P_1) / 2. */
                const double share = 0.5 * w[i] * d->values[f] * t * p[k];
                d->series[l * SERIES + k + 1] -= share;
                d->series[l * SERIES + (k > 0 ? k - 1 : 0)] += share;
            }
        }
    }
    for (int l = 0; l < d->order; l++) {
        double *f = d->series + l * SERIES, whole = 0.0;
        for (int k = 0; k < SERIES; k++) {
            whole += k % 2 ? -f[k] : f[k];
        }
        d->whole[l] = whole;
        /* less F(0) (1 - t^2), 1 - t^2 = 2/3 - P_1 / 2 - P_2 / 6 */
        f[0] -= whole * (2.0 / 3.0);
        f[1] += whole * 0.5;
        f[2] += whole * (1.0 / 6.0);
    }
    return ASSAY_OK;
}

static void add_zonal(const dome *d, double z, double weight)
{
    double p[SERIES];
    legendre(2.0 * sqrt(z) - 1.0, SERIES, p);
    const int terms = 2 * d->order + 4;
    for (size_t f = 0; f < d->count; f++) {
        if (d->zonal[f] >= 0) {
            const double *k = d->series + d->zonal[f] * SERIES;
            double        s = 0.0;
            for (int i = 0; i < terms; i++) {
                s += k[i] * p[i];
            }
            d->edge[f] += weight * s;
        }
    }
}

/* ---- edges ---- */

static assay_vec3 combine(assay_vec3 a, double s, assay_vec3 b, double t)
{
    return (assay_vec3){s * a.x + t * b.x, s * a.y + t * b.y, s * a.z + t * b.z};
}

static assay_status take_nodes(void *user, const assay_arc *arc, int count,
                               const assay_arc_node *nodes)
{
    dome      *d             = user;
    assay_vec3 at[MAX_NODES] = {{0}};
    double     dz[MAX_NODES];
    for (int i = 0; i < count; i++) {
        const assay_sincos u = assay_sincos_radians(nodes[i].u);
        const assay_vec3   p = combine(arc->cosine, u.cos, arc->sine, u.sin);
        const assay_vec3   q = combine(arc->cosine, -u.sin, arc->sine, u.cos);
        at[i]                = (assay_vec3){arc->centre.x + p.x, arc->centre.y + p.y,
                                            fmin(fmax(arc->centre.z + p.z, 0.0), 1.0)};
        dz[i]                = nodes[i].weight * q.z;
        const double square  = at[i].x * at[i].x + at[i].y * at[i].y;
        if (square > 0.0) {
            add_zonal(d, at[i].z, nodes[i].weight * (at[i].x * q.y - at[i].y * q.x) / square);
        }
    }
    const assay_status status =
        assay_analysis_evaluate_many(d->analysis, (size_t)count, at, d->values);
    for (int i = 0; i < count && status == ASSAY_OK; i++) {
        const double *values = d->values + (size_t)i * d->count;
        for (size_t f = 0; f < d->count; f++) {
            d->edge[f] += dz[i] * d->factor[f] * values[d->twin[f]];
        }
    }
    return status;
}

/* The edge between two texels: `left` has it on its left hand, seen from outside. */
static assay_status add_edge(dome *d, const assay_arc *arc, size_t left, size_t right)
{
    double step[CHANNELS];
    bool   any = false;
    for (int c = 0; c < CHANNELS; c++) {
        step[c] = (double)d->channels[c].data.f32[left] - d->channels[c].data.f32[right];
        any     = any || step[c] != 0.0;
    }
    if (!any) {
        return ASSAY_OK;
    }
    memset(d->edge, 0, d->count * sizeof *d->edge);
    const assay_status status = assay_arc_integrate(d->rule, arc, take_nodes, d);
    for (int c = 0; c < CHANNELS && status == ASSAY_OK; c++) {
        double *row = d->row + (size_t)c * d->count;
        for (size_t f = 0; f < d->count && step[c] != 0.0; f++) {
            row[f] += step[c] * d->edge[f];
        }
    }
    return status;
}

static double polar_angle(const dome *d, int row) { return ASSAY_PI * row / d->height; }
/* Of world azimuth from +z towards +x: columns run against it. */
static double azimuth(const dome *d, int column)
{
    return d->rotation - ASSAY_TWO_PI * column / d->width;
}

/* The edge above a row and those to the left of its texels. */
static assay_status add_edges(dome *d, int row)
{
    const size_t       start = (size_t)row * (size_t)d->width, width = (size_t)d->width;
    const assay_sincos theta  = assay_sincos_radians(polar_angle(d, row));
    assay_status       status = ASSAY_OK;
    assay_arc          arc;
    for (int j = 0; j < d->width && status == ASSAY_OK && row > 0; j++) {
        /* Azimuth ascends to the east, as seen on a globe: the row above is on the left hand. */
        arc = (assay_arc){
            combine(d->up, theta.cos, d->up, 0.0), combine(d->south, theta.sin, d->up, 0.0),
            combine(d->east, theta.sin, d->up, 0.0), azimuth(d, j + 1), azimuth(d, j)};
        status = add_edge(d, &arc, start - width + (size_t)j, start + (size_t)j);
    }
    /* To the south: what lies to the east, the column before, is on the left hand. */
    for (int j = 0; j < d->width && status == ASSAY_OK; j++) {
        const assay_sincos psi  = assay_sincos_radians(azimuth(d, j));
        const size_t       east = start + (size_t)(j > 0 ? j - 1 : d->width - 1);
        arc                     = (assay_arc){{0.0, 0.0, 0.0},
                                              d->up,
                                              combine(d->south, psi.cos, d->east, psi.sin),
                                              polar_angle(d, row),
                                              polar_angle(d, row + 1)};
        status                  = add_edge(d, &arc, east, start + (size_t)j);
    }
    return status;
}

/* ---- solid angles ---- */

/* Integral over y from -1 of the half width c(y) of the hemisphere's part of the circle of latitude
 * at y, about the azimuth of its axis; the axis has y = q > 0 and the distance s from the y axis:
 * cos c = -q y / (s sqrt(1 - y^2)), within |y| <= s.  By parts, with w = sqrt(s^2 - y^2). */
static double half_width_integral(double q, double s, double y)
{
    if (fabs(y) >= s) {
        return y > 0.0 ? ASSAY_PI * y : 0.0;
    }
    const double w = sqrt((s - y) * (s + y));
    return y * assay_atan2(w, -q * y) + assay_atan2(w, q);
}

/* Solid angle of what lies in y0 <= y <= y1, within the angle p of the axis's azimuth on one side,
 * and in the hemisphere. */
static double cut_area(double q, double s, double cos_p, double p, double y0, double y1)
{
    const double length = sqrt(q * q + s * s * cos_p * cos_p);
    const double border = length > 0.0 ? -s * cos_p / length : y0; /* c = p */
    const double y      = fmin(fmax(border, y0), y1);
    return half_width_integral(q, s, y) - half_width_integral(q, s, y0) + p * (y1 - y);
}

/* Adds F(0) times the solid angles of a row's texels in the hemisphere.  If its axis points down,
 * they are what the other hemisphere leaves. */
static void add_areas(dome *d, int row)
{
    const double y0 = assay_cos(polar_angle(d, row + 1)), y1 = assay_cos(polar_angle(d, row));
    const bool   down = d->up.z < 0.0;
    const double q = fabs(d->up.z), s = sqrt(d->east.z * d->east.z + d->south.z * d->south.z);
    const double full          = 2.0 * cut_area(q, s, -1.0, ASSAY_PI, y0, y1);
    double       sum[CHANNELS] = {0.0, 0.0, 0.0}, before = 0.0;
    for (int j = 0; j <= d->width; j++) {
        const double p    = d->column_angle[j];
        const double part = cut_area(q, s, d->column_cos[j], fabs(p), y0, y1);
        const double here = d->column_turns[j] * full + (p < 0.0 ? -part : part);
        for (int c = 0; c < CHANNELS && j > 0; c++) {
            const double area   = before - here; /* azimuth falls with the column */
            const double texel  = (y1 - y0) * ASSAY_TWO_PI / d->width;
            const double inside = down ? texel - area : area;
            const size_t at     = (size_t)row * (size_t)d->width + (size_t)j - 1;
            sum[c] += inside * (double)d->channels[c].data.f32[at];
        }
        before = here;
    }
    for (size_t f = 0; f < d->count; f++) {
        for (int c = 0; c < CHANNELS && d->zonal[f] >= 0; c++) {
            d->row[(size_t)c * d->count + f] += d->whole[d->zonal[f]] * sum[c];
        }
    }
}

/* Each column's azimuth from the axis's (from the opposite, where that points down). */
static void prepare_columns(dome *d)
{
    const double sign = d->up.z < 0.0 ? -1.0 : 1.0;
    const double axis = assay_atan2(sign * d->east.z, sign * d->south.z);
    for (int j = 0; j <= d->width; j++) {
        const double angle = azimuth(d, j) - axis;
        d->column_turns[j] = assay_floor(angle / ASSAY_TWO_PI + 0.5);
        d->column_angle[j] = angle - d->column_turns[j] * ASSAY_TWO_PI;
        d->column_cos[j]   = assay_cos(d->column_angle[j]);
    }
}

/* ---- all of it ---- */

static void prepare_functions(dome *d, const assay_basis *basis)
{
    for (size_t f = 0; f < d->count; f++) {
        int l, m;
        assay_basis_function(basis, f, &l, &m);
        d->twin[f]   = f;
        d->zonal[f]  = m == 0 ? l : -1;
        d->factor[f] = m == 0 ? 0.0 : 1.0 / m;
        for (size_t k = 0; k < d->count && m != 0; k++) {
            int other_l, other_m;
            assay_basis_function(basis, k, &other_l, &other_m);
            d->twin[f] = other_l == l && other_m == -m ? k : d->twin[f];
        }
    }
}

static assay_status allocate(dome *d)
{
    const size_t order = (size_t)d->order, columns = (size_t)d->width + 1;
    d->twin   = assay_allocate(d->context, d->count, sizeof *d->twin);
    d->zonal  = assay_allocate(d->context, d->count, sizeof *d->zonal);
    d->factor = assay_allocate(
        d->context, (2 + MAX_NODES + 2 * CHANNELS) * d->count + order * (SERIES + 1) + 3 * columns,
        sizeof(double));
    if (!d->twin || !d->zonal || !d->factor) {
        return assay_fail_memory(d->context, "the projection of an environment map");
    }
    d->edge         = d->factor + d->count;
    d->values       = d->edge + d->count;
    d->row          = d->values + MAX_NODES * d->count;
    d->sum          = d->row + CHANNELS * d->count;
    d->series       = d->sum + CHANNELS * d->count;
    d->whole        = d->series + order * SERIES;
    d->column_angle = d->whole + order;
    d->column_cos   = d->column_angle + columns;
    d->column_turns = d->column_cos + columns;
    return ASSAY_OK;
}

static assay_status integrate(dome *d)
{
    const size_t total  = CHANNELS * d->count;
    assay_status status = prepare_zonal(d);
    prepare_columns(d);
    for (int row = 0; row < d->height && status == ASSAY_OK; row++) {
        status = assay_progress(d->context, "project", (uint64_t)row, (uint64_t)d->height);
        memset(d->row, 0, total * sizeof *d->row);
        if (status == ASSAY_OK) {
            add_areas(d, row);
            status = add_edges(d, row);
        }
        for (size_t k = 0; k < total; k++) {
            d->sum[k] += d->row[k];
        }
    }
    for (int c = 0; c < CHANNELS && status == ASSAY_OK; c++) {
        assay_analysis_finish(d->analysis, d->sum + (size_t)c * d->count);
    }
    return status;
}

/* Rows of the matrix say where the world's axes lie in the frame.  Twice X (3 - X' X) / 2, as in
 * euler_zyz.c, leaves of 2^-20 rounding. */
static void place_axes(dome *d, const double rotation[9])
{
    assay_vec3 a[3];
    for (int i = 0; i < 3; i++) {
        a[i] = (assay_vec3){rotation[3 * i], rotation[3 * i + 1], rotation[3 * i + 2]};
    }
    for (int turn = 0; turn < 2; turn++) {
        assay_vec3 b[3];
        for (int i = 0; i < 3; i++) {
            b[i] = combine(a[i], 1.5, a[i], 0.0);
            for (int j = 0; j < 3; j++) {
                const double dot = a[i].x * a[j].x + a[i].y * a[j].y + a[i].z * a[j].z;
                b[i]             = combine(b[i], 1.0, a[j], -0.5 * dot);
            }
        }
        memcpy(a, b, sizeof a);
    }
    d->east  = a[0];
    d->up    = a[1];
    d->south = a[2];
}

static assay_status prepare(dome *d, const assay_basis *basis, const assay_image *map,
                            const double *frame)
{
    static const double identity[9] = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
    const double       *r           = frame ? frame : identity;
    assay_euler_zyz     split;
    if (!assay_basis_kind_is_hemispherical(assay_basis_kind_of(basis)) || !isfinite(d->rotation)) {
        return assay_fail(d->context, ASSAY_ERR_ARGUMENT,
                          "a map is projected to a hemispherical basis, with a finite rotation");
    }
    if (!assay_euler_zyz_split(r, &split)) {
        return assay_fail(d->context, ASSAY_ERR_DOMAIN, "the hemisphere's frame is not a rotation");
    }
    place_axes(d, r);
    assay_status status = assay_projection_check_map(d->context, map, d->channels);
    if (status == ASSAY_OK) {
        status = assay_analysis_create(d->context, basis, true, &d->analysis);
    }
    if (status == ASSAY_OK) {
        status = assay_arc_rule_create(d->context, d->order, &d->rule);
    }
    return status == ASSAY_OK ? allocate(d) : status;
}

assay_status assay_basis_project_environment_hemisphere(const assay_basis *basis,
                                                        assay_context     *context,
                                                        const assay_image *map, double rotation,
                                                        const double *frame,
                                                        double       *coefficients_out)
{
    dome         d      = {.context  = context,
                           .count    = assay_basis_count(basis),
                           .width    = assay_image_width(map),
                           .height   = assay_image_height(map),
                           .order    = assay_basis_order(basis),
                           .rotation = rotation};
    assay_status status = prepare(&d, basis, map, frame);
    if (status == ASSAY_OK && d.twin) {
        prepare_functions(&d, basis);
        status = integrate(&d);
        if (status == ASSAY_OK) {
            memcpy(coefficients_out, d.sum, CHANNELS * d.count * sizeof *coefficients_out);
        }
    }
    assay_analysis_destroy(d.analysis);
    assay_arc_rule_destroy(d.rule);
    assay_release(context, d.twin);
    assay_release(context, d.zonal);
    assay_release(context, d.factor);
    return status;
}
