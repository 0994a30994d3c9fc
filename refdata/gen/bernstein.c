/* bernstein.c - (rho e^(i t) + e^(-i t) / rho) / 2, t in pieces of [0, pi].
 *
 * Invariant: the pieces overlap at their ends and leave nothing out. */
#include "bernstein.h"

void bernstein_ellipse_piece(acb_t out, double rho, slong i, slong n, slong precision)
{
    acb_t turn;
    acb_init(turn);
    arb_set_si(acb_realref(turn), 2 * i + 1);
    arb_add_error_2exp_si(acb_realref(turn), 0);
    arb_div_si(acb_realref(turn), acb_realref(turn), 2 * n, precision);
    acb_exp_pi_i(turn, turn, precision);
    arb_set_d(acb_realref(out), rho);
    arb_zero(acb_imagref(out));
    acb_mul(out, out, turn, precision);
    acb_inv(turn, out, precision);
    acb_add(out, out, turn, precision);
    acb_mul_2exp_si(out, out, -1);
    acb_clear(turn);
}

void bernstein_segment_piece(acb_t out, slong i, slong n, slong precision)
{
    arb_set_si(acb_realref(out), 2 * i + 1 - n);
    arb_add_error_2exp_si(acb_realref(out), 0);
    arb_div_si(acb_realref(out), acb_realref(out), n, precision);
    arb_zero(acb_imagref(out));
}
