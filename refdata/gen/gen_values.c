/* gen_values.c - sh_values, hsh_values, zernike_values, makhotkin_values, makhotkin_sqrt_values.
 *
 * Invariant: C_m(x, y) of the doubles of the direction is exact (a dyadic number), so that a value
 * is an exact zero where symmetry makes it one.  For SH the polynomial in z and |d| is exact, too:
 * r^l Y_l^m is a homogeneous polynomial,
 *
 *     U_l = (l - m)! T_l,  U_l = (2l - 1) z U_{l-1} - (l + m - 1) (l - m - 1) r^2 U_{l-2},
 *
 * from [gautron06] eq. 3.4 - 3.6.  The other bases come from the explicit sums of bases.c; SH is
 * checked against these, and both against Arb's own spherical harmonics and Legendre functions. */
#include <acb_hypgeom.h>
#include <arb_hypgeom.h>
#include <stdio.h>
#include <stdlib.h>

#include "bases.h"
#include "directions.h"
#include "ref.h"

typedef struct {
    const double *d;
    slong         order;
    basis_kind    kind;
} task;

static void set_direction(arb_ptr d, arb_t squared, const double *doubles)
{
    arb_zero(squared);
    for (int i = 0; i < 3; i++) {
        arb_set_d(d + i, doubles[i]);
        arb_addmul(squared, d + i, d + i, ARF_PREC_EXACT);
    }
}

/* C_m of the doubles, exact. */
static void exact_azimuth(acb_ptr cosines, acb_ptr sines, slong order, arb_srcptr d)
{
    acb_t x, y;
    acb_init(x);
    acb_init(y);
    acb_set_arb(x, d);
    acb_set_arb(y, d + 1);
    basis_azimuth(cosines, sines, order, x, y, ARF_PREC_EXACT);
    acb_clear(x);
    acb_clear(y);
}

/* sqrt((2 if m) (2l + 1) / (4 pi (l - m)! (l + m)!)) / r^l */
static void solid_norm(arb_t norm, slong l, slong m, const arb_t squared, slong precision)
{
    arb_t t;
    arb_init(t);
    arb_const_pi(norm, precision);
    arb_mul_si(norm, norm, m ? 2 : 4, precision);
    arb_fac_ui(t, (ulong)(l - m), precision);
    arb_mul(norm, norm, t, precision);
    arb_fac_ui(t, (ulong)(l + m), precision);
    arb_mul(norm, norm, t, precision);
    arb_pow_ui(t, squared, (ulong)l, precision);
    arb_mul(norm, norm, t, precision);
    arb_set_si(t, 2 * l + 1);
    arb_div(norm, t, norm, precision);
    arb_sqrt(norm, norm, precision);
    arb_clear(t);
}

/* U_l, exact, in place of U_{l-2}. */
static void next_solid(arb_t u, const arb_t u1, slong l, slong m, const arb_t z,
                       const arb_t squared)
{
    arb_t t;
    arb_init(t);
    arb_mul(u, u, squared, ARF_PREC_EXACT);
    arb_mul_si(u, u, -(l + m - 1) * (l - m - 1), ARF_PREC_EXACT);
    arb_mul(t, u1, z, ARF_PREC_EXACT);
    arb_mul_si(t, t, 2 * l - 1, ARF_PREC_EXACT);
    arb_add(u, u, t, ARF_PREC_EXACT);
    arb_clear(t);
}

static void enclose_sh(void *user, arb_ptr out, slong count, slong precision)
{
    const task *job     = user;
    const slong n       = job->order;
    arb_ptr     d       = _arb_vec_init(3);
    acb_ptr     cosines = _acb_vec_init(n), sines = _acb_vec_init(n);
    arb_t       squared, norm, u[2];
    arb_init(squared);
    arb_init(norm);
    arb_init(u[0]);
    arb_init(u[1]);
    set_direction(d, squared, job->d);
    exact_azimuth(cosines, sines, n, d);
    for (slong m = 0; m < n; m++) {
        /* (-1)^m (2m - 1)!! at l = m, 0 before it */
        arb_one(u[m % 2]);
        arb_zero(u[(m + 1) % 2]);
        for (slong k = 1; k <= m; k++) {
            arb_mul_si(u[m % 2], u[m % 2], -(2 * k - 1), ARF_PREC_EXACT);
        }
        for (slong l = m; l < n; l++) {
            if (l > m) {
                next_solid(u[l % 2], u[(l + 1) % 2], l, m, d + 2, squared);
            }
            solid_norm(norm, l, m, squared, precision);
            arb_mul(norm, norm, u[l % 2], precision);
            arb_mul(out + l * l + l + m, norm, acb_realref(cosines + m), precision);
            if (m) {
                arb_mul(out + l * l + l - m, norm, acb_realref(sines + m), precision);
            }
        }
    }
    arb_clear(squared);
    arb_clear(norm);
    arb_clear(u[0]);
    arb_clear(u[1]);
    _arb_vec_clear(d, 3);
    _acb_vec_clear(cosines, n);
    _acb_vec_clear(sines, n);
    (void)count;
}

