/* gen_accuracy_ward.c - accuracy_ward: Ward's BRDF (0.2, 0.5) [ward92] eq. 5 times cos(theta_i).
 *
 *     f = sqrt(z / cos t) exp(-q) / (4 pi ax ay),
 *     q = ((x + sin t)^2 / ax^2 + y^2 / ay^2) / (z + cos t)^2,   outgoing direction (sin t, 0, cos
 * t)
 *
 * Coordinates z = cos^2 u, (x, y) = sin u sqrt(1 + cos^2 u) (cos p, sin p), dw = 2 cos u sin u du
 * dp, 0 <= u <= pi / 2: Gauss's rule in u (bound on an ellipse with the half-axes' sum rho, lune.c)
 * and the trapezium rule of N nodes over the period in p.
 *
 * Invariant: each sum is widened by what the rules can leave out.  In p the integrand is entire and
 * of period 2 pi; if it is at most M for |Im p| <= eta, the rule errs by less than
 * 4 pi M / (exp(eta N) - 1), as its Fourier coefficients are at most M exp(-eta |k|) and the rule
 * confuses 0 with the multiples of N.  In u the roots are analytic if finite on the boundary
 * (lune.c), and 1 / (z + cos t) is since Re (z + cos t) > 0 on the boundary, hence inside. */
#include <acb.h>
#include <arb_hypgeom.h>
#include <math.h>
#include <stdlib.h>

#include "accuracy.h"
#include "bernstein.h"

typedef struct {
    double theta;
} task;

typedef struct {
    arb_t sine, cosine; /* of theta */
    arb_t ax2, ay2;     /* 1 / alpha^2 */
    arb_t factor;       /* 1 / (4 pi ax ay sqrt(cos theta)) */
} lobe;

/* The coordinates at u. */
typedef struct {
    acb_t z, root_z, rho, weight;
} ring;

static void lobe_init(lobe *f, double theta, slong precision)
{
    arb_init(f->sine);
    arb_init(f->cosine);
    arb_init(f->ax2);
    arb_init(f->ay2);
    arb_init(f->factor);
    arb_set_d(f->sine, theta);
    arb_sin_cos(f->sine, f->cosine, f->sine, precision);
    arb_set_d(f->ax2, 0.2);
    arb_set_d(f->ay2, 0.5);
    arb_const_pi(f->factor, precision);
    arb_mul_2exp_si(f->factor, f->factor, 2);
    arb_mul(f->factor, f->factor, f->ax2, precision);
    arb_mul(f->factor, f->factor, f->ay2, precision);
    arb_inv(f->factor, f->factor, precision);
    arb_rsqrt(f->ax2, f->cosine, precision);
    arb_mul(f->factor, f->factor, f->ax2, precision);
    arb_set_d(f->ax2, 0.2);
    arb_sqr(f->ax2, f->ax2, precision);
    arb_inv(f->ax2, f->ax2, precision);
    arb_sqr(f->ay2, f->ay2, precision);
    arb_inv(f->ay2, f->ay2, precision);
}

static void lobe_clear(lobe *f)
{
    arb_clear(f->sine);
    arb_clear(f->cosine);
    arb_clear(f->ax2);
    arb_clear(f->ay2);
    arb_clear(f->factor);
}

static void ring_init(ring *r)
{
    acb_init(r->z);
    acb_init(r->root_z);
    acb_init(r->rho);
    acb_init(r->weight);
}

static void ring_clear(ring *r)
{
    acb_clear(r->z);
    acb_clear(r->root_z);
    acb_clear(r->rho);
    acb_clear(r->weight);
}

/* u = pi / 4 (1 + s); weight: dw / (du dp). */
static void ring_at(ring *r, const acb_t s, slong precision)
{
    acb_t u;
    acb_init(u);
    acb_add_si(u, s, 1, precision);
    acb_mul_2exp_si(u, u, -2);
    acb_sin_cos_pi(r->rho, r->root_z, u, precision);
    acb_sqr(r->z, r->root_z, precision);
    acb_mul(r->weight, r->rho, r->root_z, precision);
    acb_mul_2exp_si(r->weight, r->weight, 1);
    acb_add_si(u, r->z, 1, precision);
    acb_sqrt_analytic(u, u, 1, precision);
    acb_mul(r->rho, r->rho, u, precision);
    acb_clear(u);
}

