/* harmonics_body.h - spherical and hemispherical harmonics in the arithmetic of REAL; included by
 * harmonics.c for floats and by tables.c for the constants of its tables.
 *
 * [gautron06] eq. 3.7 and 3.18, with the (-1)^m of eq. 3.5, index l^2 + l + m: associated Legendre
 * functions of t = z, or t = 2 z - 1, by their normalised recurrence in l, less the power of the
 * sine, which goes with the azimuth: (sx + i sy)^m. */

/* sqrt(2 - [m = 0]) N_m of the recurrence's first function. */
static REAL NAME(first)(int m)
{
    REAL squared = (REAL)0.0795774715459476678844L * (REAL)(2 * m + 1); /* 1 / 4 pi */
    for (int k = 1; k <= m; k++) {
        squared *= (REAL)(2 * k - 1) / (REAL)(2 * k);
    }
    return ROOT(m > 0 || IS_PLANTED(ZONAL_NORM) ? squared + squared : squared);
}

static void NAME(column)(int order, int m, REAL t, REAL cosine, REAL sine, REAL size, REAL *out)
{
    REAL before = 0, value = NAME(first)(m) * size;
    for (int l = m; l < order; l++) {
        out[l * l + l + m] = value * cosine;
        if (m > 0) {
            out[l * l + l - m] = IS_PLANTED(SIGN_OF_SINES) ? -value * sine : value * sine;
        }
        const REAL n = (REAL)(l + 1), k = (REAL)m;
        const REAL a    = ROOT((4 * n * n - 1) / (n * n - k * k));
        const REAL b    = ROOT((REAL)(l * l - m * m) / (REAL)(4 * l * l - 1 + 2 * (l == 0)));
        const REAL next = a * (t * value - b * before);
        before          = value;
        value           = next;
    }
}

/* order^2 numbers. */
static void NAME(evaluate)(int order, bool hemisphere, const REAL d[3], REAL *out)
{
    const bool shifted = hemisphere && !IS_PLANTED(HEMISPHERE_NOT_SHIFTED);
    const REAL t       = shifted ? d[2] + d[2] - 1 : d[2];
    const REAL stretch = shifted ? ROOT(4 * d[2] / (1 + d[2])) : 1;
    const REAL x = stretch * d[0], y = stretch * d[1];
    const REAL size   = hemisphere ? (REAL)1.41421356237309504880L : 1;
    const REAL sign   = IS_PLANTED(CONDON_SHORTLEY) ? 1 : -1;
    REAL       cosine = 1, sine = 0;
    for (int m = 0; m < order; m++) {
        NAME(column)(order, m, t, cosine, sine, size, out);
        const REAL turned = sign * (cosine * x - sine * y);
        sine              = sign * (cosine * y + sine * x);
        cosine            = turned;
    }
}