static void enclose_by_sums(void *user, arb_ptr out, slong count, slong precision)
{
    const task *job     = user;
    const slong n       = job->order;
    arb_ptr     d       = _arb_vec_init(3);
    acb_ptr     cosines = _acb_vec_init(n), sines = _acb_vec_init(n), values = _acb_vec_init(count);
    arb_t       squared;
    acb_t       r, z, root_z, power;
    arb_init(squared);
    acb_init(r);
    acb_init(z);
    acb_init(root_z);
    acb_init(power);

    set_direction(d, squared, job->d);
    exact_azimuth(cosines, sines, n, d);
    arb_sqrt(acb_realref(r), squared, precision);
    arb_div(acb_realref(z), d + 2, acb_realref(r), precision);
    if (job->kind != BASIS_SH) {
        arb_sqrt(acb_realref(root_z), acb_realref(z), precision);
    }
    acb_one(power);
    for (slong m = 0; m < n; m++) {
        acb_div(cosines + m, cosines + m, power, precision);
        acb_div(sines + m, sines + m, power, precision);
        acb_mul(power, power, r, precision);
    }
    basis *b = basis_create(job->kind, n, precision);
    basis_values(values, b, cosines, sines, z, root_z, precision);
    for (slong i = 0; i < count; i++) {
        acb_get_real(out + i, values + i);
    }
    basis_destroy(b);
    arb_clear(squared);
    acb_clear(r);
    acb_clear(z);
    acb_clear(root_z);
    acb_clear(power);
    _arb_vec_clear(d, 3);
    _acb_vec_clear(cosines, n);
    _acb_vec_clear(sines, n);
    _acb_vec_clear(values, count);
}

/* Arb's spherical harmonics: e^(i m phi) P_l^m(cos theta), Condon-Shortley sign in P. */
static void check_sh(const double *direction, slong order)
{
    const slong precision = 512, count = order * order;
    arb_ptr     a = _arb_vec_init(count), b = _arb_vec_init(count), d = _arb_vec_init(3);
    arb_t       squared, root_two;
    acb_t       theta, phi, y;
    task        job = {direction, order, BASIS_SH};
    arb_init(squared);
    arb_init(root_two);
    acb_init(theta);
    acb_init(phi);
    acb_init(y);
    enclose_sh(&job, a, count, precision);
    enclose_by_sums(&job, b, count, precision);
    set_direction(d, squared, direction);
    arb_atan2(acb_realref(phi), d + 1, d, precision);
    arb_hypot(acb_realref(theta), d, d + 1, precision);
    arb_atan2(acb_realref(theta), acb_realref(theta), d + 2, precision);
    arb_sqrt_ui(root_two, 2, precision);
    for (slong l = 0; l < order; l++) {
        for (slong m = 0; m <= l; m++) {
            acb_hypgeom_spherical_y(y, l, m, theta, phi, precision);
            if (m) {
                acb_mul_arb(y, y, root_two, precision);
                ref_check_same(a + l * l + l - m, acb_imagref(y), "SH");
            }
            ref_check_same(a + l * l + l + m, acb_realref(y), "SH");
            ref_check_same(a + l * l + l + m, b + l * l + l + m, "SH by sums");
            ref_check_same(a + l * l + l - m, b + l * l + l - m, "SH by sums");
        }
    }
    arb_clear(squared);
    arb_clear(root_two);
    acb_clear(theta);
    acb_clear(phi);
    acb_clear(y);
    _arb_vec_clear(a, count);
    _arb_vec_clear(b, count);
    _arb_vec_clear(d, 3);
}

/* sqrt(2) K~ P_l^m(2 cos theta - 1) cos(m phi) as eq. 3.18 prints it, by Arb's Legendre function.
 */
static void check_hsh(const double *direction, slong order)
{
    const slong precision = 512, count = order * order;
    arb_ptr     a = _arb_vec_init(count), d = _arb_vec_init(3);
    arb_t       squared, phi, t, norm;
    acb_t       x, degree, azimuth, p;
    task        job = {direction, order, BASIS_HSH};
    arb_init(squared);
    arb_init(phi);
    arb_init(t);
    arb_init(norm);
    acb_init(x);
    acb_init(degree);
    acb_init(azimuth);
    acb_init(p);
    enclose_by_sums(&job, a, count, precision);
    set_direction(d, squared, direction);
    arb_atan2(phi, d + 1, d, precision);
    arb_sqrt(t, squared, precision);
    arb_div(acb_realref(x), d + 2, t, precision);
    arb_mul_2exp_si(acb_realref(x), acb_realref(x), 1);
    arb_sub_si(acb_realref(x), acb_realref(x), 1, precision);
    for (slong l = 0; l < order; l++) {
        for (slong m = 0; m <= l; m++) {
            acb_set_si(degree, l);
            acb_set_si(azimuth, m);
            acb_hypgeom_legendre_p(p, degree, azimuth, x, 0, precision);
            arb_one(squared);
            solid_norm(norm, l, m, squared, precision);
            arb_fac_ui(t, (ulong)(l - m), precision); /* K~^2 = 2 (l - m)!^2 of solid_norm's */
            arb_mul(norm, norm, t, precision);
            arb_sqrt_ui(t, 2, precision);
            arb_mul(norm, norm, t, precision);
            arb_mul(norm, norm, acb_realref(p), precision);
            arb_mul_si(t, phi, m, precision);
            arb_cos(t, t, precision);
            arb_mul(t, t, norm, precision);
            ref_check_same(a + l * l + l + m, t, "HSH");
        }
    }
    arb_clear(squared);
    arb_clear(phi);
    arb_clear(t);
    arb_clear(norm);
    acb_clear(x);
    acb_clear(degree);
    acb_clear(azimuth);
    acb_clear(p);
    _arb_vec_clear(a, count);
    _arb_vec_clear(d, 3);
}

