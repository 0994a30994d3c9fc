/* gen_conversion.c - conversion, conversion_bands: the matrix C of [gautron06] eq. 3.20.
 *
 * Invariant: every entry is a closed form with exact rational coefficients, so that zeros are
 * known.  With z = cos(theta), after the integral over phi,
 *
 *     C = N integral_0^1 2^m (1 - z)^m (z (1 + z))^(m/2) P_l^(m)(2z - 1) P_l'^(m)(z) dz
 *     N^2 = (2l + 1) (2l' + 1) (l - m)! (l' - m)! / (2 (l + m)! (l' + m)!)
 *
 * with derivatives P^(m) of Legendre polynomials.  For even m this is a polynomial with rational
 * coefficients.  For odd m let J_k = integral_0^1 z^k sqrt(z^2 + z) dz.  From the derivative of
 * z^(k-1) (z^2 + z)^(3/2),
 *
 *     (k + 2) J_k = 2 sqrt(2) - (k + 1/2) J_{k-1},   J_0 = 3 sqrt(2) / 4 - log(3 + 2 sqrt(2)) / 8,
 *
 * so an entry is a J_0 + b 2 sqrt(2), a and b rational; it is zero only if both are, for
 * log(3 + 2 sqrt(2)) is transcendental. */
#include <arb_fmpz_poly.h>
#include <arb_hypgeom.h>
#include <flint/fmpq_poly.h>
#include <stdlib.h>

#include "ref.h"

typedef struct {
    slong row_l, column_l, m;
} entry;

/* d^m/dX^m P_l at X = 2z - 1 (shifted) or z. */
static void legendre_derivative(fmpq_poly_t p, slong l, slong m, int shifted)
{
    fmpq_poly_legendre_p(p, (ulong)l);
    for (slong i = 0; i < m; i++) {
        fmpq_poly_derivative(p, p);
    }
    if (shifted) {
        fmpq_poly_t argument;
        fmpq_poly_init(argument);
        fmpq_poly_set_coeff_si(argument, 0, -1);
        fmpq_poly_set_coeff_si(argument, 1, 2);
        fmpq_poly_compose(p, p, argument);
        fmpq_poly_clear(argument);
    }
}

/* The integrand but for N, and for sqrt(z^2 + z) where m is odd. */
static void integrand(fmpq_poly_t p, const entry *e)
{
    fmpq_poly_t q;
    fmpq_poly_init(q);
    legendre_derivative(p, e->row_l, e->m, 1);
    legendre_derivative(q, e->column_l, e->m, 0);
    fmpq_poly_mul(p, p, q);
    fmpq_poly_zero(q);
    fmpq_poly_set_coeff_si(q, 0, 2);
    fmpq_poly_set_coeff_si(q, 1, -2);
    fmpq_poly_pow(q, q, (ulong)e->m);
    fmpq_poly_mul(p, p, q);
    fmpq_poly_zero(q);
    fmpq_poly_set_coeff_si(q, 1, 1);
    fmpq_poly_set_coeff_si(q, 2, 1);
    fmpq_poly_pow(q, q, (ulong)(e->m / 2));
    fmpq_poly_mul(p, p, q);
    fmpq_poly_clear(q);
}

static void even_integral(fmpq_t out, const fmpq_poly_t p)
{
    fmpq_poly_t sum;
    fmpq_poly_init(sum);
    fmpq_poly_integral(sum, p);
    fmpq_one(out);
    fmpq_poly_evaluate_fmpq(out, sum, out);
    fmpq_poly_clear(sum);
}

/* p integrated against sqrt(z^2 + z) is a J_0 + b 2 sqrt(2). */
static void odd_integral(fmpq_t a, fmpq_t b, const fmpq_poly_t p)
{
    fmpq_t ja, jb, t; /* of J_k */
    fmpq_init(ja);
    fmpq_init(jb);
    fmpq_init(t);
    fmpq_one(ja);
    fmpq_zero(a);
    fmpq_zero(b);
    for (slong k = 0; k < fmpq_poly_length(p); k++) {
        if (k) {
            fmpq_set_si(t, -(2 * k + 1), (ulong)(2 * k + 4));
            fmpq_mul(ja, ja, t);
            fmpq_mul(jb, jb, t);
            fmpq_set_si(t, 1, (ulong)(k + 2));
            fmpq_add(jb, jb, t);
        }
        fmpq_poly_get_coeff_fmpq(t, p, k);
        fmpq_addmul(a, t, ja);
        fmpq_addmul(b, t, jb);
    }
    fmpq_clear(ja);
    fmpq_clear(jb);
    fmpq_clear(t);
}