/* f at the azimuth with this cosine; sin^2 = 1 - cos^2. */
static void lobe_at(acb_t out, const lobe *f, const ring *r, const acb_t cosine, slong precision)
{
    acb_t x, y2, h;
    acb_init(x);
    acb_init(y2);
    acb_init(h);
    acb_mul(x, r->rho, cosine, precision);
    acb_sqr(y2, x, precision);
    acb_sqr(h, r->rho, precision);
    acb_sub(y2, h, y2, precision);
    acb_add_arb(x, x, f->sine, precision);
    acb_sqr(x, x, precision);
    acb_mul_arb(x, x, f->ax2, precision);
    acb_addmul_arb(x, y2, f->ay2, precision);
    acb_add_arb(h, r->z, f->cosine, precision);
    if (!arb_is_positive(acb_realref(h))) {
        acb_indeterminate(out);
    } else {
        acb_sqr(h, h, precision);
        acb_div(x, x, h, precision);
        acb_neg(x, x);
        acb_exp(out, x, precision);
        acb_mul(out, out, r->root_z, precision);
        acb_mul_arb(out, out, f->factor, precision);
    }
    acb_clear(x);
    acb_clear(y2);
    acb_clear(h);
}

/* rho = 1: the segment itself. */
static void piece_of_u(acb_t s, double rho, slong i, slong n, slong precision)
{
    if (rho == 1.0) {
        bernstein_segment_piece(s, i, n, precision);
    } else {
        bernstein_ellipse_piece(s, rho, i, n, precision);
    }
}

/* Cosine of p = pi (i + [0, 1]) / n + i eta. */
static void piece_of_p(acb_t cosine, double eta, slong i, slong n, slong precision)
{
    acb_t p;
    arb_t pi;
    acb_init(p);
    arb_init(pi);
    arb_const_pi(pi, precision);
    arb_set_si(acb_realref(p), 2 * i + 1);
    arb_add_error_2exp_si(acb_realref(p), 0);
    arb_div_si(acb_realref(p), acb_realref(p), 2 * n, precision);
    arb_mul(acb_realref(p), acb_realref(p), pi, precision);
    arb_set_d(acb_imagref(p), eta);
    acb_cos(cosine, p, precision);
    acb_clear(p);
    arb_clear(pi);
}

/* Largest |B| for |cos(m p)| <= cosh(m eta) and u on a piece: C_m = rho^m cos(m p). */
static void bound_bases(mag_t out, const accuracy *a, double rho, double eta, slong precision)
{
    const slong n       = 128;
    acb_ptr     cosines = _acb_vec_init(ACCURACY_ORDER);
    acb_t       s, power;
    ring        r;
    mag_t       size;
    acb_init(s);
    acb_init(power);
    ring_init(&r);
    mag_init(size);
    mag_zero(out);
    for (slong i = 0; i < n; i++) {
        piece_of_u(s, rho, i, n, precision);
        ring_at(&r, s, precision);
        acb_one(power);
        for (slong m = 0; m < ACCURACY_ORDER; m++) {
            acb_zero(cosines + m);
            arb_set_d(acb_imagref(cosines + m), eta * (double)m);
            acb_cos(cosines + m, cosines + m, precision);
            acb_mul(cosines + m, cosines + m, power, precision);
            acb_mul(power, power, r.rho, precision);
        }
        accuracy_bound(size, a, cosines, r.z, r.root_z, precision);
        mag_max(out, out, size);
    }
    _acb_vec_clear(cosines, ACCURACY_ORDER);
    acb_clear(s);
    acb_clear(power);
    ring_clear(&r);
    mag_clear(size);
}

/* Largest |weight f| max(|f|, |z f|, largest |B|). */
static void bound_integrands(mag_t out, const accuracy *a, const lobe *f, double rho, double eta)
{
    const slong precision = 64, n = 512, segments = 256;
    acb_t       s, cosine, value;
    ring        r;
    mag_t       bases, size, weight, height;
    acb_init(s);
    acb_init(cosine);
    acb_init(value);
    ring_init(&r);
    mag_init(bases);
    mag_init(height);
    mag_init(size);
    mag_init(weight);
    mag_zero(out);
    bound_bases(bases, a, rho, eta, precision);
    for (slong j = 0; j < segments; j++) {
        piece_of_p(cosine, eta, j, segments, precision);
        for (slong i = 0; i < n; i++) {
            piece_of_u(s, rho, i, n, precision);
            ring_at(&r, s, precision);
            lobe_at(value, f, &r, cosine, precision);
            acb_get_mag(weight, r.weight);
            acb_get_mag(size, value);
            mag_mul(weight, weight, size);
            acb_get_mag(height, r.z);
            mag_mul(height, height, size);
            mag_max(size, size, height);
            mag_max(size, size, bases);
            mag_mul(size, size, weight);
            mag_max(out, out, size);
        }
    }
    acb_clear(s);
    acb_clear(cosine);
    acb_clear(value);
    ring_clear(&r);
    mag_clear(bases);
    mag_clear(height);
    mag_clear(size);
    mag_clear(weight);
}

