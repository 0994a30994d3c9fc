/* gen_gradients.c - sh_gradients, hsh_gradients.
 *
 * Invariant: C_m of the direction's doubles is exact, so that a component is an exact zero where
 * symmetry makes it one.  A function g(z) C_m(x, y) has the gradient (g dC/dx, g dC/dy, g' C) in
 * space, dC_m/dx = m C_{m-1}, dC_m/dy = -m S_{m-1}, dS_m/dx = m S_{m-1}, dS_m/dy = m C_{m-1}; its
 * part along the unit vector n is taken off.  Checked against differences at 1024 bits. */
#include <stdlib.h>

#include "bases.h"
#include "directions.h"
#include "ref.h"

#define ORDER 17
#define COUNT (ORDER * ORDER)

typedef struct {
    const double *d;
    basis_kind    kind;
} task;

/* n = d / |d|, and C_m, S_m of n from exact C_m, S_m of d. */
static void set_up(arb_ptr n, arb_t r, acb_ptr cosines, acb_ptr sines, arb_srcptr d, slong exact,
                   slong precision)
{
    acb_t x, y;
    arb_t power;
    acb_init(x);
    acb_init(y);
    arb_init(power);
    arb_zero(r);
    for (int i = 0; i < 3; i++) {
        arb_addmul(r, d + i, d + i, exact);
    }
    arb_sqrt(r, r, precision);
    for (int i = 0; i < 3; i++) {
        arb_div(n + i, d + i, r, precision);
    }
    acb_set_arb(x, d);
    acb_set_arb(y, d + 1);
    basis_azimuth(cosines, sines, ORDER, x, y, exact);
    arb_one(power);
    for (slong m = 0; m < ORDER; m++) {
        acb_div_arb(cosines + m, cosines + m, power, precision);
        acb_div_arb(sines + m, sines + m, power, precision);
        arb_mul(power, power, r, precision);
    }
    acb_clear(x);
    acb_clear(y);
    arb_clear(power);
}

/* g and g' of (l, m). */
static void zonal_part(arb_t g, arb_t slope, const basis *b, basis_kind kind, slong l, slong m,
                       const arb_t z, slong precision)
{
    acb_t value, derivative, argument;
    arb_t t, u;
    acb_init(value);
    acb_init(derivative);
    acb_init(argument);
    arb_init(t);
    arb_init(u);
    acb_set_arb(argument, z);
    basis_polynomial(value, derivative, b, l, m, argument, precision);
    acb_get_real(g, value);
    acb_get_real(slope, derivative);
    if (kind == BASIS_HSH && m) {
        arb_add_si(t, z, 1, precision);
        arb_mul(u, t, z, precision);
        arb_mul_2exp_si(u, u, 1);
        arb_set_si(t, m);
        arb_div(u, t, u, precision);
        arb_addmul(slope, g, u, precision);
        arb_add_si(t, z, 1, precision);
        arb_div(t, z, t, precision);
        arb_sqrt(t, t, precision);
        arb_pow_ui(t, t, (ulong)m, precision);
        arb_mul(g, g, t, precision);
        arb_mul(slope, slope, t, precision);
    }
    acb_clear(value);
    acb_clear(derivative);
    acb_clear(argument);
    arb_clear(t);
    arb_clear(u);
}

/* out_i = g_i (1 - n_i^2) - n_i sum over j != i of n_j g_j, with 1 - n_i^2 as the other squares. */
static void tangential(arb_ptr out, arb_srcptr gradient, arb_srcptr n, slong precision)
{
    arb_t squares, along;
    arb_init(squares);
    arb_init(along);
    for (int i = 0; i < 3; i++) {
        arb_zero(squares);
        arb_zero(along);
        for (int k = 1; k < 3; k++) {
            const int j = (i + k) % 3;
            arb_addmul(squares, n + j, n + j, precision);
            arb_addmul(along, n + j, gradient + j, precision);
        }
        arb_mul(out + i, gradient + i, squares, precision);
        arb_submul(out + i, n + i, along, precision);
    }
    arb_clear(squares);
    arb_clear(along);
}

/* out[3 i + component]. */
static void enclose_gradients(void *user, arb_ptr out, slong count, slong precision)
{
    const task *job = user;
    arb_ptr     d = _arb_vec_init(3), n = _arb_vec_init(3), gradient = _arb_vec_init(3);
    acb_ptr     cosines = _acb_vec_init(ORDER), sines = _acb_vec_init(ORDER);
    arb_t       r, g, slope;
    arb_init(r);
    arb_init(g);
    arb_init(slope);
    for (int i = 0; i < 3; i++) {
        arb_set_d(d + i, job->d[i]);
    }
    set_up(n, r, cosines, sines, d, ARF_PREC_EXACT, precision);
    basis *b = basis_create(job->kind, ORDER, precision);
    for (slong l = 0; l < ORDER; l++) {
        for (slong m = -l; m <= l; m++) {
            const slong      k   = labs(m);
            const acb_srcptr own = m < 0 ? sines : cosines, other = m < 0 ? cosines : sines;
            zonal_part(g, slope, b, job->kind, l, k, n + 2, precision);
            arb_mul(gradient + 2, slope, acb_realref(own + k), precision);
            arb_mul_si(g, g, k, precision);
            arb_zero(gradient);
            arb_zero(gradient + 1);
            if (k) {
                arb_mul(gradient, g, acb_realref(own + k - 1), precision);
                arb_mul(gradient + 1, g, acb_realref(other + k - 1), precision);
                if (m > 0) {
                    arb_neg(gradient + 1, gradient + 1);
                }
            }
            tangential(out + 3 * (l * l + l + m), gradient, n, precision);
        }
    }
    basis_destroy(b);
    arb_clear(r);
    arb_clear(g);
    arb_clear(slope);
    _arb_vec_clear(d, 3);
    _arb_vec_clear(n, 3);
    _arb_vec_clear(gradient, 3);
    _acb_vec_clear(cosines, ORDER);
    _acb_vec_clear(sines, ORDER);
    (void)count;
}

