/* gen_quadrature.c - clamped_cosine, gauss_legendre.
 *
 * Invariant: A_l is an exact rational multiple of pi, its zeros known.  A_l = 2 pi times the
 * integral over [0, 1] of z P_l(z), computed from the polynomial itself; checked against the closed
 * form of its even members.  Nodes and weights come from Arb's enclosures, exact where the node is
 * 0 or the weight 1. */
#include <arb_hypgeom.h>
#include <flint/fmpq_poly.h>
#include <stdlib.h>

#include "ref.h"

typedef struct {
    slong n, i;
} task;

static void cosine_rational(fmpq_t q, slong l)
{
    fmpq_poly_t p;
    fmpq_poly_init(p);
    fmpq_poly_legendre_p(p, (ulong)l);
    fmpq_poly_shift_left(p, p, 1);
    fmpq_poly_integral(p, p);
    fmpq_one(q);
    fmpq_poly_evaluate_fmpq(q, p, q);
    fmpq_add(q, q, q);
    fmpq_poly_clear(p);
}

static void enclose_cosine(void *user, arb_ptr out, slong count, slong precision)
{
    const task *job = user;
    fmpq_t      q;
    arb_t       pi;
    fmpq_init(q);
    arb_init(pi);
    cosine_rational(q, job->n);
    arb_const_pi(pi, precision);
    arb_mul_fmpz(out, pi, fmpq_numref(q), precision);
    arb_div_fmpz(out, out, fmpq_denref(q), precision);
    fmpq_clear(q);
    arb_clear(pi);
    (void)count;
}

/* 2 (-1)^(l/2-1) / ((l + 2) (l - 1)) l! / (2^l (l/2)!^2), l even */
static void check_cosine(slong l)
{
    fmpq_t q, expected;
    fmpz_t f, g;
    fmpq_init(q);
    fmpq_init(expected);
    fmpz_init(f);
    fmpz_init(g);
    cosine_rational(q, l);
    fmpz_fac_ui(f, (ulong)l);
    fmpz_fac_ui(g, (ulong)(l / 2));
    fmpz_mul(g, g, g);
    fmpz_mul_2exp(g, g, (ulong)l);
    fmpz_mul_si(g, g, (l + 2) * (l - 1));
    fmpz_mul_si(f, f, l % 4 == 2 ? 2 : -2);
    fmpq_set_fmpz_frac(expected, f, g);
    if (!fmpq_equal(q, expected)) {
        ref_fail("A_%ld has two values", (long)l);
    }
    fmpq_clear(q);
    fmpq_clear(expected);
    fmpz_clear(f);
    fmpz_clear(g);
}

/* Node i, growing; Arb's run the other way. */
static void enclose_node(void *user, arb_ptr out, slong count, slong precision)
{
    const task *job = user;
    arb_hypgeom_legendre_p_ui_root(out, out + 1, (ulong)job->n, (ulong)(job->n - 1 - job->i),
                                   precision);
    if (job->n == 2) {
        arb_one(out + 1);
    }
    (void)count;
}

static void write_cosine(const char *folder)
{
    const ref_header header = {
        .name      = "clamped_cosine",
        .generator = "gen_quadrature",
        .content   = "A_l of the clamped cosine: irradiance = sum of A_l c_lm Y_lm(n) [kontkanen]",
        .method    = "2 pi integral of z P_l(z), exact rational multiple of pi",
        .notes     = "A_0 = pi; the sum of both values is the number to about 107 bits",
        .keys      = "l",
        .values    = "nearest double; double nearest to the rest",
        .rows      = 33,
        .columns   = 2};
    ref_table *table = ref_create(folder, &header);
    for (slong l = 0; l < 33; l++) {
        task       job = {l, 0};
        ref_number number;
        if (l % 2 == 0 && l) {
            check_cosine(l);
        }
        ref_round_all(enclose_cosine, &job, 1, 1, &number);
        ref_key(table, (double)l);
        ref_value(table, &number);
        ref_low(table, &number);
        ref_end_row(table);
    }
    ref_finish(table);
}

static void write_gauss(const char *folder)
{
    static const slong sizes[] = {2, 3, 5, 16, 64};
    const ref_header   header  = {.name      = "gauss_legendre",
                                  .generator = "gen_quadrature",
                                  .content = "nodes and weights of Gauss-Legendre rules on [-1, 1]",
                                  .method  = "Arb's enclosures of the roots of P_n",
                                  .notes = "nodes growing; high + low is the number to about 107 bits",
                                  .keys    = "n i",
                                  .values  = "node high, low; weight high, low",
                                  .rows    = 2 + 3 + 5 + 16 + 64,
                                  .columns = 4};
    ref_table         *table   = ref_create(folder, &header);
    for (int k = 0; k < 5; k++) {
        for (slong i = 0; i < sizes[k]; i++) {
            task       job = {sizes[k], i};
            ref_number numbers[2];
            ref_round_all(enclose_node, &job, 2, 1, numbers);
            ref_key(table, (double)job.n);
            ref_key(table, (double)i);
            for (int j = 0; j < 2; j++) {
                ref_value(table, numbers + j);
                ref_low(table, numbers + j);
            }
            ref_end_row(table);
        }
    }
    ref_finish(table);
}

int main(int argc, char **argv)
{
    const char *folder = argc > 1 ? argv[1] : ".";
    write_cosine(folder);
    write_gauss(folder);
    flint_cleanup();
    return 0;
}