static void norm_squared(fmpq_t out, const entry *e)
{
    fmpz_t n, d, f;
    fmpz_init(n);
    fmpz_init(d);
    fmpz_init(f);
    fmpz_set_si(n, (2 * e->row_l + 1) * (2 * e->column_l + 1));
    fmpz_set_si(d, 2);
    fmpz_fac_ui(f, (ulong)(e->row_l - e->m));
    fmpz_mul(n, n, f);
    fmpz_fac_ui(f, (ulong)(e->column_l - e->m));
    fmpz_mul(n, n, f);
    fmpz_fac_ui(f, (ulong)(e->row_l + e->m));
    fmpz_mul(d, d, f);
    fmpz_fac_ui(f, (ulong)(e->column_l + e->m));
    fmpz_mul(d, d, f);
    fmpq_set_fmpz_frac(out, n, d);
    fmpz_clear(n);
    fmpz_clear(d);
    fmpz_clear(f);
}

/* r sqrt(q), exact where that is a dyadic number. */
static void times_root(arb_t out, const fmpq_t r, const fmpq_t q, slong precision)
{
    fmpq_t square;
    fmpq_init(square);
    fmpq_mul(square, r, r);
    fmpq_mul(square, square, q);
    if (fmpz_is_square(fmpq_numref(square)) && fmpz_is_square(fmpq_denref(square))) {
        fmpz_sqrt(fmpq_numref(square), fmpq_numref(square));
        fmpz_sqrt(fmpq_denref(square), fmpq_denref(square));
        arb_set_fmpq(out, square, precision);
    } else {
        arb_set_fmpq(out, square, precision);
        arb_sqrt(out, out, precision);
    }
    if (fmpq_sgn(r) < 0) {
        arb_neg(out, out);
    }
    fmpq_clear(square);
}

static void enclose_entry(void *user, arb_ptr out, slong count, slong precision)
{
    const entry *e = user;
    fmpq_poly_t  p;
    fmpq_t       a, b, q;
    fmpq_poly_init(p);
    fmpq_init(a);
    fmpq_init(b);
    fmpq_init(q);
    integrand(p, e);
    norm_squared(q, e);
    if (e->m % 2 == 0) {
        even_integral(a, p);
        times_root(out, a, q, precision);
    } else {
        odd_integral(a, b, p);
        arb_t root, j, t;
        arb_init(root);
        arb_init(j);
        arb_init(t);
        arb_sqrt_ui(root, 8, precision);
        arb_add_si(j, root, 3, precision);
        arb_log(j, j, precision);
        arb_mul_2exp_si(j, j, -3);
        arb_mul_si(t, root, 3, precision);
        arb_mul_2exp_si(t, t, -3);
        arb_sub(j, t, j, precision); /* J_0 */
        arb_set_fmpq(t, a, precision);
        arb_mul(j, j, t, precision);
        arb_set_fmpq(t, b, precision);
        arb_addmul(j, root, t, precision);
        arb_set_fmpq(t, q, precision);
        arb_sqrt(t, t, precision);
        arb_mul(out, j, t, precision);
        arb_clear(root);
        arb_clear(j);
        arb_clear(t);
    }
    fmpq_poly_clear(p);
    fmpq_clear(a);
    fmpq_clear(b);
    fmpq_clear(q);
    (void)count;
}