/* u: pi / 2 (of p: 2 pi) times pi / 4 64 / 15 M rho^-2n / (1 - rho^-2), below 2^-bits. */
static slong nodes_in_u(arb_t error, const mag_t bound, double rho, slong bits)
{
    /* 2 pi pi / 4 64 / 15 < 22; 1 / (1 - rho^-2), rounded up */
    const double scale = 22.0 * (1.0 + 1e-9) / (1.0 - 1.0 / (rho * rho));
    arb_t        r, m, limit;
    slong        n = 2;
    arb_init(r);
    arb_init(m);
    arb_init(limit);
    arb_one(limit);
    arb_mul_2exp_si(limit, limit, -bits);
    mag_set(arb_radref(m), bound);
    arb_get_abs_ubound_arf(arb_midref(m), m, 64);
    mag_zero(arb_radref(m));
    arb_set_d(r, scale);
    arb_mul(m, m, r, 64);
    do {
        n += 2;
        arb_set_d(r, rho);
        arb_pow_ui(r, r, (ulong)(2 * n), 64);
        arb_div(error, m, r, 64);
    } while (!arb_lt(error, limit) && n < 4000);
    arb_clear(r);
    arb_clear(m);
    arb_clear(limit);
    return n;
}

/* pi / 2 (of u) times 4 pi M / (exp(eta N) - 1), below 2^-bits; N even. */
static slong nodes_in_p(arb_t error, const mag_t bound, double eta, slong bits)
{
    arb_t r, m, limit;
    slong n = 8;
    arb_init(r);
    arb_init(m);
    arb_init(limit);
    arb_one(limit);
    arb_mul_2exp_si(limit, limit, -bits);
    mag_set(arb_radref(m), bound);
    arb_get_abs_ubound_arf(arb_midref(m), m, 64);
    mag_zero(arb_radref(m));
    arb_mul_si(m, m, 20, 64); /* 2 pi^2 < 20 */
    do {
        n += 8;
        arb_set_d(r, eta);
        arb_mul_si(r, r, n, 64);
        arb_expm1(r, r, 64);
        arb_div(error, m, r, 64);
    } while (!arb_lt(error, limit) && n < 8000);
    arb_clear(r);
    arb_clear(m);
    arb_clear(limit);
    return n;
}

/* The trapezium rule on a ring: cosines[m] = rho^m times the integral of f cos(m p), and that of
 * f^2.  table: cos(2 pi k / N) for k < N. */
static void ring_sums(acb_ptr cosines, arb_t squares, const lobe *f, const ring *r,
                      arb_srcptr table, slong n, slong precision)
{
    acb_t value, cosine, power;
    arb_t t;
    acb_init(value);
    acb_init(cosine);
    acb_init(power);
    arb_init(t);
    _acb_vec_zero(cosines, ACCURACY_ORDER);
    arb_zero(squares);
    for (slong k = 0; k <= n / 2; k++) {
        acb_set_arb(cosine, table + k);
        lobe_at(value, f, r, cosine, precision);
        arb_sqr(t, acb_realref(value), precision);
        if (k && k < n / 2) {
            arb_mul_2exp_si(t, t, 1);
            acb_mul_2exp_si(value, value, 1);
        }
        arb_add(squares, squares, t, precision);
        for (slong m = 0; m < ACCURACY_ORDER; m++) {
            arb_addmul(acb_realref(cosines + m), acb_realref(value), table + (m * k) % n,
                       precision);
        }
    }
    arb_const_pi(t, precision);
    arb_mul_2exp_si(t, t, 1);
    arb_div_si(t, t, n, precision);
    arb_mul(squares, squares, t, precision);
    acb_set_arb(power, t);
    for (slong m = 0; m < ACCURACY_ORDER; m++) {
        acb_mul(cosines + m, cosines + m, power, precision);
        acb_mul(power, power, r->rho, precision);
    }
    acb_clear(value);
    acb_clear(cosine);
    acb_clear(power);
    arb_clear(t);
}

