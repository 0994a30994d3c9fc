/* gen_digon.c - digon_order6, digon_order10, hsh_rotation_order6, hsh_rotation_order10.
 *
 *     M_ij   = integral over H - I of H_i(w) H_j(w)     [gautron06] eq. 3.27
 *     M_R,ij = integral over H - I of H_i(w) H_j(R w)   eq. 3.31
 *
 * Invariant: every sum is widened by the proven error of lune.c.  Both domains and integrands are
 * symmetric in y, so that entries between a cosine and a sine are zero. */
#include <stdlib.h>

#include "bases.h"
#include "lune.h"
#include "ref.h"

typedef struct {
    slong   order, count;
    basis  *b;
    acb_ptr cosines, sines, first, second;
    arb_ptr m, turned; /* count * count sums */
} sums;

typedef struct {
    double beta;
    slong  order;
} task;

static void values_of(sums *s, acb_ptr out, const acb_t x, const acb_t y, const acb_t z,
                      const acb_t root_z, slong precision)
{
    basis_azimuth(s->cosines, s->sines, s->order, x, y, precision);
    basis_values(out, s->b, s->cosines, s->sines, z, root_z, precision);
}

static int is_sine(slong i)
{
    slong l = 0;
    while ((l + 1) * (l + 1) <= i) {
        l++;
    }
    return i < l * l + l;
}

static void add_products(void *user, const lune_point *p, slong precision)
{
    sums *s = user;
    arb_t t;
    arb_init(t);
    values_of(s, s->first, p->x, p->y, p->z, p->root_z, precision);
    values_of(s, s->second, p->x2, p->y, p->z2, p->root_z2, precision);
    for (slong i = 0; i < s->count; i++) {
        arb_mul(t, acb_realref(s->first + i), acb_realref(p->weight), precision);
        for (slong j = 0; j < s->count; j++) {
            if (is_sine(i) == is_sine(j)) {
                arb_addmul(s->turned + i * s->count + j, t, acb_realref(s->second + j), precision);
                if (j <= i) {
                    arb_addmul(s->m + i * s->count + j, t, acb_realref(s->first + j), precision);
                }
            }
        }
    }
    arb_clear(t);
}

static void largest(mag_t out, acb_srcptr values, slong count)
{
    mag_t size;
    mag_init(size);
    mag_zero(out);
    for (slong i = 0; i < count; i++) {
        acb_get_mag(size, values + i);
        mag_max(out, out, size);
    }
    mag_clear(size);
}

static void bound_products(void *user, arb_t out, const lune_point *p, slong precision)
{
    sums *s = user;
    mag_t a, b;
    mag_init(a);
    mag_init(b);
    values_of(s, s->first, p->x, p->y, p->z, p->root_z, precision);
    values_of(s, s->second, p->x2, p->y, p->z2, p->root_z2, precision);
    largest(a, s->first, s->count);
    largest(b, s->second, s->count);
    mag_max(b, a, b);
    arb_zero(out);
    mag_mul(arb_radref(out), a, b);
    mag_clear(a);
    mag_clear(b);
}

/* out: M, then the matrix that acts as out = T in, T = M_R transposed. */
static void enclose_matrices(void *user, arb_ptr out, slong count, slong precision)
{
    const task *job = user;
    const slong n   = basis_count(BASIS_HSH, job->order);
    sums        s   = {.order = job->order, .count = n};
    arb_t       beta, error;
    arb_init(beta);
    arb_init(error);
    s.b       = basis_create(BASIS_HSH, job->order, precision + 64);
    s.cosines = _acb_vec_init(job->order);
    s.sines   = _acb_vec_init(job->order);
    s.first   = _acb_vec_init(n);
    s.second  = _acb_vec_init(n);
    s.m       = _arb_vec_init(n * n);
    s.turned  = _arb_vec_init(n * n);
    arb_set_d(beta, job->beta);
    const lune_integrand f = {add_products, bound_products, &s};
    lune_integrate(error, &f, beta, precision);
    for (slong i = 0; i < n; i++) {
        for (slong j = 0; j < n; j++) {
            arb_zero(out + i * n + j);
            arb_zero(out + (n + i) * n + j);
            if (is_sine(i) == is_sine(j)) {
                arb_set(out + i * n + j, s.m + (i > j ? i * n + j : j * n + i));
                arb_set(out + (n + i) * n + j, s.turned + j * n + i);
                arb_add_error(out + i * n + j, error);
                arb_add_error(out + (n + i) * n + j, error);
            }
        }
    }
    basis_destroy(s.b);
    arb_clear(beta);
    arb_clear(error);
    _acb_vec_clear(s.cosines, job->order);
    _acb_vec_clear(s.sines, job->order);
    _acb_vec_clear(s.first, n);
    _acb_vec_clear(s.second, n);
    _arb_vec_clear(s.m, n * n);
    _arb_vec_clear(s.turned, n * n);
    (void)count;
}

