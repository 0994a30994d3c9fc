/* Values of the BSDFs against the formulas of their sources, written out once more in long double,
 * straight and without regard to rounding; reciprocity; Fresnel's equations; corner cases. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>

#include "../support/bsdf_cases.h"
#include "../support/near.h"
#include "core/numerics.h"
#include "core/random.h"
#include "math/sampling.h"
#include "trace/fresnel.h"

typedef long double real;

typedef struct {
    real x, y, z;
} vector;

static real   dot(vector a, vector b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static vector combine(real s, vector a, real t, vector b)
{
    return (vector){s * a.x + t * b.x, s * a.y + t * b.y, s * a.z + t * b.z};
}
static vector unit(vector a)
{
    const real l = sqrtl(dot(a, a));
    return (vector){a.x / l, a.y / l, a.z / l};
}
static vector       vector_of(assay_vec3 a) { return (vector){a.x, a.y, a.z}; }
static const real   PI_L = 3.14159265358979323846264338327950288L;
static const vector N    = {0, 0, 1};

/* ---- glTF 2.0, B.3 ---- */

static real gltf_d(vector h, real a)
{
    const real nh = dot(N, h);
    return a * a / (PI_L * powl(nh * nh * (a * a - 1) + 1, 2));
}
static real gltf_g1(vector w, real a)
{
    const real c = fabsl(dot(N, w));
    return 2 * c / (c + sqrtl(a * a + (1 - a * a) * c * c));
}
static real gltf_specular(vector l, vector v, vector h, real a)
{
    return gltf_g1(l, a) * gltf_g1(v, a) * gltf_d(h, a) / (4 * fabsl(dot(N, l)) * fabsl(dot(N, v)));
}
static real schlick(real f0, real vh) { return f0 + (1 - f0) * powl(1 - fabsl(vh), 5); }

/* The red channel; KHR_materials_specular's pseudocode with all three for the maximum. */
static real gltf_reflection(const assay_bsdf *b, vector l, vector v)
{
    const vector h  = unit(combine(1, l, 1, v));
    const real   vh = dot(v, h), a = (real)b->roughness * b->roughness;
    const real   n0       = powl((1 - (real)b->ior) / (1 + (real)b->ior), 2);
    const real   red      = schlick(fminl(n0 * b->specular_color.r, 1), vh);
    const real   green    = schlick(fminl(n0 * b->specular_color.g, 1), vh);
    const real   blue     = schlick(fminl(n0 * b->specular_color.b, 1), vh);
    const real   largest  = fmaxl(red, fmaxl(green, blue));
    const real   specular = a < 1e-4L ? 0 : gltf_specular(l, v, h, a);
    const real   base     = (1 - b->transmission) * b->base_color.r / PI_L;
    const real   dielectric =
        (1 - b->specular_factor * largest) * base + b->specular_factor * red * specular;
    const real metal = schlick(b->base_color.r, vh) * specular;
    return (1 - b->metallic) * dielectric + b->metallic * metal;
}

/* KHR_materials_transmission: H_T from the mirrored light direction. */
static real gltf_transmission(const assay_bsdf *b, vector l, vector v)
{
    const vector mirrored = {l.x, l.y, -l.z};
    const vector h        = unit(combine(1, mirrored, 1, v));
    const real   vh = dot(v, h), a = (real)b->roughness * b->roughness;
    const real   n0  = powl((1 - (real)b->ior) / (1 + (real)b->ior), 2);
    const real color = fmaxl(b->specular_color.r, fmaxl(b->specular_color.g, b->specular_color.b));
    const real largest = schlick(fminl(n0 * color, 1), vh);
    return a < 1e-4L ? 0
                     : (1 - b->metallic) * (1 - b->specular_factor * largest) * b->transmission *
                           b->base_color.r * gltf_specular(mirrored, v, h, a);
}

/* ---- [walter07] eq. 20 to 22 ---- */

