/* test_reference_values.c - the certified tables against closed forms and sums that hold exactly.
 *
 * Nothing of src/basis is used: this judges the judges.  Tolerances are roundings of the test's own
 * double arithmetic, a few 2^-53 of what is summed. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdio.h>

#include "support/near.h"
#include "support/reference_table.h"

#define PI 3.14159265358979323846

typedef struct {
    double x, y, z;
} unit;

static unit unit_of(const double *d)
{
    const double r = sqrt((d[0] * d[0] + d[1] * d[1]) + d[2] * d[2]);
    return (unit){d[0] / r, d[1] / r, d[2] / r};
}

static double band_energy(const double *values, int l)
{
    double sum = 0.0;
    for (int i = l * l; i < (l + 1) * (l + 1); i++) {
        sum += values[i] * values[i];
    }
    return sum;
}

static void harmonics_are_their_polynomials(void **state)
{
    reference_table *sh = reference_table_read("sh_values");
    const double     a = sqrt(3 / (4 * PI)), b = sqrt(15 / (4 * PI)), c = sqrt(5 / (16 * PI));
    for (size_t i = 0; i < sh->rows; i++) {
        const unit    d           = unit_of(reference_table_keys(sh, i));
        const double *v           = reference_table_values(sh, i);
        const double  expected[9] = {sqrt(1 / (4 * PI)),
                                     -a * d.y,
                                     a * d.z,
                                     -a * d.x,
                                     b * d.x * d.y,
                                     -b * d.y * d.z,
                                     c * (3 * d.z * d.z - 1),
                                     -b * d.x * d.z,
                                     b / 2 * (d.x * d.x - d.y * d.y)};
        for (int k = 0; k < 9; k++) {
            assert_near(v[k], expected[k], 4e-16);
        }
        for (int l = 0; l < 33; l++) {
            assert_near(band_energy(v, l) * 4 * PI / (2 * l + 1), 1.0, 1e-14);
        }
    }
    reference_table_free(sh);
    (void)state;
}

static void hemispherical_harmonics_are_shifted(void **state)
{
    reference_table *hsh = reference_table_read("hsh_values");
    for (size_t i = 0; i < hsh->rows; i++) {
        const unit    d       = unit_of(reference_table_keys(hsh, i));
        const double *v       = reference_table_values(hsh, i);
        const double  stretch = sqrt(4 * d.z / (1 + d.z)), x = 2 * d.z - 1;
        const double  a = sqrt(3 / (2 * PI)), b = sqrt(15 / (2 * PI));
        assert_near(v[0], 1 / sqrt(2 * PI), 1e-15);
        assert_near(v[1], -a * stretch * d.y, 1e-15);
        assert_near(v[2], a * x, 1e-15);
        assert_near(v[3], -a * stretch * d.x, 1e-15);
        assert_near(v[5], -b * x * stretch * d.y, 2e-15);
        assert_near(v[8], b / 2 * stretch * stretch * (d.x * d.x - d.y * d.y), 2e-15);
        for (int l = 0; l < 33; l++) {
            assert_near(band_energy(v, l) * 2 * PI / (2 * l + 1), 1.0, 1e-14);
        }
    }
    reference_table_free(hsh);
    (void)state;
}

static void other_bases_begin_well(void **state)
{
    reference_table *zernike   = reference_table_read("zernike_values");
    reference_table *makhotkin = reference_table_read("makhotkin_values");
    reference_table *root      = reference_table_read("makhotkin_sqrt_values");
    for (size_t i = 0; i < zernike->rows; i++) {
        const unit    d = unit_of(reference_table_keys(zernike, i));
        const double *v = reference_table_values(zernike, i);
        const double *w = reference_table_values(makhotkin, i);
        const double *r = reference_table_values(root, i);
        assert_near(v[0], sqrt(1 / (2 * PI)), 1e-15);
        assert_near(v[1], sqrt(2 / PI) * d.y / sqrt(1 + d.z), 1e-15);
        assert_near(v[2], sqrt(2 / PI) * d.x / sqrt(1 + d.z), 1e-15);
        assert_near(v[4], sqrt(3 / (2 * PI)) * (1 - 2 * d.z), 2e-15);
        assert_near(w[0], sqrt(1 / PI), 1e-15);
        assert_near(w[2], sqrt(2 / PI) * (3 * d.z - 2), 2e-15);
        assert_near(w[3], sqrt(12 / PI) * sqrt(d.z / (1 + d.z)) * d.x, 2e-15);
        for (int k = 0; k < 17 * 17; k++) {
            assert_near(r[k], w[k] * sqrt(d.z), 4e-16 * fabs(w[k]));
        }
    }
    reference_table_free(zernike);
    reference_table_free(makhotkin);
    reference_table_free(root);
    (void)state;
}

/* Sum over m of |grad Y_lm|^2 = l (l + 1) (2l + 1) / 4 pi; every gradient is tangential. */
static void gradients_are_tangential(void **state)
{
    static const char *const names[] = {"sh_gradients", "hsh_gradients"};
    for (int kind = 0; kind < 2; kind++) {
        reference_table *t = reference_table_read(names[kind]);
        for (size_t i = 0; i < t->rows; i += 3) {
            const unit    d    = unit_of(reference_table_keys(t, i));
            const double *g[3] = {reference_table_values(t, i), reference_table_values(t, i + 1),
                                  reference_table_values(t, i + 2)};
            for (int l = 0; l < 17; l++) {
                double sum = 0.0;
                for (int k = l * l; k < (l + 1) * (l + 1); k++) {
                    const double size = fabs(g[0][k]) + fabs(g[1][k]) + fabs(g[2][k]);
                    assert_near(g[0][k] * d.x + g[1][k] * d.y + g[2][k] * d.z, 0.0, 4e-16 * size);
                    sum += g[0][k] * g[0][k] + g[1][k] * g[1][k] + g[2][k] * g[2][k];
                }
                if (kind == 0 && l) {
                    assert_near(sum * 4 * PI / (l * (l + 1) * (2 * l + 1)), 1.0, 1e-14);
                }
            }
            const double a = kind ? 2 * sqrt(3 / (2 * PI)) : sqrt(3 / (4 * PI));
            assert_near(g[0][2], -a * d.z * d.x, 1e-15);
            assert_near(g[2][2], a * (d.x * d.x + d.y * d.y), 1e-15);
        }
        reference_table_free(t);
    }
    (void)state;
}

