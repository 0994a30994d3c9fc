/* texture.c - a value at a texture coordinate.
 *
 * Texel i of n covers [i/n, (i+1)/n): its centre lies at (i + 1/2)/n, as in OpenGL.  Whatever the
 * coordinate (NaN, 1e30), the indices are inside the image: coordinates are brought to [0, 1]
 * before anything is turned into a whole number.  A constant image gives its constant exactly,
 * since the filter adds weighted differences. */
#include <math.h>

#include "core/numerics.h"
#include "scene/scene_data.h"
#include "scene/texture.h"

void assay_texture_ref_prepare(assay_texture_ref *ref)
{
    /* KHR_texture_transform turns counter-clockwise as seen with v downwards, which makes the
     * matrix the transpose of the extension's GLSL listing; its text, its test model and all known
     * implementations agree on this (KhronosGroup/glTF issue 1563). */
    const assay_sincos turn = assay_sincos_radians(ref->rotation);
    ref->uv_matrix[0][0]    = turn.cos * ref->scale[0];
    ref->uv_matrix[0][1]    = turn.sin * ref->scale[1];
    ref->uv_matrix[0][2]    = ref->offset[0];
    ref->uv_matrix[1][0]    = -turn.sin * ref->scale[0];
    ref->uv_matrix[1][1]    = turn.cos * ref->scale[1];
    ref->uv_matrix[1][2]    = ref->offset[1];
}

static inline double finite_or_zero(double x) { return isfinite(x) ? x : 0.0; }

/* To [0, 1]; the ends belong to the outermost texels. */
static inline double wrap_coordinate(double t, assay_wrap wrap)
{
    switch (wrap) {
    case ASSAY_WRAP_CLAMP: return t < 0.0 ? 0.0 : t > 1.0 ? 1.0 : t;
    case ASSAY_WRAP_MIRROR: {
        const double folded = t - 2.0 * assay_floor(0.5 * t);
        return folded > 1.0 ? 2.0 - folded : folded;
    }
    case ASSAY_WRAP_REPEAT: break;
    }
    return t - assay_floor(t);
}

static inline uint32_t nearest_texel(double t, uint32_t size)
{
    const uint32_t i = (uint32_t)(t * size);
    return i < size ? i : size - 1;
}

/* The two texels whose centres enclose t, and where it lies between them. */
typedef struct {
    uint32_t low, high;
    double   fraction; /* [0, 1) */
} texel_pair;

static inline texel_pair enclosing_texels(double t, uint32_t size, assay_wrap wrap)
{
    const double   x       = t * size - 0.5;
    const double   below   = assay_floor(x);
    const int32_t  low     = (int32_t)below;
    const bool     repeats = wrap == ASSAY_WRAP_REPEAT;
    const uint32_t last    = size - 1;
    texel_pair     pair    = {.fraction = x - below};
    pair.low               = low < 0 ? (repeats ? last : 0) : (uint32_t)low;
    pair.high = (uint32_t)(low + 1) > last ? (repeats ? 0 : last) : (uint32_t)(low + 1);
    return pair;
}

static inline void load_texel(const assay_texture_image *image, uint32_t x, uint32_t y, bool srgb,
                              double rgba_out[4])
{
    const size_t at = assay_texel_offset(image, x, y);
    if (image->bits == 8) {
        const uint8_t *texel = (const uint8_t *)image->texels + at;
        for (int c = 0; c < 3; c++) {
            rgba_out[c] = srgb ? assay_srgb_decode8(texel[c]) : texel[c] / 255.0;
        }
        rgba_out[3] = texel[3] == 255 ? 1.0 : texel[3] / 255.0;
    } else {
        const uint16_t *texel = (const uint16_t *)image->texels + at;
        for (int c = 0; c < 4; c++) {
            rgba_out[c] = srgb && c < 3 ? assay_srgb_decode16(texel[c]) : texel[c] / 65535.0;
        }
    }
}

static inline double mix(double a, double b, double t) { return a + t * (b - a); }

/* Where uv lies in the texture, both coordinates wrapped to [0, 1]. */
typedef struct {
    double s, t;
} texture_point;

static inline texture_point texture_point_at(const assay_texture     *texture,
                                             const assay_texture_ref *ref, const double uv[2])
{
    const double u = finite_or_zero(uv[0]), v = finite_or_zero(uv[1]);
    const double(*m)[3] = ref->uv_matrix;
    return (texture_point){
        wrap_coordinate(finite_or_zero(m[0][0] * u + m[0][1] * v + m[0][2]), texture->wrap_u),
        wrap_coordinate(finite_or_zero(m[1][0] * u + m[1][1] * v + m[1][2]), texture->wrap_v)};
}

void assay_texture_prefetch(const assay_scene *scene, const assay_texture_ref *ref,
                            const double uv[2])
{
    const assay_texture       *texture = &scene->textures[ref->texture];
    const assay_texture_image *image   = &scene->images[texture->image];
    const texture_point        p       = texture_point_at(texture, ref, uv);
    const size_t               at      = assay_texel_offset(image, nearest_texel(p.s, image->width),
                                                            nearest_texel(p.t, image->height));
    __builtin_prefetch((const char *)image->texels + at * (image->bits / 8));
}

void assay_texture_sample(const assay_scene *scene, const assay_texture_ref *ref,
                          const double uv[2], bool srgb, double rgba_out[4])
{
    if (ref->texture == ASSAY_NONE) {
        rgba_out[0] = rgba_out[1] = rgba_out[2] = rgba_out[3] = 1.0;
        return;
    }
    const assay_texture       *texture = &scene->textures[ref->texture];
    const assay_texture_image *image   = &scene->images[texture->image];
    const texture_point        p       = texture_point_at(texture, ref, uv);
    if (texture->nearest) {
        load_texel(image, nearest_texel(p.s, image->width), nearest_texel(p.t, image->height), srgb,
                   rgba_out);
        return;
    }
    const texel_pair x = enclosing_texels(p.s, image->width, texture->wrap_u);
    const texel_pair y = enclosing_texels(p.t, image->height, texture->wrap_v);
    double           corner[4][4];
    load_texel(image, x.low, y.low, srgb, corner[0]);
    load_texel(image, x.high, y.low, srgb, corner[1]);
    load_texel(image, x.low, y.high, srgb, corner[2]);
    load_texel(image, x.high, y.high, srgb, corner[3]);
    for (int c = 0; c < 4; c++) {
        rgba_out[c] = mix(mix(corner[0][c], corner[1][c], x.fraction),
                          mix(corner[2][c], corner[3][c], x.fraction), y.fraction);
    }
}