static real walter_fresnel(real c, real ni, real nt)
{
    const real g2 = nt * nt / (ni * ni) - 1 + c * c;
    if (g2 <= 0) {
        return 1;
    }
    const real g = sqrtl(g2);
    const real s = (g - c) / (g + c), p = (c * (g + c) - 1) / (c * (g - c) + 1);
    return s * s / 2 * (1 + p * p);
}

/* i carries light, o scatters it, each in its own index; red. Zero where [walter07]'s sides forbid.
 */
static real walter_refraction(const assay_bsdf *b, vector i, vector o, real ni, real no)
{
    const real a = (real)b->roughness * b->roughness;
    vector     h = unit(combine(-ni, i, -no, o));
    if (h.z < 0) {
        h = combine(-1, h, 0, h);
    }
    const real ih = dot(i, h), oh = dot(o, h);
    if (ih * i.z <= 0 || oh * o.z <= 0) {
        return 0;
    }
    const real f = walter_fresnel(fabsl(oh), no, ni);
    return b->base_color.r * fabsl(ih * oh / (i.z * o.z)) * no * no * (1 - f) * gltf_g1(i, a) *
           gltf_g1(o, a) * gltf_d(h, a) / powl(ni * ih + no * oh, 2);
}

/* ---- the others ---- */

static real phong(const assay_bsdf *b, vector l, vector v)
{
    const real c = dot((vector){-v.x, -v.y, v.z}, l);
    const real n = b->exponent;
    return b->base_color.r / PI_L +
           (c > 0 ? b->specular_color.r * (n + 2) / (2 * PI_L) * powl(c, n) : 0);
}

static real ward(const assay_bsdf *b, vector l, vector v)
{
    const vector h = combine(1, l, 1, v), u = unit(h);
    const real   tan2 = (1 - u.z * u.z) / (u.z * u.z);
    const real   cos2 = u.x * u.x / fmaxl(u.x * u.x + u.y * u.y, 1e-300L);
    const real   e    = expl(-tan2 * (cos2 / ((real)b->alpha_x * b->alpha_x) +
                                 (1 - cos2) / ((real)b->alpha_y * b->alpha_y))) /
                   (PI_L * b->alpha_x * b->alpha_y);
    const real lobe =
        b->model == ASSAY_BSDF_WARD ? e * dot(h, h) / powl(h.z, 4) : e / (4 * sqrtl(l.z * v.z));
    return b->base_color.r / PI_L + b->specular_color.r * lobe;
}

/* What the sources say of f(wo, wi); wo above the surface unless the solid has an inside. */
static real formula(const assay_bsdf *b, vector o, vector i)
{
    const bool through = o.z * i.z < 0;
    switch (b->model) {
    case ASSAY_BSDF_LAMBERT: return through ? 0 : b->base_color.r / PI_L;
    case ASSAY_BSDF_PHONG: return through ? 0 : phong(b, i, o);
    case ASSAY_BSDF_WARD:
    case ASSAY_BSDF_WARD_PUBLISHED: return through ? 0 : ward(b, i, o);
    case ASSAY_BSDF_METALLIC_ROUGHNESS: break;
    case ASSAY_BSDF_BLACK: return 0;
    }
    if (!b->solid) {
        return through ? gltf_transmission(b, i, o) : gltf_reflection(b, i, o);
    }
    const real no = o.z > 0 ? 1 : (real)b->ior, ni = i.z > 0 ? 1 : (real)b->ior;
    if (through) {
        return walter_refraction(b, i, o, ni, no);
    }
    const vector h = unit(combine(1, i, 1, o));
    const real   a = (real)b->roughness * b->roughness;
    return walter_fresnel(fabsl(dot(o, h)), no, o.z > 0 ? (real)b->ior : 1) *
           gltf_specular(i, o, h, a);
}