static void add_all(accuracy *a, const lobe *f, slong nu, slong np, slong precision)
{
    arb_ptr table   = _arb_vec_init(np);
    acb_ptr cosines = _acb_vec_init(ACCURACY_ORDER);
    arb_t   weight, squares;
    acb_t   s, w;
    ring    r;
    arb_init(weight);
    arb_init(squares);
    acb_init(s);
    acb_init(w);
    ring_init(&r);
    for (slong k = 0; k < np; k++) {
        arb_set_si(table + k, 2 * k);
        arb_div_si(table + k, table + k, np, precision);
        arb_cos_pi(table + k, table + k, precision);
    }
    for (slong i = 0; i < nu; i++) {
        arb_hypgeom_legendre_p_ui_root(acb_realref(s), weight, (ulong)nu, (ulong)i, precision);
        ring_at(&r, s, precision);
        ring_sums(cosines, squares, f, &r, table, np, precision);
        acb_mul_arb(w, r.weight, weight, precision);
        arb_const_pi(weight, precision);
        arb_mul_2exp_si(weight, weight, -2);
        acb_mul_arb(w, w, weight, precision);
        accuracy_add(a, cosines, r.z, r.root_z, w, precision);
        arb_mul(squares, squares, acb_realref(w), precision);
        accuracy_add_energy(a, squares, acb_realref(r.z), precision);
    }
    _arb_vec_clear(table, np);
    _acb_vec_clear(cosines, ACCURACY_ORDER);
    arb_clear(weight);
    arb_clear(squares);
    acb_clear(s);
    acb_clear(w);
    ring_clear(&r);
}

/* Fewest nodes over a few ellipses and strips. */
static void choose_nodes(slong *nu, slong *np, arb_t error, const accuracy *a, const lobe *f,
                         slong bits)
{
    static const double rhos[] = {1.25, 1.4, 1.6}, etas[] = {0.125, 0.25, 0.375};

    mag_t bound;
    arb_t e, least_u, least_p;
    mag_init(bound);
    arb_init(e);
    arb_init(least_u);
    arb_init(least_p);
    *nu = 4000;
    *np = 8000;
    for (int i = 0; i < 3; i++) {
        bound_integrands(bound, a, f, rhos[i], 0.0);
        slong n = mag_is_inf(bound) ? 4000 : nodes_in_u(e, bound, rhos[i], bits);
        if (n < *nu) {
            *nu = n;
            arb_set(least_u, e);
        }
        bound_integrands(bound, a, f, 1.0, etas[i]);
        n = mag_is_inf(bound) ? 8000 : nodes_in_p(e, bound, etas[i], bits);
        if (n < *np) {
            *np = n;
            arb_set(least_p, e);
        }
    }
    if (*nu == 4000 || *np == 8000) {
        ref_fail("ward: the rule does not converge");
    }
    arb_add(error, least_u, least_p, 64);
    mag_clear(bound);
    arb_clear(e);
    arb_clear(least_u);
    arb_clear(least_p);
}

static void enclose(void *user, arb_ptr out, slong count, slong precision)
{
    const task *job     = user;
    const slong working = precision + 64;
    accuracy   *a       = accuracy_create(working);
    lobe        f;
    arb_t       error;
    slong       nu, np;
    arb_init(error);
    lobe_init(&f, job->theta, working);
    choose_nodes(&nu, &np, error, a, &f, precision);
    if (getenv("REF_VERBOSE")) {
        flint_printf("%g: %wd x %wd nodes\n", job->theta, nu, np);
    }
    add_all(a, &f, nu, np, working);
    accuracy_finish(out, a, error, working);
    accuracy_destroy(a);
    lobe_clear(&f);
    arb_clear(error);
    (void)count;
}

int main(int argc, char **argv)
{
    static const slong degrees[] = {0, 30, 60};
    const ref_header   header    = {
             .name      = "accuracy_ward",
             .generator = "gen_accuracy_ward",
             .content   = "share of the energy of Ward's BRDF (alpha 0.2, 0.5; k_d 0, k_s 1) times "
                               "cos(theta_i) that a basis captures, by order [gautron06] eq. 3.32",
             .method = "Gauss rule in u (z = cos^2 u) times trapezium rule in phi, both errors proven",
             .notes = "outgoing direction (sin theta, 0, cos theta); theta: rad, the double nearest to "
                           "0, 30, 60 degrees; alpha_x, alpha_y: the doubles nearest to 0.2 and 0.5; order "
                           "n: l < n; SH of the lobe that is 0 below the horizon; ESH: sqrt(2) Y_lm, l + m "
                           "even; makhotkin_sqrt: times sqrt(cos theta)",
             .keys  = "theta order",
             .values  = ACCURACY_VALUES,
             .rows    = 3 * ACCURACY_ORDER,
             .columns = ACCURACY_COLUMNS};
    ref_table *table = ref_create(argc > 1 ? argv[1] : ".", &header);
    for (int i = 0; i < 3; i++) {
        task job = {ref_radians(degrees[i])};
        accuracy_write(table, job.theta, enclose, &job);
    }
    ref_finish(table);
    flint_cleanup();
    return 0;
}