static void values_at(acb_ptr out, arb_srcptr d, const basis *b, basis_kind kind, slong precision)
{
    arb_ptr n       = _arb_vec_init(3);
    acb_ptr cosines = _acb_vec_init(ORDER), sines = _acb_vec_init(ORDER);
    arb_t   r;
    acb_t   z, root_z;
    arb_init(r);
    acb_init(z);
    acb_init(root_z);
    set_up(n, r, cosines, sines, d, precision, precision);
    acb_set_arb(z, n + 2);
    if (kind != BASIS_SH) {
        acb_sqrt(root_z, z, precision);
    }
    basis_values(out, b, cosines, sines, z, root_z, precision);
    arb_clear(r);
    acb_clear(z);
    acb_clear(root_z);
    _arb_vec_clear(n, 3);
    _acb_vec_clear(cosines, ORDER);
    _acb_vec_clear(sines, ORDER);
}

/* (F(d + h e_k) - F(d - h e_k)) |d| / 2h = gradient_k, within 2^-200, at h = 2^-200. */
static void check_differences(const double *direction, basis_kind kind)
{
    const slong precision = 1024;
    arb_ptr     gradients = _arb_vec_init(3 * COUNT), d = _arb_vec_init(3);
    acb_ptr     ahead = _acb_vec_init(COUNT), behind = _acb_vec_init(COUNT);
    arb_t       h, difference, r;
    task        job = {direction, kind};
    arb_init(h);
    arb_init(difference);
    arb_init(r);
    arb_set_d(h, 0x1p-200);
    enclose_gradients(&job, gradients, 3 * COUNT, precision);
    basis *b = basis_create(kind, ORDER, precision);
    for (int i = 0; i < 3; i++) {
        arb_set_d(d + i, direction[i]);
        arb_addmul(r, d + i, d + i, precision);
    }
    arb_sqrt(r, r, precision);
    for (int k = 0; k < 3; k++) {
        arb_add(d + k, d + k, h, precision);
        values_at(ahead, d, b, kind, precision);
        arb_submul_si(d + k, h, 2, precision);
        values_at(behind, d, b, kind, precision);
        arb_add(d + k, d + k, h, precision);
        for (slong i = 0; i < COUNT; i++) {
            arb_sub(difference, acb_realref(ahead + i), acb_realref(behind + i), precision);
            arb_mul_2exp_si(difference, difference, 199);
            arb_mul(difference, difference, r, precision);
            arb_add_error_2exp_si(difference, -200);
            ref_check_same(gradients + 3 * i + k, difference, "gradients");
        }
    }
    basis_destroy(b);
    arb_clear(h);
    arb_clear(difference);
    arb_clear(r);
    _arb_vec_clear(gradients, 3 * COUNT);
    _arb_vec_clear(d, 3);
    _acb_vec_clear(ahead, COUNT);
    _acb_vec_clear(behind, COUNT);
}

static void write_table(const char *folder, const ref_header *header, basis_kind kind,
                        const ref_direction *directions, int count)
{
    ref_header  full    = *header;
    ref_number *numbers = ref_allocate(3 * COUNT, sizeof *numbers);
    full.generator      = "gen_gradients";
    full.method  = "derivatives of explicit Jacobi sums; checked against differences at 1024 bits";
    full.notes   = "thesis signs; gradient on the unit sphere, tangential, per radian, at d / |d|, "
                   "d = (x, y, z); a row holds one component (0: x, 1: y, 2: z) of all functions";
    full.keys    = "x y z component";
    full.values  = "column l*l + l + m";
    full.rows    = 3 * count;
    full.columns = COUNT;
    ref_table *table = ref_create(folder, &full);
    for (int i = 0; i < count; i++) {
        task job = {directions[i].d, kind};
        ref_round_all(enclose_gradients, &job, 3 * COUNT, 0, numbers);
        for (int component = 0; component < 3; component++) {
            for (int k = 0; k < 3; k++) {
                ref_key(table, directions[i].d[k]);
            }
            ref_key(table, component);
            for (slong k = 0; k < COUNT; k++) {
                ref_value(table, numbers + 3 * k + component);
            }
            ref_end_row(table);
        }
    }
    ref_finish(table);
    free(numbers);
}

int main(int argc, char **argv)
{
    static const ref_header sh  = {.name    = "sh_gradients",
                                   .content = "surface gradients of spherical harmonics, l <= 16"};
    static const ref_header hsh = {.name = "hsh_gradients",
                                   .content =
                                       "surface gradients of hemispherical harmonics, l <= 16"};

    const char    *folder = argc > 1 ? argv[1] : ".";
    int            count, upper;
    ref_direction *all = ref_gradient_directions(&count, &upper);
    check_differences(all[count - 1].d, BASIS_SH);
    check_differences(all[upper - 1].d, BASIS_SH);
    check_differences(all[upper - 1].d, BASIS_HSH);
    check_differences(all[upper - 2].d, BASIS_HSH);
    write_table(folder, &sh, BASIS_SH, all, count);
    write_table(folder, &hsh, BASIS_HSH, all, upper);
    free(all);
    flint_cleanup();
    return 0;
}