/* Entry by the 64-node rule in t, z = t^2; P_1^1 = -sqrt(1 - x^2), P_2^1 = 3 x P_1^1. */
static double entry_by_rule(const reference_table *gauss, int l, int k)
{
    double sum = 0.0;
    for (size_t i = gauss->rows - 64; i < gauss->rows; i++) {
        const double *v = reference_table_values(gauss, i);
        const double  t = (v[0] + 1) / 2, z = t * t, x = 2 * z - 1;
        const double  shifted = sqrt(1 - x * x) * (l == 2 ? 3 * x : 1);
        const double  plain   = sqrt(1 - z * z) * (k == 2 ? 3 * z : 1);
        sum += v[2] * t * shifted * plain;
    }
    const double norm_l = l == 2 ? 5.0 / 6 : 3.0 / 2, norm_k = k == 2 ? 5.0 / 6 : 3.0 / 2;
    return sum * sqrt(norm_l * norm_k / 2);
}

static double entry_of(const reference_table *t, int m, int l, int k)
{
    return reference_table_values(t, reference_table_find(t, (double[]){m, l, k}, 3))[0];
}

static void conversion_is_equation_3_20(void **state)
{
    reference_table *c     = reference_table_read("conversion");
    reference_table *bands = reference_table_read("conversion_bands");
    reference_table *gauss = reference_table_read("gauss_legendre");
    assert_near(entry_of(c, 0, 0, 0), sqrt(0.5), 1e-16);
    assert_near(entry_of(c, 0, 0, 1), sqrt(6) / 4, 2e-16);
    assert_true(entry_of(c, 0, 0, 2) == 0.0 && entry_of(c, 0, 1, 0) == 0.0);
    assert_near(entry_of(c, 0, 1, 1), sqrt(0.125), 1e-16);
    for (int l = 1; l <= 2; l++) {
        for (int k = 1; k <= 2; k++) {
            assert_near(entry_of(c, 1, l, k), entry_by_rule(gauss, l, k), 1e-14);
            assert_true(entry_of(c, -1, l, k) == entry_of(c, 1, l, k));
            assert_true(entry_of(bands, 1, l, k) == entry_of(c, 1, l, k));
        }
    }
    /* m = l = l' = 2: N = 5 / (24 sqrt 2), integral of 36 z (1 - z)^2 (1 + z) = 4.2 */
    assert_near(entry_of(c, 2, 2, 2), 4.2 * 5 / (24 * sqrt(2)), 2e-16);
    for (int m = 0; m < 10; m++) { /* rows of an isometry, cut off */
        for (int l = m; l < 10; l++) {
            double sum = 0.0;
            for (int k = m; k < 16; k++) {
                sum += entry_of(c, m, l, k) * entry_of(c, m, l, k);
            }
            assert_true(sum > 0.5 && sum < 1.0);
        }
    }
    reference_table_free(c);
    reference_table_free(bands);
    reference_table_free(gauss);
    (void)state;
}