static void write_table(const char *folder, const ref_header *header, basis_kind kind, slong order,
                        const ref_direction *directions, int count)
{
    const slong columns = basis_count(kind, order);
    ref_header  full    = *header;
    ref_number *numbers = ref_allocate((size_t)columns, sizeof *numbers);
    full.generator      = "gen_values";
    full.keys           = "x y z";
    full.rows           = count;
    full.columns        = columns;
    ref_table *table    = ref_create(folder, &full);
    for (int i = 0; i < count; i++) {
        task job = {directions[i].d, order, kind};
        ref_round_all(kind == BASIS_SH ? enclose_sh : enclose_by_sums, &job, columns, 0, numbers);
        for (int k = 0; k < 3; k++) {
            ref_key(table, directions[i].d[k]);
        }
        for (slong k = 0; k < columns; k++) {
            ref_value(table, numbers + k);
        }
        ref_end_row(table);
    }
    ref_finish(table);
    free(numbers);
}

#define AT_DIRECTION "value is the function at d / |d|, d = (x, y, z); frame right-handed, pole +z"
#define THESIS "thesis signs ((-1)^m of eq. 3.5 kept); " AT_DIRECTION
#define OTHER "no (-1)^m; m >= 0: cos(m phi), m < 0: sin(|m| phi); " AT_DIRECTION
#define SUMS "explicit Jacobi sums at exact C_m(x, y); checked against Arb's functions"

static const ref_header sh_header = {
    .name    = "sh_values",
    .content = "real spherical harmonics, l <= 32 [gautron06] eq. 3.7",
    .method  = "homogeneous polynomials, exact but for norm and |d|; checked in two other ways",
    .notes   = THESIS,
    .values  = "column l*l + l + m"};
static const ref_header hsh_header     = {.name = "hsh_values",
                                          .content =
                                              "hemispherical harmonics, l <= 32 [gautron06] eq. 3.18",
                                          .method = SUMS,
                                          .notes  = THESIS,
                                          .values = "column l*l + l + m"};
static const ref_header zernike_header = {
    .name    = "zernike_values",
    .content = "hemispherical Zernike functions, degree l <= 16 [koenderink96]",
    .method  = SUMS,
    .notes   = OTHER,
    .values  = "column l(l+1)/2 + (l+m)/2, l - |m| even"};
static const ref_header makhotkin_header = {
    .name    = "makhotkin_values",
    .content = "Makhotkin's functions, orthonormal under cos(theta) dw, l <= 16 [makhotkin96]",
    .method  = SUMS,
    .notes   = OTHER,
    .values  = "column l*l + l + m"};
static const ref_header makhotkin_sqrt_header = {
    .name    = "makhotkin_sqrt_values",
    .content = "Makhotkin's functions times sqrt(cos(theta)), orthonormal under dw, l <= 16",
    .method  = SUMS,
    .notes   = OTHER,
    .values  = "column l*l + l + m"};

int main(int argc, char **argv)
{
    const char    *folder = argc > 1 ? argv[1] : ".";
    int            count, upper, few_count;
    ref_direction *all = ref_directions(&count, &upper);
    ref_direction *few = ref_few_directions(&few_count);

    for (int i = upper - 1; i < count; i += 4) {
        check_sh(all[i].d, 12);
    }
    check_hsh(all[upper - 1].d, 33);
    check_hsh(all[upper - 2].d, 12);
    write_table(folder, &sh_header, BASIS_SH, 33, all, count);
    write_table(folder, &hsh_header, BASIS_HSH, 33, all, upper);
    write_table(folder, &zernike_header, BASIS_ZERNIKE, 17, few, few_count);
    write_table(folder, &makhotkin_header, BASIS_MAKHOTKIN, 17, few, few_count);
    write_table(folder, &makhotkin_sqrt_header, BASIS_MAKHOTKIN_SQRT, 17, few, few_count);
    free(all);
    free(few);
    flint_cleanup();
    return 0;
}