/* Cases that the formulas above cover: solids only as clear glass with the default factors. */
static bool covered(const assay_bsdf *b)
{
    return !b->solid || (b->roughness > 0.0 && b->metallic == 0.0 && b->transmission == 1.0 &&
                         b->specular_factor == 1.0 && b->ior > 1.0);
}

static void random_pair(uint32_t k, uint64_t item, assay_vec3 *wo, assay_vec3 *wi)
{
    assay_random random = assay_random_start(6, ASSAY_STAGE_TEST, item, k);
    double       u[4];
    for (int i = 0; i < 4; i++) {
        u[i] = assay_random_next(&random);
    }
    *wo = assay_sample_sphere(u[0], u[1]);
    *wi = assay_sample_sphere(u[2], u[3]);
    /* Every other pair is near the mirror direction, where narrow lobes live. */
    if (k % 2) {
        *wi   = vec3_normalize(vec3(-wo->x + 0.05 * wi->x, -wo->y + 0.05 * wi->y, wo->z));
        wi->z = k % 4 == 1 ? wi->z : -wi->z;
    }
}

static bool matches(const assay_bsdf *b, assay_vec3 wo, assay_vec3 wi, double value)
{
    const bool mirror = wo.z < 0.0 && !bsdf_has_inside(b);
    const real f      = formula(b, vector_of(mirror ? vec3(wo.x, wo.y, -wo.z) : wo),
                                vector_of(mirror ? vec3(wi.x, wi.y, -wi.z) : wi));
    /* Near the critical angle 1 - F has lost its digits: hence the absolute part. */
    const double expected = (double)f * fabs(wi.z);
    return fabs(value - expected) <= 1e-10 * fabs(expected) + 1e-13;
}

static void test_formulas(void **state)
{
    (void)state;
    for (int c = 0; c < bsdf_case_count(); c++) {
        const bsdf_case k       = bsdf_case_at(c);
        int             mutants = 0, lit = 0;
        for (uint32_t i = 0; covered(&k.bsdf) && i < 4000; i++) {
            assay_vec3 wo, wi;
            random_pair(i, 0, &wo, &wi);
            const double value = assay_bsdf_evaluate(&k.bsdf, wo, wi).value.r;
            if (!matches(&k.bsdf, wo, wi, value)) {
                fail_msg("%s: wo (%g %g %g) wi (%g %g %g): %.17g", k.name, wo.x, wo.y, wo.z, wi.x,
                         wi.y, wi.z, value);
            }
            /* A value that is off by a hundred millionth is seen. */
            lit += value > 1e-3;
            mutants += value > 1e-3 && !matches(&k.bsdf, wo, wi, value * (1.0 + 1e-8));
        }
        assert_int_equal(mutants, lit);
        assert_true(lit > 0 || !covered(&k.bsdf) || bsdf_is_specular(&k.bsdf));
    }
}

/* ---- reciprocity ---- */

/* f(wo, wi) / n(wo)^2, which is symmetric, [veach97] section 5.2. */
static double symmetric_form(const assay_bsdf *b, assay_vec3 wo, assay_vec3 wi, bool fresnel_of_wo)
{
    const double n = bsdf_has_inside(b) && wo.z < 0.0 ? b->ior : 1.0;
    const double f = assay_bsdf_evaluate(b, wo, wi).value.r / fabs(wi.z) / (n * n);
    return fresnel_of_wo ? f * (1.0 - assay_schlick(fabs(wo.z))) : f;
}

static bool symmetric(double a, double b)
{
    return fabs(a - b) <= 1e-9 * fmax(fabs(a), fabs(b)) + 1e-12;
}