/* The same by Gauss's rule in t, z = t^2: an approximation within 1e-30 for small bands. */
static void check_by_quadrature(const entry *e)
{
    const slong precision = 256, nodes = 120;
    fmpq_poly_t p;
    fmpq_t      q;
    arb_t       sum, node, weight, value, t;
    fmpq_poly_init(p);
    fmpq_init(q);
    arb_init(sum);
    arb_init(node);
    arb_init(weight);
    arb_init(value);
    arb_init(t);
    integrand(p, e);
    norm_squared(q, e);
    for (slong i = 0; i < nodes; i++) {
        arb_hypgeom_legendre_p_ui_root(node, weight, (ulong)nodes, (ulong)i, precision);
        arb_add_si(node, node, 1, precision);
        arb_mul_2exp_si(node, node, -1);
        arb_mul(weight, weight, node, precision); /* dz = 2 t dt, dt = half of the weight */
        arb_sqr(node, node, precision);
        arb_fmpz_poly_evaluate_arb(value, (fmpz_poly_struct *)p, node, precision);
        arb_div_fmpz(value, value, fmpq_poly_denref(p), precision);
        if (e->m % 2) {
            arb_add_si(t, node, 1, precision);
            arb_mul(t, t, node, precision);
            arb_sqrt(t, t, precision);
            arb_mul(value, value, t, precision);
        }
        arb_addmul(sum, value, weight, precision);
    }
    arb_set_fmpq(t, q, precision);
    arb_sqrt(t, t, precision);
    arb_mul(sum, sum, t, precision);
    arb_add_error_2exp_si(sum, -100);
    enclose_entry((void *)e, value, 1, precision);
    ref_check_same(sum, value, "C");
    fmpq_poly_clear(p);
    fmpq_clear(q);
    arb_clear(sum);
    arb_clear(node);
    arb_clear(weight);
    arb_clear(value);
    arb_clear(t);
}

static void write_entry(ref_table *table, const entry *e, slong sign)
{
    ref_number number;
    entry      copy = *e;
    ref_round_all(enclose_entry, &copy, 1, 1, &number);
    ref_key(table, (double)(sign * e->m));
    ref_key(table, (double)e->row_l);
    ref_key(table, (double)e->column_l);
    ref_value(table, &number);
    ref_low(table, &number);
    ref_end_row(table);
}

static const ref_header conversion_header = {
    .name      = "conversion",
    .generator = "gen_conversion",
    .content   = "conversion matrix C, HSH rows l < 10, SH columns l' < 16 [gautron06] eq. 3.20",
    .method    = "closed form with exact rational coefficients; checked by quadrature",
    .notes   = "thesis signs; hsh = C sh, sh = C^T hsh; entries with another m are 0 and left out; "
               "the sum of both values is the number to about 107 bits",
    .keys    = "m l l'",
    .values  = "nearest double; double nearest to the rest",
    .columns = 2};

static void write_conversion(const char *folder)
{
    ref_header header = conversion_header;
    for (slong m = -9; m <= 9; m++) {
        header.rows += (10 - labs(m)) * (16 - labs(m));
    }
    ref_table *table = ref_create(folder, &header);
    for (slong m = -9; m <= 9; m++) {
        for (slong l = labs(m); l < 10; l++) {
            for (slong k = labs(m); k < 16; k++) {
                write_entry(table, &(entry){l, k, labs(m)}, m < 0 ? -1 : 1);
            }
        }
    }
    ref_finish(table);
}

static void write_bands(const char *folder)
{
    static const slong chosen[] = {0, 1, 2, 16, 31, 32};
    ref_header         header   = conversion_header;
    header.name                 = "conversion_bands";
    header.content = "conversion matrix C, HSH rows l <= 32, SH columns l' <= 32, six values of m";
    for (int i = 0; i < 6; i++) {
        header.rows += (33 - chosen[i]) * (33 - chosen[i]);
    }
    ref_table *table = ref_create(folder, &header);
    for (int i = 0; i < 6; i++) {
        for (slong l = chosen[i]; l < 33; l++) {
            for (slong k = chosen[i]; k < 33; k++) {
                write_entry(table, &(entry){l, k, chosen[i]}, 1);
            }
        }
    }
    ref_finish(table);
}

int main(int argc, char **argv)
{
    const char *folder = argc > 1 ? argv[1] : ".";
    check_by_quadrature(&(entry){0, 1, 0});
    check_by_quadrature(&(entry){7, 12, 0});
    check_by_quadrature(&(entry){1, 1, 1});
    check_by_quadrature(&(entry){9, 13, 3});
    check_by_quadrature(&(entry){8, 10, 4});
    check_by_quadrature(&(entry){20, 25, 17});
    write_conversion(folder);
    write_bands(folder);
    flint_cleanup();
    return 0;
}
