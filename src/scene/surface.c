/* surface.c - geometry, shading normal and tangent frame at a hit.
 *
 * Invariant: ng and ns are unit vectors and ng . ns >= MIN_COSINE, up to rounding.  A shading
 * normal that leans over the edge of its own triangle (a coarse mesh seen from the side, a steep
 * normal map) is bent back just that far, in the plane that it spans with ng.  Where all three
 * vertex normals look to the back, the file has them inverted, and they are turned round.
 *
 * Where a mesh brings no tangents, the loader has made them (tangent_space.h).  Where they vanish,
 * because texture coordinates do not span a plane, the normal map is left out. */
#include "scene/surface.h"

#include "scene/surface_material.h"

static const double MIN_COSINE = 0x1p-10;

/* A triangle's corners: edges, vertices, and weights. */
typedef struct {
    assay_vec3                p0, e1, e2; /* first corner, and from there to the others, m */
    const assay_world_vertex *joined[3];
    uint32_t                  vertex[3]; /* into the shape's vertices                     */
    double                    weight[3];
} corners;

static inline assay_vec3 load3(const float v[3]) { return vec3(v[0], v[1], v[2]); }

static inline corners corners_of(const assay_scene *scene, uint32_t triangle)
{
    const uint32_t    *index = scene->indices + (size_t)triangle * 3;
    const assay_shape *shape = &scene->shapes[scene->triangle_shape[triangle]];
    corners            c;
    for (int i = 0; i < 3; i++) {
        c.joined[i] = &scene->vertices[index[i]];
        c.vertex[i] = index[i] - shape->first_vertex;
    }
    c.p0 = load3(c.joined[0]->position);
    c.e1 = vec3_sub(load3(c.joined[1]->position), c.p0);
    c.e2 = vec3_sub(load3(c.joined[2]->position), c.p0);
    return c;
}

/* Twice the area, and the unit normal. */
static inline double normal_of(const corners *c, assay_vec3 *ng_out)
{
    const assay_vec3 n      = vec3_cross(c->e1, c->e2);
    const double     length = vec3_length(n);
    *ng_out                 = length > 0.0 ? vec3_scale(n, 1.0 / length) : vec3(0.0, 0.0, 1.0);
    return length;
}

void assay_triangle_geometry(const assay_scene *scene, uint32_t triangle, assay_vec3 *ng_out,
                             double *area_out)
{
    const corners c = corners_of(scene, triangle);
    *area_out       = 0.5 * normal_of(&c, ng_out);
}

/* The mean, by weight, of what three vertices have. */
static inline void blend(const corners *c, const float *a, const float *b, const float *d,
                         int width, double *out)
{
    for (int i = 0; i < width; i++) {
        out[i] = c->weight[0] * a[i] + c->weight[1] * b[i] + c->weight[2] * d[i];
    }
}

static inline void interpolate(const corners *c, const float *values, int width, double *out)
{
    blend(c, values + (size_t)c->vertex[0] * (size_t)width,
          values + (size_t)c->vertex[1] * (size_t)width,
          values + (size_t)c->vertex[2] * (size_t)width, width, out);
}

/* 0 where the shape has no such set. */
static inline void interpolate_uv(const corners *c, const assay_primitive *primitive, unsigned set,
                                  double uv_out[2])
{
    if (set == 0) {
        blend(c, c->joined[0]->uv, c->joined[1]->uv, c->joined[2]->uv, 2, uv_out);
    } else if (primitive->uv[set]) {
        interpolate(c, primitive->uv[set], 2, uv_out);
    } else {
        uv_out[0] = uv_out[1] = 0.0;
    }
}

/* The unit vector nearest to n whose cosine with ng is at least MIN_COSINE. */
static inline assay_vec3 keep_on_side(assay_vec3 n, assay_vec3 ng)
{
    const double cosine = vec3_dot(n, ng);
    if (cosine >= MIN_COSINE) {
        return n;
    }
    const assay_vec3 along  = vec3_mad(n, -cosine, ng);
    const double     length = vec3_length(along);
    if (!(length > 1e-6)) {
        return ng;
    }
    const double sine = sqrt(1.0 - MIN_COSINE * MIN_COSINE);
    return vec3_mad(vec3_scale(ng, MIN_COSINE), sine / length, along);
}

static assay_vec3 shading_normal(const assay_shape *shape, const corners *c, assay_vec3 ng)
{
    double sum[3];
    if (!shape->normals) {
        return ng;
    }
    blend(c, c->joined[0]->normal, c->joined[1]->normal, c->joined[2]->normal, 3, sum);
    assay_vec3   n      = vec3(sum[0], sum[1], sum[2]);
    const double length = vec3_length(n);
    if (!(length > 1e-6)) {
        return ng;
    }
    n = vec3_scale(n, 1.0 / length);
    if (vec3_dot(n, ng) < 0.0 && vec3_dot(load3(c->joined[0]->normal), ng) < 0.0 &&
        vec3_dot(load3(c->joined[1]->normal), ng) < 0.0 &&
        vec3_dot(load3(c->joined[2]->normal), ng) < 0.0) {
        n = vec3_negate(n);
    }
    return keep_on_side(n, ng);
}