static const double *matrix_row(const reference_table *t, double beta, int row)
{
    return reference_table_values(t, reference_table_find(t, (double[]){beta, row}, 2));
}

/* Sign of a function under x -> -x. */
static int mirrored(int i)
{
    const int l = (int)floor(sqrt((double)i)), m = i - l * l - l;
    return (m < 0 ? -1 : 1) * (m % 2 ? -1 : 1);
}

static void digons_are_consistent(void **state)
{
    reference_table *m = reference_table_read("digon_order6");
    reference_table *r = reference_table_read("hsh_rotation_order6");
    for (size_t i = 0; i < m->rows; i++) {
        const double  beta = reference_table_keys(m, i)[0], size = fabs(beta);
        const int     row = (int)reference_table_keys(m, i)[1];
        const double *a = reference_table_values(m, i), *b = reference_table_values(r, i);
        assert_true(reference_table_keys(r, i)[0] == beta && reference_table_keys(r, i)[1] == row);
        for (int k = 0; k < 36; k++) {
            assert_true(a[k] == matrix_row(m, beta, k)[row]);
        }
        assert_true(a[row] > 0.0 && a[row] < 1.0);
        if (row == 0) { /* of the lune: area 2 (pi - |b|), integral of z and of z' the same */
            const double z = sqrt(3) / (2 * PI) * (PI * (1 + cos(size)) - 2 * (PI - size));
            assert_near(a[0], 1 - size / PI, 1e-15);
            assert_near(b[0], 1 - size / PI, 1e-15);
            assert_near(a[2], z, 4e-16);
            assert_near(b[2], z, 4e-16);
            assert_near(matrix_row(r, beta, 2)[0], z, 4e-16);
        }
    }
    const double angle = reference_table_keys(m, 36)[0];
    assert_near(angle, PI / 6, 2e-16);
    for (int i = 0; i < 36; i++) {
        for (int k = 0; k < 36; k++) {
            const int sign = mirrored(i) * mirrored(k);
            assert_true(matrix_row(m, angle, i)[k] == sign * matrix_row(m, -angle, i)[k]);
            assert_true(matrix_row(r, angle, i)[k] == matrix_row(r, -angle, k)[i]);
            assert_true(matrix_row(r, angle, i)[k] == sign * matrix_row(r, -angle, i)[k]);
        }
    }
    reference_table_free(m);
    reference_table_free(r);
    (void)state;
}

/* The first nine, as eq. 3.18 prints them. */
static void first_hemispherical(double *out, double x, double y, double z)
{
    const double c = 2 * z - 1, s = sqrt(fmax(0.0, 4 * z * (1 - z))), phi = atan2(y, x);
    const double a = sqrt(3 / (2 * PI)), b = sqrt(15 / (2 * PI));
    out[0] = 1 / sqrt(2 * PI);
    out[1] = -a * s * sin(phi);
    out[2] = a * c;
    out[3] = -a * s * cos(phi);
    out[4] = b / 2 * s * s * sin(2 * phi);
    out[5] = -b * c * s * sin(phi);
    out[6] = sqrt(5 / (8 * PI)) * (3 * c * c - 1);
    out[7] = -b * c * s * cos(phi);
    out[8] = b / 2 * s * s * cos(2 * phi);
}

