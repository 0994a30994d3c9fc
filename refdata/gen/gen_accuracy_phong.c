/* gen_accuracy_phong.c - accuracy_phong: the lobe max(0, cos alpha)^5 about a mirror direction.
 *
 * Invariant: with the mirror direction r = (sin t, 0, cos t) the lobe is z'^5 on H - I of a turn
 * by beta = -t (lune.h), where it is analytic.  For t = 0 only m = 0 counts, and in s = sqrt(z) all
 * integrands are polynomials, for which the rule is exact. */
#include <arb_hypgeom.h>
#include <stdlib.h>

#include "accuracy.h"
#include "lune.h"

typedef struct {
    double theta;
} task;

typedef struct {
    accuracy *a;
    acb_ptr   cosines, sines;
} state;

static void add_lobe(void *user, const lune_point *p, slong precision)
{
    state *s = user;
    acb_t  f;
    acb_init(f);
    basis_azimuth(s->cosines, s->sines, ACCURACY_ORDER, p->x, p->y, precision);
    acb_pow_ui(f, p->z2, 5, precision);
    acb_mul(f, f, p->weight, precision);
    accuracy_add(s->a, s->cosines, p->z, p->root_z, f, precision);
    acb_pow_ui(f, p->z2, 10, precision);
    acb_mul(f, f, p->weight, precision);
    accuracy_add_energy(s->a, acb_realref(f), acb_realref(p->z), precision);
    acb_clear(f);
}

static void bound_lobe(void *user, arb_t out, const lune_point *p, slong precision)
{
    state *s = user;
    mag_t  f, b, g;
    mag_init(f);
    mag_init(g);
    mag_init(b);
    basis_azimuth(s->cosines, s->sines, ACCURACY_ORDER, p->x, p->y, precision);
    accuracy_bound(b, s->a, s->cosines, p->z, p->root_z, precision);
    acb_get_mag(f, p->z2);
    mag_pow_ui(f, f, 5);
    mag_max(b, b, f);
    acb_get_mag(g, p->z);
    mag_mul(g, g, f);
    mag_max(b, b, g);
    arb_zero(out);
    mag_mul(arb_radref(out), f, b);
    mag_clear(f);
    mag_clear(g);
    mag_clear(b);
}

/* t = 0: 2 pi times the integral over [0, 1] of z^5 B(z) dz, z = s^2. */
static void add_normal(state *s, slong precision)
{
    const slong nodes = 40;
    acb_t       z, root_z, f;
    arb_t       weight;
    acb_init(z);
    acb_init(root_z);
    acb_init(f);
    arb_init(weight);
    basis_azimuth(s->cosines, s->sines, ACCURACY_ORDER, z, z, precision); /* 1, 0, 0, ... */
    for (slong i = 0; i < nodes; i++) {
        arb_hypgeom_legendre_p_ui_root(acb_realref(root_z), weight, (ulong)nodes, (ulong)i,
                                       precision);
        acb_add_si(root_z, root_z, 1, precision);
        acb_mul_2exp_si(root_z, root_z, -1);
        acb_sqr(z, root_z, precision);
        arb_mul(weight, weight, acb_realref(root_z), precision); /* 2 s ds, ds half the weight */
        acb_pow_ui(f, z, 5, precision);
        acb_mul_arb(f, f, weight, precision);
        arb_const_pi(weight, precision);
        arb_mul_2exp_si(weight, weight, 1);
        acb_mul_arb(f, f, weight, precision);
        accuracy_add(s->a, s->cosines, z, root_z, f, precision);
        acb_pow_ui(root_z, z, 5, precision);
        acb_mul(f, f, root_z, precision);
        accuracy_add_energy(s->a, acb_realref(f), acb_realref(z), precision);
    }
    acb_clear(z);
    acb_clear(root_z);
    acb_clear(f);
    arb_clear(weight);
}

static void enclose(void *user, arb_ptr out, slong count, slong precision)
{
    const task *job = user;
    state       s   = {accuracy_create(precision + 64), _acb_vec_init(ACCURACY_ORDER),
                       _acb_vec_init(ACCURACY_ORDER)};
    arb_t       beta, error;
    arb_init(beta);
    arb_init(error);
    arb_set_d(beta, -job->theta);
    if (job->theta == 0.0) {
        add_normal(&s, precision + 64);
    } else {
        const lune_integrand f = {add_lobe, bound_lobe, &s};
        lune_integrate(error, &f, beta, precision);
    }
    accuracy_finish(out, s.a, error, precision);
    accuracy_destroy(s.a);
    _acb_vec_clear(s.cosines, ACCURACY_ORDER);
    _acb_vec_clear(s.sines, ACCURACY_ORDER);
    arb_clear(beta);
    arb_clear(error);
    (void)count;
}

int main(int argc, char **argv)
{
    static const slong degrees[] = {0, 30, 60, 80};
    const ref_header   header    = {
             .name      = "accuracy_phong",
             .generator = "gen_accuracy_phong",
             .content   = "share of the energy of max(0, cos alpha)^5 that a basis captures, by order "
                               "[gautron06] eq. 3.32",
             .method    = "Gauss product rule, error proven on Bernstein ellipses (lune.c)",
             .notes = "alpha: angle to (sin theta, 0, cos theta); theta: rad, the double nearest to 0, "
                           "30, 60, 80 degrees; order n: l < n; SH of the lobe that is 0 below the horizon; "
                           "ESH: sqrt(2) Y_lm, l + m even; makhotkin_sqrt: times sqrt(cos theta)",
             .keys  = "theta order",
             .values  = ACCURACY_VALUES,
             .rows    = 4 * ACCURACY_ORDER,
             .columns = ACCURACY_COLUMNS};
    ref_table *table = ref_create(argc > 1 ? argv[1] : ".", &header);
    for (int i = 0; i < 4; i++) {
        task job = {ref_radians(degrees[i])};
        accuracy_write(table, job.theta, enclose, &job);
    }
    ref_finish(table);
    flint_cleanup();
    return 0;
}
