/* tables.h - constants that a backend computes once: in double precision, kept as floats. */
#ifndef BACKEND_TABLES_H
#define BACKEND_TABLES_H

#include "table.h"

/* C, [gautron06] eq. 3.20: a row a function of HSH, a column one of SH. */
table table_of_conversion(int hsh_order, int sh_order);

/* D: c' = D c are the coefficients in SH of f(R^-1 w), R = Rz(alpha) Ry(beta) Rz(gamma). */
table table_of_turn(int order, const double angles[3]);

#endif
