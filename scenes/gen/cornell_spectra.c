/* cornell_spectra.c - spectra to colours.
 *
 * Reflectances (every 4 nm from 400 nm to 700 nm) and the lamp (every 100 nm) are the measurements
 * of Cornell University's Program of Computer Graphics [cornellbox], the observer is CIE 1931 (2
 * degrees), the illuminant CIE D65, both every 5 nm [cie15].  Between two measurements, reflectance
 * and emission are taken as linear.  Sums, products and quotients only: the same colours
 * everywhere.
 *
 * The observer's tails below 400 nm and above 700 nm are left out; the scaling by a perfect
 * diffuser (or by a constant spectrum) leaves them out above and below the line alike. */
#include "cornell_spectra.h"

#include <math.h>

#define PAINT_SAMPLES 76
#define OBSERVER_SAMPLES 61

/* By cornell_paint, then by wavelength. */
static const double paints[3][PAINT_SAMPLES] = {
    {/* white */
     0.343, 0.445, 0.551, 0.624, 0.665, 0.687, 0.708, 0.723, 0.715, 0.710, 0.745, 0.758, 0.739,
     0.767, 0.777, 0.765, 0.751, 0.745, 0.748, 0.729, 0.745, 0.757, 0.753, 0.750, 0.746, 0.747,
     0.735, 0.732, 0.739, 0.734, 0.725, 0.721, 0.733, 0.725, 0.732, 0.743, 0.744, 0.748, 0.728,
     0.716, 0.733, 0.726, 0.713, 0.740, 0.754, 0.764, 0.752, 0.736, 0.734, 0.741, 0.740, 0.732,
     0.745, 0.755, 0.751, 0.744, 0.731, 0.733, 0.744, 0.731, 0.712, 0.708, 0.729, 0.730, 0.727,
     0.707, 0.703, 0.729, 0.750, 0.760, 0.751, 0.739, 0.724, 0.730, 0.740, 0.737},
    {/* green */
     0.092, 0.096, 0.098, 0.097, 0.098, 0.095, 0.095, 0.097, 0.095, 0.094, 0.097, 0.098, 0.096,
     0.101, 0.103, 0.104, 0.107, 0.109, 0.112, 0.115, 0.125, 0.140, 0.160, 0.187, 0.229, 0.285,
     0.343, 0.390, 0.435, 0.464, 0.472, 0.476, 0.481, 0.462, 0.447, 0.441, 0.426, 0.406, 0.373,
     0.347, 0.337, 0.314, 0.285, 0.277, 0.266, 0.250, 0.230, 0.207, 0.186, 0.171, 0.160, 0.148,
     0.141, 0.136, 0.130, 0.126, 0.123, 0.121, 0.122, 0.119, 0.114, 0.115, 0.117, 0.117, 0.118,
     0.120, 0.122, 0.128, 0.132, 0.139, 0.144, 0.146, 0.150, 0.152, 0.157, 0.159},
    {/* red */
     0.040, 0.046, 0.048, 0.053, 0.049, 0.050, 0.053, 0.055, 0.057, 0.056, 0.059, 0.057, 0.061,
     0.061, 0.060, 0.062, 0.062, 0.062, 0.061, 0.062, 0.060, 0.059, 0.057, 0.058, 0.058, 0.058,
     0.056, 0.055, 0.056, 0.059, 0.057, 0.055, 0.059, 0.059, 0.058, 0.059, 0.061, 0.061, 0.063,
     0.063, 0.067, 0.068, 0.072, 0.080, 0.090, 0.099, 0.124, 0.154, 0.192, 0.255, 0.287, 0.349,
     0.402, 0.443, 0.487, 0.513, 0.558, 0.584, 0.620, 0.606, 0.609, 0.651, 0.612, 0.610, 0.650,
     0.638, 0.627, 0.620, 0.630, 0.628, 0.642, 0.639, 0.657, 0.639, 0.635, 0.642}};

/* At 400, 500, 600, 700 nm. */
static const double lamp[4] = {0.0, 8.0, 15.6, 18.4};