/* M[0][0] = M_R[0][0] = 1 - |beta| / pi. */
static void check_first(double beta)
{
    arb_ptr matrices = _arb_vec_init(2);
    arb_t   expected, t;
    task    job = {beta, 1};
    arb_init(expected);
    arb_init(t);
    enclose_matrices(&job, matrices, 2, 128);
    arb_const_pi(t, 256);
    arb_set_d(expected, beta < 0 ? -beta : beta);
    arb_div(expected, expected, t, 256);
    arb_sub_si(expected, expected, 1, 256);
    arb_neg(expected, expected);
    ref_check_same(matrices, expected, "M[0][0]");
    ref_check_same(matrices + 1, expected, "M_R[0][0]");
    arb_clear(expected);
    arb_clear(t);
    _arb_vec_clear(matrices, 2);
}

static ref_table *open_table(const char *folder, int turned, slong order, slong angles)
{
    ref_header header = {.generator = "gen_digon"};
    if (turned) {
        header.name    = order == 6 ? "hsh_rotation_order6" : "hsh_rotation_order10";
        header.content = "rotation of HSH about +y, what leaves the hemisphere lost, "
                         "T = M_R^T [gautron06] eq. 3.31";
        header.notes = "thesis signs; out = T in, rows are outputs: T[j][i] = integral over z > 0, "
                       "(R w)_z > 0 of H_i(w) H_j(R w); beta > 0 moves the pole to +x; "
                       "index l*l + l + m";
    } else {
        header.name    = order == 6 ? "digon_order6" : "digon_order10";
        header.content = "digon deletion of HSH, M [gautron06] eq. 3.27";
        header.notes   = "thesis signs; M[i][j] = integral over z > 0, (R w)_z > 0 of "
                         "H_i(w) H_j(w), symmetric; R about +y, beta > 0 moves the pole to +x; "
                         "index l*l + l + m";
    }
    header.method  = "Gauss product rule, error proven on Bernstein ellipses (lune.c)";
    header.keys    = "beta row";
    header.values  = "column of the matrix; beta: rad, the double nearest to a whole number of "
                     "degrees";
    header.rows    = angles * order * order;
    header.columns = order * order;
    return ref_create(folder, &header);
}

static void write_matrix(ref_table *table, double beta, const ref_number *matrix, slong n)
{
    for (slong i = 0; i < n; i++) {
        ref_key(table, beta);
        ref_key(table, (double)i);
        for (slong j = 0; j < n; j++) {
            ref_value(table, matrix + i * n + j);
        }
        ref_end_row(table);
    }
}

static void write_tables(const char *folder, slong order, const slong *degrees, slong angles)
{
    const slong n       = order * order;
    ref_number *numbers = ref_allocate((size_t)(2 * n * n), sizeof *numbers);
    ref_table  *digon   = open_table(folder, 0, order, angles);
    ref_table  *turned  = open_table(folder, 1, order, angles);
    for (slong k = 0; k < angles; k++) {
        task job = {ref_radians(degrees[k]), order};
        ref_round_all(enclose_matrices, &job, 2 * n * n, 0, numbers);
        write_matrix(digon, job.beta, numbers, n);
        write_matrix(turned, job.beta, numbers + n * n, n);
    }
    ref_finish(digon);
    ref_finish(turned);
    free(numbers);
}

int main(int argc, char **argv)
{
    static const slong small[] = {10, 30, 45, 60, 90, -30, 1, 120}, large[] = {30, 1, 60, 120};

    const char *folder = argc > 1 ? argv[1] : ".";
    check_first(0.25);
    check_first(-2.0);
    write_tables(folder, 6, small, 8);
    write_tables(folder, 10, large, 4);
    flint_cleanup();
    return 0;
}