/* s in (-1, 1) -> (-1, 1) with zero slope at the ends, and the slope. */
static double smooth(double s, double *slope)
{
    *slope = 1.5 * (1 - s * s);
    return (3 * s - s * s * s) / 2;
}

/* Another map and formula than the generator's, 64 * 64 nodes of the certified rule. */
static void rotation_is_equation_3_31(void **state)
{
    reference_table *gauss = reference_table_read("gauss_legendre");
    reference_table *m     = reference_table_read("digon_order6");
    reference_table *r     = reference_table_read("hsh_rotation_order6");
    const double     beta = reference_table_keys(m, 36)[0], half = (PI - beta) / 2;
    double           digon[9][9] = {{0}}, turned[9][9] = {{0}};
    for (size_t i = gauss->rows - 64; i < gauss->rows; i++) {
        for (size_t j = gauss->rows - 64; j < gauss->rows; j++) {
            double        slope_a, slope_p, before[9], after[9];
            const double *u      = reference_table_values(gauss, i);
            const double *v      = reference_table_values(gauss, j);
            const double  alpha  = -PI / 2 + half * (1 + smooth(u[0], &slope_a));
            const double  psi    = PI / 2 * smooth(v[0], &slope_p);
            const double  weight = u[2] * v[2] * slope_a * slope_p * half * PI / 2 * cos(psi);
            const double  x = cos(psi) * sin(alpha), y = sin(psi), z = cos(psi) * cos(alpha);
            first_hemispherical(before, x, y, z);
            first_hemispherical(after, x * cos(beta) + z * sin(beta), y,
                                fmax(0.0, z * cos(beta) - x * sin(beta)));
            for (int p = 0; p < 9; p++) {
                for (int q = 0; q < 9; q++) {
                    digon[p][q] += weight * before[p] * before[q];
                    turned[q][p] += weight * before[p] * after[q];
                }
            }
        }
    }
    for (int p = 0; p < 9; p++) {
        for (int q = 0; q < 9; q++) {
            assert_near(digon[p][q], matrix_row(m, beta, p)[q], 1e-13);
            assert_near(turned[p][q], matrix_row(r, beta, p)[q], 1e-13);
        }
    }
    reference_table_free(gauss);
    reference_table_free(m);
    reference_table_free(r);
    (void)state;
}

static void rotations_are_orthogonal(void **state)
{
    static const int bands[] = {1, 2, 5, 10, 16, 32};
    for (int b = 0; b < 6; b++) {
        char name[32];
        snprintf(name, sizeof name, "sh_rotation_%02d", bands[b]);
        reference_table *t = reference_table_read(name);
        const size_t     n = 2 * (size_t)bands[b] + 1;
        for (size_t i = 0; i < t->rows; i++) {
            for (size_t k = i / n * n; k < i / n * n + n; k++) {
                double sum = 0.0;
                for (size_t j = 0; j < n; j++) {
                    sum += reference_table_values(t, i)[j] * reference_table_values(t, k)[j];
                }
                assert_near(sum, i == k ? 1.0 : 0.0, 2e-15);
            }
        }
        reference_table_free(t);
    }
    (void)state;
}

/* Band 1 is (-y, z, -x): D_ij = s_i R_{axis i, axis j} s_j. */
static void band_one_is_the_rotation(void **state)
{
    static const int axis[] = {1, 2, 0}, sign[] = {-1, 1, -1};
    reference_table *t = reference_table_read("sh_rotation_01");
    for (size_t i = 0; i < t->rows; i++) {
        const double *e  = reference_table_keys(t, i);
        const double  ca = cos(e[0]), sa = sin(e[0]), cb = cos(e[1]), sb = sin(e[1]);
        const double  cg = cos(e[2]), sg = sin(e[2]);
        const double  rotation[3][3] = {{ca * cb * cg - sa * sg, -ca * cb * sg - sa * cg, ca * sb},
                                        {sa * cb * cg + ca * sg, -sa * cb * sg + ca * cg, sa * sb},
                                        {-sb * cg, sb * sg, cb}};
        const int     row            = (int)e[3] + 1;
        for (int j = 0; j < 3; j++) {
            assert_near(reference_table_values(t, i)[j],
                        sign[row] * sign[j] * rotation[axis[row]][axis[j]], 1e-15);
        }
    }
    reference_table_free(t);
    (void)state;
}