static void test_reciprocity(void **state)
{
    (void)state;
    for (int c = 0; c < bsdf_case_count(); c++) {
        const bsdf_case k      = bsdf_case_at(c);
        int             caught = 0, lit = 0;
        for (uint32_t i = 0; i < 4000; i++) {
            assay_vec3 wo, wi;
            random_pair(i, 1, &wo, &wi);
            /* Beyond the reach of a two-sided model's mirroring there is nothing to exchange. */
            const double a = symmetric_form(&k.bsdf, wo, wi, false);
            const double b = symmetric_form(&k.bsdf, wi, wo, false);
            if (!symmetric(a, b)) {
                fail_msg("%s: wo (%g %g %g) wi (%g %g %g): %.17g against %.17g", k.name, wo.x, wo.y,
                         wo.z, wi.x, wi.y, wi.z, a, b);
            }
            lit += a > 1e-6;
            caught += a > 1e-6 && !symmetric(symmetric_form(&k.bsdf, wo, wi, true),
                                             symmetric_form(&k.bsdf, wi, wo, true));
        }
        /* A Fresnel term of the angle to the surface, not to the microfacet, is seen. */
        assert_true(caught > lit / 2 || lit == 0);
    }
}

/* ---- Fresnel ---- */

static void test_fresnel(void **state)
{
    (void)state;
    static const double indices[] = {1.1, 1.33, 1.5, 2.42, 4.0};
    for (int i = 0; i < 5; i++) {
        const double n = indices[i], r = (n - 1.0) / (n + 1.0);
        assert_near(assay_fresnel_dielectric(1.0, n), r * r, 1e-16);
        assert_near(assay_fresnel_dielectric(1.0, 1.0 / n), r * r, 1e-16);
        assert_near(assay_normal_reflectance(n), r * r, 1e-16);
        assert_near(assay_fresnel_dielectric(0.0, n), 1.0, 0.0);
        /* Brewster's angle, tan = n: no parallel light, and sin^2(i - t) of the other with t the
         * complement of i, so half of cos^2(2 i) = ((n^2 - 1) / (n^2 + 1))^2. */
        const double b = (n * n - 1.0) / (n * n + 1.0);
        assert_near(assay_fresnel_dielectric(1.0 / sqrt(1.0 + n * n), n), 0.5 * b * b, 1e-15);
        /* The critical angle from inside: sin = 1 / n. */
        const double critical = sqrt(1.0 - 1.0 / (n * n));
        assert_near(assay_fresnel_dielectric(critical - 1e-9, 1.0 / n), 1.0, 0.0);
        assert_true(assay_fresnel_dielectric(critical + 1e-9, 1.0 / n) < 1.0);
        for (double c = 0.005; c < 1.0; c += 0.01) {
            assert_near(assay_fresnel_dielectric(c, n), (double)walter_fresnel(c, 1, n), 1e-14);
            /* The same interface from the other side, along the refracted ray. */
            const double t = assay_refracted_cosine(c, n);
            assert_near(assay_fresnel_dielectric(t, 1.0 / n), assay_fresnel_dielectric(c, n),
                        1e-11);
            const assay_vec3 wo = vec3(sqrt(1.0 - c * c), 0.0, c);
            const assay_vec3 w  = assay_refract(wo, vec3(0.0, 0.0, 1.0), c, t, n);
            assert_near(w.x, -wo.x / n, 1e-15);
            assert_near(w.z, -t, 1e-15);
        }
    }
    assert_near(assay_schlick(0.0), 1.0, 0.0);
    assert_near(assay_schlick(0.5), 0x1p-5, 0.0);
    assert_near(assay_schlick(1.0 + 1e-15), 0.0, 0.0);
}

/* Under total reflection everything comes back, whatever KHR_materials_specular says. */
static void test_total_reflection(void **state)
{
    (void)state;
    assay_bsdf glass      = assay_bsdf_default(ASSAY_BSDF_METALLIC_ROUGHNESS);
    glass.metallic        = 0.0;
    glass.roughness       = 0.0;
    glass.transmission    = 1.0;
    glass.solid           = true;
    glass.specular_factor = 0.2;
    assay_bsdf_sample s;
    for (double u = 0.0; u < 1.0; u += 0.01) {
        assert_true(assay_bsdf_sample_direction(&glass, vec3(0.8, 0.0, -0.6), u, 0.1, 0.2, &s));
        assert_true(s.specular && !s.transmitted);
        assert_near(s.weight.g * s.pdf, 1.0, 1e-15);
        assert_near(s.wi.x, -0.8, 1e-15);
        assert_near(s.wi.z, -0.6, 1e-15);
    }
}

