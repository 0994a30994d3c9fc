/* gen_student.c - student_tail.
 *
 * Invariant: P(|T| >= t) = I_x(nu / 2, 1 / 2), x = nu / (nu + t^2), by Arb's incomplete beta
 * function; with one and two degrees checked against the closed forms 2 atan(1 / t) / pi and
 * 1 - t / sqrt(2 + t^2). */
#include <arb_hypgeom.h>

#include "ref.h"

typedef struct {
    double t, degrees; /* degrees 0: the normal distribution */
} task;

static void beta_tail(arb_t p, const task *job, slong precision)
{
    arb_t a, b, x, y;
    arb_init(a);
    arb_init(b);
    arb_init(x);
    arb_init(y);
    arb_set_d(y, job->t);
    arb_sqr(y, y, precision);
    arb_set_d(a, job->degrees);
    arb_add(x, y, a, precision);
    arb_div(x, a, x, precision);
    arb_mul_2exp_si(a, a, -1);
    arb_set_d(b, 0.5);
    arb_hypgeom_beta_lower(p, a, b, x, 1, precision);
    arb_clear(a);
    arb_clear(b);
    arb_clear(x);
    arb_clear(y);
}

static void normal_tail(arb_t p, double t, slong precision)
{
    arb_t x;
    arb_init(x);
    arb_set_d(x, 0.5);
    arb_sqrt(x, x, precision);
    arb_set_d(p, t);
    arb_mul(x, x, p, precision);
    arb_hypgeom_erfc(p, x, precision);
    arb_clear(x);
}

static void check_closed_form(const arb_t p, const task *job, slong precision)
{
    arb_t t, q;
    arb_init(t);
    arb_init(q);
    arb_set_d(t, job->t);
    if (job->degrees == 1.0) {
        arb_inv(t, t, precision);
        arb_atan(q, t, precision);
        arb_mul_2exp_si(q, q, 1);
        arb_const_pi(t, precision);
        arb_div(q, q, t, precision);
        ref_check_same(p, q, "tail with one degree");
    } else if (job->degrees == 2.0) {
        arb_sqr(q, t, precision);
        arb_add_ui(q, q, 2, precision);
        arb_sqrt(q, q, precision);
        arb_div(q, t, q, precision);
        arb_sub_ui(q, q, 1, precision);
        arb_neg(q, q);
        ref_check_same(p, q, "tail with two degrees");
    }
    arb_clear(t);
    arb_clear(q);
}

static void enclose(void *user, arb_ptr out, slong count, slong precision)
{
    const task *job = user;
    if (job->degrees > 0.0) {
        beta_tail(out, job, precision);
        check_closed_form(out, job, precision);
    } else {
        normal_tail(out, job->t, precision);
    }
    arb_log(out, out, precision);
    (void)count;
}

int main(int argc, char **argv)
{
    static const double degrees[] = {0.0, 0.5,    1.0,    2.0, 3.0, 4.7,
                                     15., 63.125, 1023.5, 4e4, 1e6, 3e9};
    static const double t[]       = {1e-9, 0.001, 0.3, 1.0, 1.7,  1.75, 2.5,
                                     4.0,  6.5,   10., 38., 300., 1e5};
    enum { DEGREES = sizeof degrees / sizeof degrees[0], T = sizeof t / sizeof t[0] };
    const ref_header header = {.name      = "student_tail",
                               .generator = "gen_student",
                               .content =
                                   "log of P(|T| >= t), Student's t with any degrees of freedom",
                               .method  = "Arb's regularised incomplete beta function, and erfc",
                               .notes   = "degrees 0 stands for the normal distribution",
                               .keys    = "degrees t",
                               .values  = "natural logarithm",
                               .rows    = DEGREES * T,
                               .columns = 1};
    ref_table       *table  = ref_create(argc > 1 ? argv[1] : ".", &header);
    for (int i = 0; i < DEGREES; i++) {
        for (int j = 0; j < T; j++) {
            task       job = {t[j], degrees[i]};
            ref_number number;
            ref_round_all(enclose, &job, 1, 0, &number);
            ref_key(table, degrees[i]);
            ref_key(table, t[j]);
            ref_value(table, &number);
            ref_end_row(table);
        }
    }
    ref_finish(table);
    flint_cleanup();
    return 0;
}
