/* tables.c - matrices by quadrature of their definitions: exact for what the nodes resolve.
 *
 * On the hemisphere z = s^2: HSH of odd m go as sqrt(z), which becomes smooth. */
#include "tables.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

/* A table is wrong where its stage is, not where harmonics are evaluated. */
#define IS_PLANTED(name) 0

#define REAL double
#define ROOT sqrt
#define NAME(what) double_##what
#include "harmonics_body.h"

static const double PI = 3.14159265358979323846;

enum { MOST_ORDER = 12, MOST = MOST_ORDER * MOST_ORDER, NODES = 48, TURNS = 2 * MOST_ORDER };

/* Gauss and Legendre's nodes in (-1, 1), by Newton. */
static void find_nodes(double nodes[NODES], double weights[NODES])
{
    for (int i = 0; i < NODES; i++) {
        double x = cos(PI * (i + 0.75) / (NODES + 0.5)), slope = 1.0;
        for (int step = 0; step < 8; step++) {
            double before = 1.0, p = x;
            for (int n = 2; n <= NODES; n++) {
                const double next = ((2 * n - 1) * x * p - (n - 1) * before) / n;
                before            = p;
                p                 = next;
            }
            slope = NODES * (x * p - before) / (x * x - 1.0);
            x -= p / slope;
        }
        nodes[i]   = x;
        weights[i] = 2.0 / ((1.0 - x * x) * slope * slope);
    }
}

static void direction(double z, int k, double out[3])
{
    const double phi = 2.0 * PI * (k + 0.5) / TURNS, sine = sqrt(1.0 - z * z);
    out[0] = sine * cos(phi);
    out[1] = sine * sin(phi);
    out[2] = z;
}

static void add_products(const double *rows, size_t row_count, const double *columns,
                         size_t column_count, double weight, double *sums)
{
    for (size_t i = 0; i < row_count; i++) {
        for (size_t j = 0; j < column_count; j++) {
            sums[i * column_count + j] += weight * rows[i] * columns[j];
        }
    }
}

static table as_table(size_t rows, size_t columns, double *sums)
{
    table t = table_make(rows, columns);
    for (size_t i = 0; i < rows * columns; i++) {
        /* What is 0 but for rounding is 0. */
        t.values[i] = fabs(sums[i]) < 1e-13 ? 0.0f : (float)sums[i];
    }
    free(sums);
    return t;
}

table table_of_conversion(int hsh_order, int sh_order)
{
    const size_t rows = (size_t)(hsh_order * hsh_order), columns = (size_t)(sh_order * sh_order);
    double       nodes[NODES], weights[NODES], hsh[MOST], sh[MOST], d[3];
    double      *sums = allocate(rows * columns, sizeof *sums);
    find_nodes(nodes, weights);
    for (int i = 0; i < NODES; i++) {
        const double s = 0.5 * (nodes[i] + 1.0);
        for (int k = 0; k < TURNS; k++) {
            direction(s * s, k, d);
            double_evaluate(hsh_order, true, d, hsh);
            double_evaluate(sh_order, false, d, sh);
            /* dz = 2 s ds, ds = half of dx */
            add_products(hsh, rows, sh, columns, weights[i] * s * (2.0 * PI / TURNS), sums);
        }
    }
    return as_table(rows, columns, sums);
}

/* R^-1 w. */
static void turn_back(const double angles[3], const double w[3], double out[3])
{
    const double ca = cos(angles[0]), sa = sin(angles[0]);
    const double cb = cos(angles[1]), sb = sin(angles[1]);
    const double cg = cos(angles[2]), sg = sin(angles[2]);
    const double x = ca * w[0] + sa * w[1], y = ca * w[1] - sa * w[0];
    const double u = cb * x - sb * w[2];
    out[0]         = cg * u + sg * y;
    out[1]         = cg * y - sg * u;
    out[2]         = sb * x + cb * w[2];
}

table table_of_turn(int order, const double angles[3])
{
    const size_t count = (size_t)(order * order);
    double       nodes[NODES], weights[NODES], here[MOST], there[MOST], d[3], before[3];
    double      *sums = allocate(count * count, sizeof *sums);
    find_nodes(nodes, weights);
    for (int i = 0; i < NODES; i++) {
        for (int k = 0; k < TURNS; k++) {
            direction(nodes[i], k, d);
            turn_back(angles, d, before);
            double_evaluate(order, false, d, here);
            double_evaluate(order, false, before, there);
            add_products(here, count, there, count, weights[i] * (2.0 * PI / TURNS), sums);
        }
    }
    return as_table(count, count, sums);
}