/* Unit tangent and bitangent sign. */
static bool find_tangent(const assay_shape *shape, const corners *c, assay_vec3 *tangent_out,
                         double *sign_out)
{
    double sum[4];
    if (!shape->tangents) {
        return false;
    }
    interpolate(c, shape->tangents, 4, sum);
    const assay_vec3 t      = vec3(sum[0], sum[1], sum[2]);
    const double     length = vec3_length(t);
    if (!(length > 1e-6)) {
        return false;
    }
    *tangent_out = vec3_scale(t, 1.0 / length);
    *sign_out    = sum[3] < 0.0 ? -1.0 : 1.0;
    return true;
}

/* glTF 2.0, 3.9.3 "Additional textures": (2 texel - 1) * (scale, scale, 1) in the frame of tangent,
 * bitangent = sign * normal x tangent, normal. */
static assay_vec3 mapped_normal(const assay_scene *scene, const assay_material *material,
                                const assay_surface *surface, const assay_frame3 *frame,
                                double sign)
{
    const assay_texture_ref *ref = &material->normal_texture;
    double                   texel[4];
    assay_texture_sample(scene, ref, surface->uv[ref->texcoord & 1u], false, texel);
    const double     x      = (2.0 * texel[0] - 1.0) * material->normal_scale;
    const double     y      = (2.0 * texel[1] - 1.0) * material->normal_scale * sign;
    const double     z      = 2.0 * texel[2] - 1.0;
    const assay_vec3 world  = frame3_to_world(frame, vec3(x, y, z));
    const double     length = vec3_length(world);
    return length > 1e-6 ? vec3_scale(world, 1.0 / length) : surface->ns;
}

bool assay_material_wants_tangent(const assay_material *material)
{
    return material->normal_texture.texture != ASSAY_NONE ||
           material->model == ASSAY_MATERIAL_WARD ||
           material->model == ASSAY_MATERIAL_WARD_PUBLISHED;
}

static void orient(const assay_scene *scene, const corners *c, assay_surface *s)
{
    const assay_shape    *shape    = &scene->shapes[s->shape];
    const assay_material *material = &scene->materials[s->material];
    assay_vec3            tangent;
    double                sign = 1.0;
    if (!assay_material_wants_tangent(material) || !find_tangent(shape, c, &tangent, &sign)) {
        s->frame = frame3_from_z(s->ns);
        return;
    }
    s->frame = frame3_from_zx(s->ns, tangent);
    if (material->normal_texture.texture != ASSAY_NONE) {
        s->ns    = keep_on_side(mapped_normal(scene, material, s, &s->frame, sign), s->ng);
        s->frame = frame3_from_zx(s->ns, tangent);
    }
}

void assay_surface_at(const assay_scene *scene, uint32_t triangle, double u, double v,
                      assay_surface *surface_out)
{
    assay_surface         *s         = surface_out;
    corners                c         = corners_of(scene, triangle);
    const uint32_t         index     = scene->triangle_shape[triangle];
    const assay_shape     *shape     = &scene->shapes[index];
    const assay_primitive *primitive = shape->primitive;
    c.weight[0]                      = 1.0 - u - v;
    c.weight[1]                      = u;
    c.weight[2]                      = v;
    s->triangle                      = triangle;
    s->shape                         = index;
    s->material                      = shape->material;
    s->u                             = u;
    s->v                             = v;
    s->position                      = vec3_mad(vec3_mad(c.p0, u, c.e1), v, c.e2);
    normal_of(&c, &s->ng);
    s->ns = shading_normal(shape, &c, s->ng);
    interpolate_uv(&c, primitive, 0, s->uv[0]);
    interpolate_uv(&c, primitive, 1, s->uv[1]);
    s->color[0] = s->color[1] = s->color[2] = s->color[3] = 1.0;
    if (primitive->colors) {
        interpolate(&c, primitive->colors, 4, s->color);
    }
    orient(scene, &c, s);
}

double assay_triangle_coverage(const assay_scene *scene, uint32_t triangle, double u, double v)
{
    const assay_shape    *shape    = &scene->shapes[scene->triangle_shape[triangle]];
    const assay_material *material = &scene->materials[shape->material];
    if (material->alpha_mode == ASSAY_ALPHA_OPAQUE || material->model == ASSAY_MATERIAL_LAMBERT) {
        return 1.0;
    }
    const assay_texture_ref *ref = &material->base_color_texture;
    corners                  c   = corners_of(scene, triangle);
    double                   uv[2], color[4] = {1.0, 1.0, 1.0, 1.0}, texel[4];
    c.weight[0] = 1.0 - u - v;
    c.weight[1] = u;
    c.weight[2] = v;
    interpolate_uv(&c, shape->primitive, ref->texcoord & 1u, uv);
    if (shape->primitive->colors) {
        interpolate(&c, shape->primitive->colors, 4, color);
    }
    assay_texture_sample(scene, ref, uv, false, texel);
    return assay_material_coverage(material, material->base_color[3] * texel[3] * color[3]);
}