/* ---- corner cases ---- */

static const double ENDS[] = {0.0, 1e-300, 0.5, 1.0 - 0x1p-53};

static void check_finite(const assay_bsdf *b, assay_vec3 wo, assay_vec3 wi)
{
    const assay_bsdf_value f = assay_bsdf_evaluate(b, wo, wi);
    assert_true(rgb_finite(f.value) && isfinite(f.pdf) && f.pdf >= 0.0);
    assert_true(f.value.r >= 0.0 && f.value.g >= 0.0 && f.value.b >= 0.0);
    for (int i = 0; i < 64; i++) {
        assay_bsdf_sample s;
        if (assay_bsdf_sample_direction(b, wo, ENDS[i % 4], ENDS[i / 4 % 4], ENDS[i / 16], &s)) {
            assert_true(rgb_finite(s.weight) && isfinite(s.pdf) && s.pdf > 0.0);
            assert_true(vec3_finite(s.wi) && fabs(vec3_length(s.wi) - 1.0) < 1e-14);
            assert_true(wo.z != 0.0 && s.wi.z != 0.0);
        }
    }
}

static void test_corners(void **state)
{
    (void)state;
    static const double heights[] = {0.0, 5e-324, 1e-160, 1e-20, 1e-13, 1e-12, 2e-12, 1e-9, 1e-4};
    for (int c = 0; c < bsdf_case_count(); c++) {
        const assay_bsdf b = bsdf_case_at(c).bsdf;
        for (int i = 0; i < 18; i++) {
            const double     z  = i < 9 ? heights[i] : -heights[i - 9];
            const assay_vec3 wo = vec3(sqrt(1.0 - z * z), 0.0, z);
            check_finite(&b, wo, wo);
            check_finite(&b, wo, vec3_negate(wo));
            check_finite(&b, wo, vec3(-wo.x, 0.0, z));
            check_finite(&b, wo, vec3(wo.x, 0.0, -z));
            check_finite(&b, wo, vec3(0.0, 1.0, z));
            check_finite(&b, wo, vec3(0.0, 0.0, 1.0));
            check_finite(&b, wo, vec3(0.0, 0.0, -1.0));
            check_finite(&b, vec3(0.0, 0.0, i < 9 ? 1.0 : -1.0), wo);
        }
        check_finite(&b, vec3(0.0, 0.0, -0.0), vec3(0.0, 0.0, 1.0));
    }
}

static void test_extreme_parameters(void **state)
{
    (void)state;
    static const double widths[]    = {0.0, 1e-300, 1e-4, 0.0099999, 0.01, 1.0};
    static const double indices[]   = {0.0, 1.0, 1.0 + 1e-9, 1.00011, 3.0, 1e6};
    static const double exponents[] = {0.0, 1e-3, 1e4, 1e12};
    for (int c = 0; c < bsdf_case_count(); c++) {
        for (int i = 0; i < 36 * 4; i++) {
            assay_bsdf b = bsdf_case_at(c).bsdf;
            b.roughness = b.alpha_x = widths[i % 6];
            b.alpha_y               = widths[(i + 3) % 6];
            b.ior                   = indices[i / 6 % 6];
            b.exponent              = exponents[i / 36];
            if (i % 7 == 0) {
                b.base_color = rgb_grey(0.0);
            }
            if (i % 11 == 0) {
                b.specular_factor = 0.0;
                b.specular_color  = rgb_grey(0.0);
            }
            for (int d = 0; d < bsdf_direction_count(); d++) {
                const assay_vec3 wo = bsdf_direction_at(d);
                check_finite(&b, wo, vec3(-wo.x, -wo.y, wo.z));
                check_finite(&b, vec3(wo.x, wo.y, -wo.z), vec3(-wo.x, -wo.y, wo.z));
            }
        }
    }
}