static void rules_and_cosine_are_exact(void **state)
{
    reference_table *gauss = reference_table_read("gauss_legendre");
    for (size_t i = 0; i < gauss->rows;) {
        const int n       = (int)reference_table_keys(gauss, i)[0];
        double    weights = 0.0, power = 0.0;
        for (int k = 0; k < n; k++, i++) {
            const double *v = reference_table_values(gauss, i);
            assert_true(fabs(v[1]) <= 0x1p-53 * fabs(v[0]) && fabs(v[3]) <= 0x1p-53 * v[2]);
            assert_true(k == 0 || v[0] > reference_table_values(gauss, i - 1)[0]);
            weights += v[2];
            power += v[2] * pow(v[0], 2 * n - 2);
        }
        assert_near(weights, 2.0, 2e-15);
        assert_near(power * (2 * n - 1) / 2, 1.0, 1e-14);
    }
    reference_table_free(gauss);

    static const double first[] = {PI, 2 * PI / 3, PI / 4, 0, -PI / 24, 0, PI / 64};
    reference_table    *a       = reference_table_read("clamped_cosine");
    double              sum     = 0.0;
    for (size_t l = 0; l < a->rows; l++) {
        const double *v = reference_table_values(a, l);
        if (l < 7) {
            assert_near(v[0], first[l], 4e-16 * fabs(first[l]));
        }
        sum += (2 * (double)l + 1) / (4 * PI) * v[0] * v[0];
    }
    assert_true(sum < 2 * PI / 3); /* of cos^2 over the hemisphere, from below */
    assert_near(sum, 2 * PI / 3, 1e-4);
    reference_table_free(a);
    (void)state;
}

static void accuracies_grow(void **state)
{
    static const char *const names[] = {"accuracy_phong", "accuracy_ward"};
    for (int kind = 0; kind < 2; kind++) {
        reference_table *t = reference_table_read(names[kind]);
        for (size_t i = 0; i < t->rows; i++) {
            const double *v = reference_table_values(t, i);
            for (int k = 0; k < 5; k++) {
                assert_true(v[k] > 0.0 && v[k] <= 1.0);
                assert_true(i % 10 == 0 || v[k] >= reference_table_values(t, i - 1)[k]);
            }
            assert_near(v[0], i % 10 ? v[0] : v[1] / 2, 1e-16); /* the constant, twice as wide */
        }
        reference_table_free(t);
    }
    /* z^5: mean square 1 / 11, mean 1 / 6; in the span of HSH from order 6 */
    reference_table *t = reference_table_read("accuracy_phong");
    assert_near(reference_table_values(t, 0)[5], 2 * PI / 11, 1e-16);
    assert_near(reference_table_values(t, 0)[1], 11.0 / 36, 1e-16);
    assert_true(reference_table_values(t, 4)[1] < 1.0 && reference_table_values(t, 5)[1] == 1.0);
    reference_table_free(t);
    (void)state;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(harmonics_are_their_polynomials),
        cmocka_unit_test(hemispherical_harmonics_are_shifted),
        cmocka_unit_test(other_bases_begin_well),
        cmocka_unit_test(gradients_are_tangential),
        cmocka_unit_test(conversion_is_equation_3_20),
        cmocka_unit_test(digons_are_consistent),
        cmocka_unit_test(rotation_is_equation_3_31),
        cmocka_unit_test(rotations_are_orthogonal),
        cmocka_unit_test(band_one_is_the_rotation),
        cmocka_unit_test(rules_and_cosine_are_exact),
        cmocka_unit_test(accuracies_grow),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
