/* gen_sh_rotation.c - sh_rotation_01 ... sh_rotation_32: blocks of D for whole rotations.
 *
 * Invariant: D acts as out = D in, R = Rz(alpha) Ry(beta) Rz(gamma) active, and
 * Y_j(R^-1 w) = sum_i D_ij Y_i(w).  With Wigner's sum
 *
 *     d_m'm = sum_s (-1)^(m'-m+s) sqrt((l+m')! (l-m')! (l+m)! (l-m)!)
 *             / ((l+m-s)! s! (m'-m+s)! (l-m'-s)!) cos(b/2)^(2l+m-m'-2s) sin(b/2)^(m'-m+2s)
 *
 * for complex functions, real ones (sqrt(2) Re, sqrt(2) Im for m > 0) turn about y by
 * d_m'm +- (-1)^m' d_-m'm, and about z in closed form.  Each block is checked against its
 * definition at a direction. */
#include <acb.h>
#include <flint/fmpz.h>
#include <stdio.h>
#include <stdlib.h>

#include "bases.h"
#include "ref.h"

typedef struct {
    double euler[3];
    slong  l;
} task;

static void factorial_product(fmpz_t out, slong a, slong b, slong c, slong d)
{
    const slong all[] = {a, b, c, d};
    fmpz_t      f;
    fmpz_init(f);
    fmpz_one(out);
    for (int i = 0; i < 4; i++) {
        fmpz_fac_ui(f, (ulong)all[i]);
        fmpz_mul(out, out, f);
    }
    fmpz_clear(f);
}

/* Powers of cos(b/2) and sin(b/2): 2l + 1 each. */
static void small_d(arb_t out, slong l, slong row, slong column, arb_srcptr cosines,
                    arb_srcptr sines, slong precision)
{
    fmpz_t root, divisor;
    arb_t  term;
    fmpz_init(root);
    fmpz_init(divisor);
    arb_init(term);
    arb_zero(out);
    factorial_product(root, l + row, l - row, l + column, l - column);
    for (slong s = 0; s <= 2 * l; s++) {
        if (l + column - s < 0 || row - column + s < 0 || l - row - s < 0) {
            continue;
        }
        factorial_product(divisor, l + column - s, s, row - column + s, l - row - s);
        arb_mul(term, cosines + 2 * l + column - row - 2 * s, sines + row - column + 2 * s,
                precision);
        arb_div_fmpz(term, term, divisor, precision);
        if ((row - column + s) & 1) {
            arb_neg(term, term);
        }
        arb_add(out, out, term, precision);
    }
    arb_sqrt_fmpz(term, root, precision);
    arb_mul(out, out, term, precision);
    fmpz_clear(root);
    fmpz_clear(divisor);
    arb_clear(term);
}

/* Block of the turn about y for real functions: (l + m', l + m), 2l + 1 columns. */
static void turn_y(arb_ptr block, slong l, double beta, slong precision)
{
    const slong n       = 2 * l + 1;
    arb_ptr     cosines = _arb_vec_init(n), sines = _arb_vec_init(n);
    arb_t       half, c, s, a, b;
    arb_init(half);
    arb_init(c);
    arb_init(s);
    arb_init(a);
    arb_init(b);
    arb_set_d(half, beta);
    arb_mul_2exp_si(half, half, -1);
    arb_sin_cos(s, c, half, precision);
    _arb_vec_set_powers(cosines, c, n, precision);
    _arb_vec_set_powers(sines, s, n, precision);
    for (slong m = 0; m <= l; m++) {
        for (slong k = 0; k <= l; k++) {
            small_d(a, l, k, m, cosines, sines, precision);
            small_d(b, l, -k, m, cosines, sines, precision);
            if (k & 1) {
                arb_neg(b, b);
            }
            if (k == 0 || m == 0) {
                if (k || m) { /* d_0m sqrt(2); d_-k0 = (-1)^k d_k0 */
                    arb_sqrt_ui(b, 2, precision);
                    arb_mul(a, a, b, precision);
                }
                arb_set(block + (l + k) * n + l + m, a);
            } else {
                arb_add(block + (l + k) * n + l + m, a, b, precision);
                arb_sub(block + (l - k) * n + l - m, a, b, precision);
            }
        }
    }
    arb_clear(half);
    arb_clear(c);
    arb_clear(s);
    arb_clear(a);
    arb_clear(b);
    _arb_vec_clear(cosines, n);
    _arb_vec_clear(sines, n);
}

/* Pairs (m, -m) at a and b, stride apart from pair element to element, turned by m angle:
 * c'_m = c_m cos - c_-m sin, c'_-m = c_m sin + c_-m cos. */
static void turn_pair(arb_t a, arb_t b, const arb_t c, const arb_t s, slong precision)
{
    arb_t t, u;
    arb_init(t);
    arb_init(u);
    arb_mul(t, a, c, precision);
    arb_submul(t, b, s, precision);
    arb_mul(u, a, s, precision);
    arb_addmul(u, b, c, precision);
    arb_swap(a, t);
    arb_swap(b, u);
    arb_clear(t);
    arb_clear(u);
}

/* Rows (Z block) or columns (block Z). */
static void turn_z(arb_ptr block, slong l, double angle, int columns, slong precision)
{
    const slong n = 2 * l + 1;
    arb_t       t, c, s;
    arb_init(t);
    arb_init(c);
    arb_init(s);
    for (slong m = 1; m <= l; m++) {
        arb_set_d(t, angle);
        arb_mul_si(t, t, m, precision);
        arb_sin_cos(s, c, t, precision);
        if (columns) {
            arb_neg(s, s);
        }
        for (slong i = 0; i < n; i++) {
            turn_pair(block + (columns ? i * n + l + m : (l + m) * n + i),
                      block + (columns ? i * n + l - m : (l - m) * n + i), c, s, precision);
        }
    }
    arb_clear(t);
    arb_clear(c);
    arb_clear(s);
}