/* xbar, ybar, zbar, D65 */
static const double observer[OBSERVER_SAMPLES][4] = {
    {0.01431, 0.000396, 0.06785, 82.7549}, {0.02319, 0.00064, 0.1102, 87.1204},
    {0.04351, 0.00121, 0.2074, 91.486},    {0.07763, 0.00218, 0.3713, 92.4589},
    {0.13438, 0.004, 0.6456, 93.4318},     {0.21477, 0.0073, 1.03905, 90.057},
    {0.2839, 0.0116, 1.3856, 86.6823},     {0.3285, 0.01684, 1.62296, 95.7736},
    {0.34828, 0.023, 1.74706, 104.865},    {0.34806, 0.0298, 1.7826, 110.936},
    {0.3362, 0.038, 1.77211, 117.008},     {0.3187, 0.048, 1.7441, 117.41},
    {0.2908, 0.06, 1.6692, 117.812},       {0.2511, 0.0739, 1.5281, 116.336},
    {0.19536, 0.09098, 1.28764, 114.861},  {0.1421, 0.1126, 1.0419, 115.392},
    {0.09564, 0.13902, 0.81295, 115.923},  {0.05795, 0.1693, 0.6162, 112.367},
    {0.03201, 0.20802, 0.46518, 108.811},  {0.0147, 0.2586, 0.3533, 109.082},
    {0.0049, 0.323, 0.272, 109.354},       {0.0024, 0.4073, 0.2123, 108.578},
    {0.0093, 0.503, 0.1582, 107.802},      {0.0291, 0.6082, 0.1117, 106.296},
    {0.06327, 0.71, 0.07825, 104.79},      {0.1096, 0.7932, 0.05725, 106.239},
    {0.1655, 0.862, 0.04216, 107.689},     {0.22575, 0.91485, 0.02984, 106.047},
    {0.2904, 0.954, 0.0203, 104.405},      {0.3597, 0.9803, 0.0134, 104.225},
    {0.43345, 0.99495, 0.00875, 104.046},  {0.51205, 1, 0.00575, 102.023},
    {0.5945, 0.995, 0.0039, 100},          {0.6784, 0.9786, 0.00275, 98.1671},
    {0.7621, 0.952, 0.0021, 96.3342},      {0.8425, 0.9154, 0.0018, 96.0611},
    {0.9163, 0.87, 0.00165, 95.788},       {0.9786, 0.8163, 0.0014, 92.2368},
    {1.0263, 0.757, 0.0011, 88.6856},      {1.0567, 0.6949, 0.001, 89.3459},
    {1.0622, 0.631, 0.0008, 90.0062},      {1.0456, 0.5668, 0.0006, 89.8026},
    {1.0026, 0.503, 0.00034, 89.5991},     {0.9384, 0.4412, 0.00024, 88.6489},
    {0.85445, 0.381, 0.00019, 87.6987},    {0.7514, 0.321, 0.0001, 85.4936},
    {0.6424, 0.265, 0.00005, 83.2886},     {0.5419, 0.217, 0.00003, 83.4939},
    {0.4479, 0.175, 0.00002, 83.6992},     {0.3608, 0.1382, 0.00001, 81.863},
    {0.2835, 0.107, 0, 80.0268},           {0.2187, 0.0816, 0, 80.1207},
    {0.1649, 0.061, 0, 80.2146},           {0.1212, 0.04458, 0, 81.2462},
    {0.0874, 0.032, 0, 82.2778},           {0.0636, 0.0232, 0, 80.281},
    {0.04677, 0.017, 0, 78.2842},          {0.0329, 0.01192, 0, 74.0027},
    {0.0227, 0.00821, 0, 69.7213},         {0.01584, 0.005723, 0, 70.6652},
    {0.011359, 0.004102, 0, 71.6091}};

/* XYZ to linear RGB with the primaries and the white point of ITU-R BT.709-6. */
static const double rec709[3][3] = {{3.2404542, -1.5371385, -0.4985314},
                                    {-0.9692660, 1.8760108, 0.0415560},
                                    {0.0556434, -0.2040259, 1.0572252}};

/* A table of samples `step` nm apart, from 400 nm on. */
static double sample(const double *table, int count, double step, double nm)
{
    const double at    = (nm - 400.0) / step;
    const int    below = at < count - 1 ? (int)at : count - 2;
    const double t     = at - below;
    return (1.0 - t) * table[below] + t * table[below + 1];
}

/* Weights the observer by a spectrum; rgb_out is not scaled, *luminance_out is the integral of ybar
 * times the spectrum (5 nm steps, trapezoidal rule). */
static void integrate(const double spectrum[OBSERVER_SAMPLES], double rgb_out[3],
                      double *luminance_out)
{
    double xyz[3] = {0.0, 0.0, 0.0};
    for (int i = 0; i < OBSERVER_SAMPLES; i++) {
        const double weight = i == 0 || i == OBSERVER_SAMPLES - 1 ? 0.5 : 1.0;
        for (int c = 0; c < 3; c++) {
            xyz[c] += weight * spectrum[i] * observer[i][c];
        }
    }
    for (int c = 0; c < 3; c++) {
        rgb_out[c] = rec709[c][0] * xyz[0] + rec709[c][1] * xyz[1] + rec709[c][2] * xyz[2];
    }
    *luminance_out = xyz[1];
}

static double rounded(double value) { return floor(1e4 * value + 0.5) / 1e4; }

void cornell_reflectance(cornell_paint paint, double rgb_out[3])
{
    double reflected[OBSERVER_SAMPLES], incident[OBSERVER_SAMPLES], rgb[3], white[3], luminance;
    for (int i = 0; i < OBSERVER_SAMPLES; i++) {
        incident[i]  = observer[i][3];
        reflected[i] = incident[i] * sample(paints[paint], PAINT_SAMPLES, 4.0, 400.0 + 5.0 * i);
    }
    integrate(reflected, rgb, &luminance);
    integrate(incident, white, &luminance);
    for (int c = 0; c < 3; c++) {
        rgb_out[c] = rounded(rgb[c] / white[c]);
    }
}

void cornell_radiance(double rgb_out[3])
{
    double emitted[OBSERVER_SAMPLES], constant[OBSERVER_SAMPLES], rgb[3], unused[3];
    double luminance, constant_luminance;
    for (int i = 0; i < OBSERVER_SAMPLES; i++) {
        constant[i] = 1.0;
        emitted[i]  = sample(lamp, 4, 100.0, 400.0 + 5.0 * i);
    }
    integrate(emitted, rgb, &luminance);
    integrate(constant, unused, &constant_luminance);
    for (int c = 0; c < 3; c++) {
        rgb_out[c] = rounded(rgb[c] / constant_luminance);
    }
}