/* Whatever scatters can be drawn, in all mixtures of lobes: a value > 0 has a density > 0. */
static void test_support(void **state)
{
    (void)state;
    for (int c = 0; c < bsdf_case_count(); c++) {
        for (int variant = 0; variant < 32; variant++) {
            assay_bsdf b      = bsdf_case_at(c).bsdf;
            b.base_color      = variant & 1 ? rgb_grey(0.0) : b.base_color;
            b.specular_factor = variant & 2 ? 0.0 : b.specular_factor;
            b.ior             = variant & 4 ? 1.0 : b.ior;
            b.solid           = variant & 8 ? true : b.solid;
            if (variant & 16) {
                b.ior          = 1.05;
                b.transmission = 0.0;
            }
            for (uint32_t i = 0; i < 400; i++) {
                assay_vec3 wo, wi;
                random_pair(i, 3, &wo, &wi);
                const assay_bsdf_value normal = assay_bsdf_evaluate(&b, vec3(0.0, 0.0, 1.0), wi);
                const assay_bsdf_value any    = assay_bsdf_evaluate(&b, wo, wi);
                assert_true(rgb_is_black(any.value) || any.pdf > 0.0);
                assert_true(rgb_is_black(normal.value) || normal.pdf > 0.0);
            }
        }
    }
}

/* ---- the small functions ---- */

static void test_is_specular(void **state)
{
    (void)state;
    for (int c = 0; c < bsdf_case_count(); c++) {
        const bsdf_case k   = bsdf_case_at(c);
        double          sum = 0.0;
        for (uint32_t i = 0; i < 400; i++) {
            assay_vec3 wo, wi;
            random_pair(i, 2, &wo, &wi);
            sum += assay_bsdf_evaluate(&k.bsdf, wo, wi).pdf;
        }
        assert_int_equal(bsdf_is_specular(&k.bsdf), sum == 0.0);
    }
    assay_bsdf b = assay_bsdf_default(ASSAY_BSDF_BLACK);
    assert_true(bsdf_is_specular(&b));
    assay_bsdf_sample s;
    assert_false(assay_bsdf_sample_direction(&b, vec3(0.0, 0.0, 1.0), 0.5, 0.5, 0.5, &s));
    b            = assay_bsdf_default(ASSAY_BSDF_LAMBERT);
    b.base_color = rgb_grey(0.0);
    assert_true(bsdf_is_specular(&b));
    assert_false(assay_bsdf_sample_direction(&b, vec3(0.0, 0.0, 1.0), 0.5, 0.5, 0.5, &s));
}

static void test_albedo(void **state)
{
    (void)state;
    assay_bsdf b     = assay_bsdf_default(ASSAY_BSDF_WARD);
    b.base_color     = rgb(0.1, 0.2, 0.3);
    b.specular_color = rgb(0.5, 0.25, 0.125);
    assert_near(assay_bsdf_albedo(&b).r, 0.6, 1e-16);
    assert_near(assay_bsdf_albedo(&b).b, 0.425, 1e-16);
    b.model = ASSAY_BSDF_METALLIC_ROUGHNESS;
    assert_near(assay_bsdf_albedo(&b).g, 0.2, 0.0);
    b.model = ASSAY_BSDF_BLACK; /* unlit */
    assert_near(assay_bsdf_albedo(&b).g, 0.2, 0.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_formulas), cmocka_unit_test(test_reciprocity),
        cmocka_unit_test(test_fresnel),  cmocka_unit_test(test_total_reflection),
        cmocka_unit_test(test_corners),  cmocka_unit_test(test_extreme_parameters),
        cmocka_unit_test(test_support),  cmocka_unit_test(test_is_specular),
        cmocka_unit_test(test_albedo),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