static void enclose_block(void *user, arb_ptr out, slong count, slong precision)
{
    const task *job = user;
    _arb_vec_zero(out, count);
    turn_y(out, job->l, job->euler[1], precision);
    turn_z(out, job->l, job->euler[0], 0, precision);
    turn_z(out, job->l, job->euler[2], 1, precision);
}

/* (a, b) turned by angle. */
static void turn_plane(arb_t a, arb_t b, double angle, slong precision)
{
    arb_t c, s;
    arb_init(c);
    arb_init(s);
    arb_set_d(s, angle);
    arb_sin_cos(s, c, s, precision);
    turn_pair(a, b, c, s, precision);
    arb_clear(c);
    arb_clear(s);
}

static void sh_at(acb_ptr out, arb_srcptr d, slong order, slong precision)
{
    acb_ptr cosines = _acb_vec_init(order), sines = _acb_vec_init(order);
    acb_t   x, y, z;
    acb_init(x);
    acb_init(y);
    acb_init(z);
    acb_set_arb(x, d);
    acb_set_arb(y, d + 1);
    acb_set_arb(z, d + 2);
    basis *b = basis_create(BASIS_SH, order, precision);
    basis_azimuth(cosines, sines, order, x, y, precision);
    basis_values(out, b, cosines, sines, z, z, precision);
    basis_destroy(b);
    acb_clear(x);
    acb_clear(y);
    acb_clear(z);
    _acb_vec_clear(cosines, order);
    _acb_vec_clear(sines, order);
}

/* Y_j(w) = sum_i D_ij Y_i(R w) at a direction. */
static void check_definition(task *job)
{
    const slong precision = 512, l = job->l, n = 2 * l + 1, order = l + 1;
    arb_ptr     block = _arb_vec_init(n * n), d = _arb_vec_init(3);
    acb_ptr     before = _acb_vec_init(order * order), after = _acb_vec_init(order * order);
    arb_t       sum;
    arb_init(sum);
    arb_set_d(sum, 1.0);
    arb_div_si(d, sum, 3, precision); /* (1, -2, 2) / 3 */
    arb_mul_si(d + 1, d, -2, precision);
    arb_mul_si(d + 2, d, 2, precision);
    sh_at(before, d, order, precision);
    turn_plane(d, d + 1, job->euler[2], precision);
    turn_plane(d + 2, d, job->euler[1], precision); /* z towards x */
    turn_plane(d, d + 1, job->euler[0], precision);
    sh_at(after, d, order, precision);
    enclose_block(job, block, n * n, precision);
    for (slong j = 0; j < n; j++) {
        arb_zero(sum);
        for (slong i = 0; i < n; i++) {
            arb_addmul(sum, block + i * n + j, acb_realref(after + l * l + i), precision);
        }
        ref_check_same(sum, acb_realref(before + l * l + j), "a turned harmonic");
    }
    arb_clear(sum);
    _arb_vec_clear(block, n * n);
    _arb_vec_clear(d, 3);
    _acb_vec_clear(before, order * order);
    _acb_vec_clear(after, order * order);
}

static void write_table(const char *folder, slong l, const double (*angles)[3], int count)
{
    const slong n = 2 * l + 1;
    char        name[32], content[96];
    snprintf(name, sizeof name, "sh_rotation_%02ld", (long)l);
    snprintf(content, sizeof content, "rotation of spherical harmonics, block of band l = %ld",
             (long)l);
    const ref_header header = {
        .name      = name,
        .generator = "gen_sh_rotation",
        .content   = content,
        .method    = "Wigner's sum; every block checked against its definition at a direction",
        .notes   = "thesis signs; out = D in, rows are outputs; R = Rz(alpha) Ry(beta) Rz(gamma), "
                   "active, right-handed, rad; Y_j(R^-1 w) = sum over i of D_ij Y_i(w)",
        .keys    = "alpha beta gamma m",
        .values  = "column l + m of the block",
        .rows    = count * n,
        .columns = n};
    ref_number *numbers = ref_allocate((size_t)(n * n), sizeof *numbers);
    ref_table  *table   = ref_create(folder, &header);
    for (int k = 0; k < count; k++) {
        task job = {{angles[k][0], angles[k][1], angles[k][2]}, l};
        check_definition(&job);
        ref_round_all(enclose_block, &job, n * n, 0, numbers);
        for (slong i = 0; i < n; i++) {
            for (int e = 0; e < 3; e++) {
                ref_key(table, job.euler[e]);
            }
            ref_key(table, (double)(i - l));
            for (slong j = 0; j < n; j++) {
                ref_value(table, numbers + i * n + j);
            }
            ref_end_row(table);
        }
    }
    ref_finish(table);
    free(numbers);
}

int main(int argc, char **argv)
{
    static const double angles[][3] = {
        {0.0, 0.75, 0.0},
        {0.3, 1.1, -2.2},
        {-2.9, 2.875, 1.7},
        {0.5, 1e-9, 0.25},
        {1.25, 0x1.921fb54442d18p+0, -0.5}, /* the double nearest to pi / 2 */
        {0.125, 0x1.921fb54442d18p+1, 2.0}, /* and to pi */
        {0.625, 0.0, 0.0},
    };
    static const slong bands[] = {1, 2, 5, 10, 16, 32};

    const char *folder = argc > 1 ? argv[1] : ".";
    for (int i = 0; i < 6; i++) {
        write_table(folder, bands[i], angles, bands[i] == 32 ? 5 : 7);
    }
    flint_cleanup();
    return 0;
}
