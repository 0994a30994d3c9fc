/* flip_kernels.c - contrast sensitivity and feature detectors as separable kernels.
 *
 * Invariant: the two-dimensional filters that [andersson20] defines (their sections 4.1.1 and
 * 4.2.1) are outer products of these, or the sum of two such: contrast sensitivity is
 *
 *     sum_i a_i sqrt(pi / b_i) exp(-pi^2 (x^2 + y^2) / b_i),   x, y in degrees,
 *
 * which is separable term by term, and the sign of a derivative of a Gaussian depends on one
 * coordinate alone, so that dividing its positive and negative weights by their sums (to 1 and -1)
 * is the same in one dimension as in two. */
#include "oracle/metrics/flip_kernels.h"

#include "core/numerics.h"

typedef struct {
    double a, b;
} gaussian;

/* [andersson20] table 1. */
static const gaussian LUMINANCE = {1.0, 0.0047}, RED_GREEN = {1.0, 0.0053};
static const gaussian BLUE[2]      = {{34.1, 0.04}, {13.5, 0.025}};
static const double   LARGEST_B    = 0.04;  /* sets the radius of all of them */
static const double   FEATURE_SIZE = 0.082; /* w: degrees from peak to trough */

/* Weights that sum to 1; their sum before that is returned. */
static double normalise(assay_kernel *kernel)
{
    double sum = 0.0;
    for (int k = kernel->radius; k > 0; k--) {
        sum += 2.0 * kernel->weights[k];
    }
    sum += kernel->weights[0];
    for (int k = 0; k <= kernel->radius; k++) {
        kernel->weights[k] /= sum;
    }
    return sum;
}

static double make_spatial(gaussian shape, double pixels_per_degree, assay_kernel *out)
{
    out->radius =
        (int)ceil(3.0 * sqrt(LARGEST_B / (2.0 * ASSAY_PI * ASSAY_PI)) * pixels_per_degree);
    for (int k = 0; k <= out->radius; k++) {
        const double degrees = k / pixels_per_degree;
        out->weights[k]      = assay_exp(-ASSAY_PI * ASSAY_PI * degrees * degrees / shape.b);
    }
    return normalise(out);
}

static void make_blue(double pixels_per_degree, assay_flip_kernels *out)
{
    double volumes[2];
    for (int i = 0; i < 2; i++) {
        const double sum = make_spatial(BLUE[i], pixels_per_degree, &out->blue[i]);
        volumes[i]       = BLUE[i].a * sqrt(ASSAY_PI / BLUE[i].b) * sum * sum;
    }
    out->blue_share[0] = volumes[0] / (volumes[0] + volumes[1]);
    out->blue_share[1] = volumes[1] / (volumes[0] + volumes[1]);
}

/* Divides the positive weights by their sum and the negative ones by minus theirs. */
static void balance(assay_kernel *kernel)
{
    double positive = 0.0, negative = 0.0;
    for (int k = kernel->radius; k >= 0; k--) {
        const double w = kernel->weights[k], twice = k == 0 || kernel->odd ? w : 2.0 * w;
        positive += twice > 0.0 ? twice : 0.0;
        negative -= twice < 0.0 ? twice : 0.0;
    }
    for (int k = 0; k <= kernel->radius; k++) {
        kernel->weights[k] /= kernel->weights[k] < 0.0 ? negative : positive;
    }
}

static void make_features(double pixels_per_degree, assay_flip_kernels *out)
{
    const double deviation = 0.5 * FEATURE_SIZE * pixels_per_degree;
    const int    radius    = (int)ceil(3.0 * deviation);
    out->smooth.radius = out->edge.radius = out->point.radius = radius;
    out->edge.odd                                             = true;
    for (int k = 0; k <= radius; k++) {
        const double squared   = (double)k * k / (deviation * deviation);
        const double g         = assay_exp(-0.5 * squared);
        out->smooth.weights[k] = g;
        out->edge.weights[k]   = k * g;
        out->point.weights[k]  = (squared - 1.0) * g;
    }
    normalise(&out->smooth);
    balance(&out->edge);
    balance(&out->point);
}

void assay_flip_kernels_make(double pixels_per_degree, assay_flip_kernels *kernels_out)
{
    *kernels_out = (assay_flip_kernels){0};
    make_spatial(LUMINANCE, pixels_per_degree, &kernels_out->luminance);
    make_spatial(RED_GREEN, pixels_per_degree, &kernels_out->red_green);
    make_blue(pixels_per_degree, kernels_out);
    make_features(pixels_per_degree, kernels_out);
    kernels_out->radius = kernels_out->luminance.radius > kernels_out->smooth.radius
                              ? kernels_out->luminance.radius
                              : kernels_out->smooth.radius;
}
