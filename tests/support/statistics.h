/* statistics.h - is this sampler the one of that density?  For tests alone.
 *
 * Directions are binned on a grid of the sphere; what each cell should hold comes from adaptive
 * quadrature of the density, and Pearson's chi-square test compares.  Everything is seeded, so a
 * test that passes once passes always. */
#ifndef ASSAY_TESTS_STATISTICS_H
#define ASSAY_TESTS_STATISTICS_H

#include <stdbool.h>
#include <stdint.h>

#include "assay/types.h"

/* Regularised upper incomplete gamma function Q(a, x), a > 0, x >= 0. */
double statistics_gamma_q(double a, double x);

/* Probability that a chi-square variate with k degrees of freedom is at least x. */
double statistics_chi_square_tail(double x, int k);

/* The level of each of `count` independent tests that together err with probability `level`:
 * 1 - (1 - level)^(1 / count), Sidak's correction. */
double statistics_sidak(double level, int count);

/* ---- integrals over directions ---- */

typedef double (*statistics_density)(const void *context, assay_vec3 direction);

enum { STATISTICS_EDGES = 96 };

/* Cells between heights z (ascending in [-1, 1]) and azimuths phi (ascending, one turn). */
typedef struct {
    int    rows, columns;
    double z[STATISTICS_EDGES], phi[STATISTICS_EDGES];
} statistics_grid;

/* Cells of equal area between two heights; phi from -pi. */
statistics_grid statistics_grid_between(double z_min, double z_max, int rows, int columns);

/* Adds edges about a direction, down to `width` radians: without them a narrow lobe can fall
 * between the nodes of the quadrature. */
void statistics_grid_focus(statistics_grid *grid, assay_vec3 direction, double width);

/* Adds an edge at a height, where the density jumps. */
void statistics_grid_cut(statistics_grid *grid, double z);

/* Integral of the density over the grid, 1/sr times sr, by Gauss-Legendre rules of 4 x 4 nodes,
 * halved where a cell and its quarters differ by more than `tolerance` or 1e-9 of the value, down
 * to 2^-9 of the cell.  cells_out (rows * columns, row by row) may be NULL. */
double statistics_integrate(const statistics_grid *grid, statistics_density density,
                            const void *context, double tolerance, double *cells_out);

/* ---- samplers ---- */

/* A direction from three uniform numbers; false: nothing drawn. */
typedef bool (*statistics_sampler)(const void *context, const double u[3],
                                   assay_vec3 *direction_out);

typedef struct {
    double p;       /* of data as far off as these or farther, if the density is right; 0 where
                       the density is impossible                                            */
    double p_shape; /* of the chi-square statistic alone                                    */
    double mass;    /* integral of the density                                              */
    double drawn;   /* share of draws that gave a direction                                 */
    double chi_square;
    int    degrees;
} statistics_verdict;

/* Draws `count` times, at least 1000.  Draws that give nothing are a bin of their own, with what
 * the density's integral leaves to 1.  Bins of fewer than 5 expected are pooled; what is left of
 * the pool, and the share of draws that gave a direction, are tested apart, and p is the least of
 * the three probabilities times 3 (Bonferroni's correction).  p is 0 where the integral exceeds 1
 * by more than 1e-4, where the density is negative or not finite, or where it is zero at a
 * direction that was drawn. */
statistics_verdict statistics_test_sampler(const statistics_grid *grid, statistics_density density,
                                           statistics_sampler sampler, const void *context,
                                           int count, uint64_t seed);

/* ---- means ---- */

typedef struct {
    double   mean, m2;
    uint64_t count;
} statistics_mean;

/* Welford's update. */
void statistics_mean_add(statistics_mean *mean, double x);
/* Standard error of the mean. */
double statistics_mean_error(const statistics_mean *mean);

#endif
