/* test_surface.c - what is known of a point on a triangle, on scenes filled in by hand. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/alloc.h"
#include "core/numerics.h"
#include "core/random.h"
#include "scene/scene_build.h"
#include "scene/surface.h"
#include "scene/tangent_space.h"
#include "scene/texture.h"
#include "support/measure.h"
#include "support/near.h"

/* One triangle with everything; the first vertex of the shape is the second of the scene, so that a
 * wrong offset is seen. */
typedef struct {
    assay_scene         scene;
    assay_shape         shape;
    assay_primitive     primitive;
    assay_material      material;
    assay_texture       texture;
    assay_texture_image image;
    uint8_t             texel[4];
    uint32_t            indices[3], triangle_shape[1];
    float               positions[12], normals[9], tangents[12], uv[2][6], colors[12];
    assay_world_vertex  vertices[4];
} one_triangle;

static void no_texture(assay_texture_ref *ref)
{
    *ref = (assay_texture_ref){.texture = ASSAY_NONE, .scale = {1.0, 1.0}};
    assay_texture_ref_prepare(ref);
}

static void put(float *to, assay_vec3 v)
{
    to[0] = (float)v.x;
    to[1] = (float)v.y;
    to[2] = (float)v.z;
}

static void set_triangle(one_triangle *t, assay_vec3 a, assay_vec3 b, assay_vec3 c)
{
    put(t->positions + 3, a);
    put(t->positions + 6, b);
    put(t->positions + 9, c);
}

static void set_normals(one_triangle *t, assay_vec3 a, assay_vec3 b, assay_vec3 c)
{
    put(t->normals, vec3_normalize(a));
    put(t->normals + 3, vec3_normalize(b));
    put(t->normals + 6, vec3_normalize(c));
    t->shape.normals = t->normals;
}

static void set_uv(one_triangle *t, int set, const float uv[6])
{
    memcpy(t->uv[set], uv, sizeof t->uv[set]);
    t->primitive.uv[set] = t->uv[set];
}

/* A texture of one texel of this value, used by `ref`. */
static void set_texture(one_triangle *t, assay_texture_ref *ref, int r, int g, int b, int a)
{
    t->texel[0]  = (uint8_t)r;
    t->texel[1]  = (uint8_t)g;
    t->texel[2]  = (uint8_t)b;
    t->texel[3]  = (uint8_t)a;
    ref->texture = 0;
}

/* The unit right triangle in the plane z = 0, front to +Z, flat, with a plain material. */
static void make(one_triangle *t)
{
    memset(t, 0, sizeof *t);
    t->indices[0] = 1;
    t->indices[1] = 2;
    t->indices[2] = 3;
    t->image      = (assay_texture_image){.width = 1, .height = 1, .bits = 8, .texels = t->texel};
    t->shape      = (assay_shape){
             .triangle_count = 1, .first_vertex = 1, .vertex_count = 3, .primitive = &t->primitive};
    assay_material *m = &t->material;
    m->base_color[0] = m->base_color[1] = m->base_color[2] = m->base_color[3] = 1.0;
    m->normal_scale                                                           = 1.0;
    m->alpha_cutoff                                                           = 0.5;
    assay_texture_ref *const refs[] = {&m->base_color_texture,  &m->metallic_roughness_texture,
                                       &m->normal_texture,      &m->emissive_texture,
                                       &m->specular_texture,    &m->specular_color_texture,
                                       &m->transmission_texture};
    for (size_t i = 0; i < sizeof refs / sizeof *refs; i++) {
        no_texture(refs[i]);
    }
    set_triangle(t, vec3(0.0, 0.0, 0.0), vec3(1.0, 0.0, 0.0), vec3(0.0, 1.0, 0.0));
    t->scene = (assay_scene){.images         = &t->image,
                             .textures       = &t->texture,
                             .materials      = m,
                             .shapes         = &t->shape,
                             .positions      = t->positions,
                             .vertices       = t->vertices,
                             .indices        = t->indices,
                             .triangle_shape = t->triangle_shape,
                             .shape_count    = 1,
                             .triangle_count = 1,
                             .vertex_count   = 4};
}

static void surface_at(one_triangle *t, double u, double v, assay_surface *surface_out)
{
    assay_scene_join_vertices(&t->scene);
    assay_surface_at(&t->scene, 0, u, v, surface_out);
}

static void geometry_of(one_triangle *t, assay_vec3 *ng_out, double *area_out)
{
    assay_scene_join_vertices(&t->scene);
    assay_triangle_geometry(&t->scene, 0, ng_out, area_out);
}

static double coverage_at(one_triangle *t, double u, double v)
{
    assay_scene_join_vertices(&t->scene);
    return assay_triangle_coverage(&t->scene, 0, u, v);
}

static void assert_vec3(assay_vec3 v, double x, double y, double z)
{
    assert_near(v.x, x, 1e-6);
    assert_near(v.y, y, 1e-6);
    assert_near(v.z, z, 1e-6);
}

static double random_at(uint32_t item, uint32_t k)
{
    assay_random random = assay_random_start(23, ASSAY_STAGE_TEST, item, k);
    return 2.0 * assay_random_next(&random) - 1.0;
}

/* A vector of components in [-1, 1). */
static assay_vec3 random_vector(uint32_t item, uint32_t k)
{
    return vec3(random_at(item, 3 * k), random_at(item, 3 * k + 1), random_at(item, 3 * k + 2));
}

/* ---- geometry ---- */

static void areas_and_normals(void **state)
{
    one_triangle t;
    assay_vec3   ng;
    double       area;
    (void)state;
    make(&t);
    geometry_of(&t, &ng, &area);
    assert_vec3(ng, 0.0, 0.0, 1.0);
    assert_near(area, 0.5, 0.0);
    for (uint32_t k = 0; k < 200; k++) {
        const assay_vec3 a = random_vector(k, 0), b = random_vector(k, 1), c = random_vector(k, 2);
        set_triangle(&t, a, b, c);
        geometry_of(&t, &ng, &area);
        /* Heron, from the sides; floats round the corners to 2^-24. */
        const double x = vec3_length(vec3_sub(a, b)), y = vec3_length(vec3_sub(b, c)),
                     z = vec3_length(vec3_sub(c, a)), s = 0.5 * (x + y + z);
        assert_near(area, sqrt(s * (s - x) * (s - y) * (s - z)), 1e-5);
        assert_near(vec3_length(ng), 1.0, 1e-15);
        if (area > 0.01) {
            assert_near(vec3_dot(ng, vec3_sub(b, a)), 0.0, 1e-5);
            assert_near(vec3_dot(ng, vec3_sub(c, a)), 0.0, 1e-5);
        }
    }
    set_triangle(&t, vec3(1.0, 2.0, 3.0), vec3(2.0, 3.0, 4.0), vec3(3.0, 4.0, 5.0));
    geometry_of(&t, &ng, &area);
    assert_near(area, 0.0, 0.0);
    assert_vec3(ng, 0.0, 0.0, 1.0);
    set_triangle(&t, vec3(0.0, 0.0, 0.0), vec3(1e-30, 0.0, 0.0), vec3(0.0, 1e-30, 0.0));
    geometry_of(&t, &ng, &area);
    assert_vec3(ng, 0.0, 0.0, 1.0);
    assert_true(area > 0.0);
    set_triangle(&t, vec3(0.0, 0.0, 0.0), vec3(3e38, 0.0, 0.0), vec3(0.0, 3e38, 0.0));
    geometry_of(&t, &ng, &area);
    assert_vec3(ng, 0.0, 0.0, 1.0);
    assert_true(isfinite(area));
}

static void everything_is_interpolated(void **state)
{
    static const float uv0[6] = {0.0f, 0.0f, 1.0f, 0.5f, 0.25f, 1.0f};
    static const float uv1[6] = {5.0f, 1.0f, 6.0f, 2.0f, 7.0f, -1.0f};
    one_triangle       t;
    assay_surface      s;
    (void)state;
    make(&t);
    for (int i = 0; i < 12; i++) {
        t.colors[i] = 0.1f * (float)i;
    }
    surface_at(&t, 0.25, 0.5, &s);
    assert_near(s.uv[0][0] + s.uv[1][1], 0.0, 0.0);
    assert_near(s.color[2], 1.0, 0.0);
    set_uv(&t, 0, uv0);
    set_uv(&t, 1, uv1);
    t.primitive.colors = t.colors;
    set_triangle(&t, vec3(1.0, 2.0, 3.0), vec3(5.0, 2.0, 3.0), vec3(1.0, 10.0, 3.0));
    surface_at(&t, 0.25, 0.5, &s);
    assert_vec3(s.position, 2.0, 6.0, 3.0);
    assert_near(s.uv[0][0], 0.375, 1e-15);
    assert_near(s.uv[0][1], 0.625, 1e-15);
    assert_near(s.uv[1][0], 6.25, 1e-15);
    assert_near(s.uv[1][1], 0.25, 1e-15);
    for (int c = 0; c < 4; c++) {
        assert_near(s.color[c], 0.25 * (0.1 * c) + 0.25 * (0.4 + 0.1 * c) + 0.5 * (0.8 + 0.1 * c),
                    1e-7);
    }
    assert_int_equal(s.triangle, 0);
    assert_int_equal(s.shape, 0);
    assert_int_equal(s.material, 0);
    assert_true(s.u == 0.25 && s.v == 0.5);
    assert_vec3(s.ng, 0.0, 0.0, 1.0);
    assert_vec3(s.ns, 0.0, 0.0, 1.0);
}

/* ---- shading normals ---- */

static void normals_are_interpolated_and_unit(void **state)
{
    one_triangle  t;
    assay_surface s;
    (void)state;
    make(&t);
    set_normals(&t, vec3(-1.0, 0.0, 2.0), vec3(1.0, 0.0, 2.0), vec3(0.0, 1.0, 2.0));
    surface_at(&t, 0.5, 0.0, &s);
    assert_vec3(s.ns, 0.0, 0.0, 1.0);
    surface_at(&t, 1.0, 0.0, &s);
    assert_vec3(s.ns, 1.0 / sqrt(5.0), 0.0, 2.0 / sqrt(5.0));
    surface_at(&t, 0.0, 1.0, &s);
    assert_vec3(s.ns, 0.0, 1.0 / sqrt(5.0), 2.0 / sqrt(5.0));
}

/* A normal that leans over the edge comes back to a cosine of 2^-10, in its own plane. */
static void leaning_normals_are_bent_back(void **state)
{
    one_triangle  t;
    assay_surface s;
    (void)state;
    make(&t);
    set_normals(&t, vec3(3.0, 4.0, -1.0), vec3(3.0, 4.0, 0.01), vec3(3.0, 4.0, 0.01));
    surface_at(&t, 0.0, 0.0, &s);
    assert_near(s.ns.z, 0x1p-10, 1e-15);
    assert_near(s.ns.y / s.ns.x, 4.0 / 3.0, 1e-6);
    assert_near(vec3_length(s.ns), 1.0, 1e-15);
    /* no tangential part: nothing to keep but the geometric normal */
    set_normals(&t, vec3(0.0, 0.0, -1.0), vec3(0.0, 0.0, 1.0), vec3(0.0, 0.0, 1.0));
    surface_at(&t, 0.0, 0.0, &s);
    assert_vec3(s.ns, 0.0, 0.0, 1.0);
    /* opposite normals cancel */
    surface_at(&t, 0.5, 0.0, &s);
    assert_vec3(s.ns, 0.0, 0.0, 1.0);
}

static void inverted_normals_are_turned_round(void **state)
{
    one_triangle  t;
    assay_surface s;
    (void)state;
    make(&t);
    set_normals(&t, vec3(-1.0, 0.0, -2.0), vec3(1.0, 0.0, -2.0), vec3(0.0, 1.0, -2.0));
    surface_at(&t, 1.0, 0.0, &s);
    assert_vec3(s.ns, -1.0 / sqrt(5.0), 0.0, 2.0 / sqrt(5.0));
}

static bool is_orthonormal(const assay_frame3 *f)
{
    return fabs(vec3_length(f->x) - 1.0) < 1e-12 && fabs(vec3_length(f->y) - 1.0) < 1e-12 &&
           fabs(vec3_length(f->z) - 1.0) < 1e-12 && fabs(vec3_dot(f->x, f->y)) < 1e-12 &&
           fabs(vec3_dot(f->x, f->z)) < 1e-12 &&
           vec3_length(vec3_sub(vec3_cross(f->x, f->y), f->z)) < 1e-12;
}

/* The invariant, for whatever normals, tangents, coordinates and normal maps. `spoil` takes ns as
 * it stood in the file: the mutant. */
static bool invariant_holds(bool spoil)
{
    one_triangle t;
    make(&t);
    for (uint32_t k = 0; k < 3000; k++) {
        float         uv[6];
        assay_surface s;
        set_triangle(&t, random_vector(k, 0), random_vector(k, 1), random_vector(k, 2));
        set_normals(&t, random_vector(k, 3), random_vector(k, 4), random_vector(k, 5));
        for (uint32_t i = 0; i < 6; i++) {
            uv[i] = k % 5 == 0 ? 0.5f : (float)random_at(k, 50 + i);
        }
        set_uv(&t, 0, uv);
        for (uint32_t i = 0; i < 12; i++) {
            t.tangents[i] = k % 7 == 0 ? 0.0f : (float)random_at(k, 60 + i);
        }
        t.shape.tangents = k % 2 ? t.tangents : NULL;
        set_texture(&t, &t.material.normal_texture, (int)(128 + 127 * random_at(k, 80)),
                    (int)(128 + 127 * random_at(k, 81)), (int)(128 + 127 * random_at(k, 82)), 255);
        t.material.normal_scale = 3.0 * random_at(k, 83);
        surface_at(&t, 0.3, 0.3, &s);
        const assay_vec3 ns = spoil ? vec3(t.normals[0], t.normals[1], t.normals[2]) : s.ns;
        if (!(vec3_dot(ns, s.ng) >= 0x1p-10 - 1e-9) || !is_orthonormal(&s.frame) ||
            vec3_length(vec3_sub(s.frame.z, ns)) != 0.0) {
            return false;
        }
    }
    return true;
}

static void normals_stay_in_front_whatever_comes(void **state)
{
    (void)state;
    assert_true(invariant_holds(false));
    assert_false(invariant_holds(true));
}

/* ---- normal maps ---- */

/* Texel of the tangent-space normal that leans by (x, y); 255 levels, so within 1/127. */
static void set_normal_map(one_triangle *t, double x, double y)
{
    const double z = sqrt(1.0 - x * x - y * y);
    set_texture(t, &t->material.normal_texture, (int)lround(127.5 * (x + 1.0)),
                (int)lround(127.5 * (y + 1.0)), (int)lround(127.5 * (z + 1.0)), 255);
}

static void assert_leans(one_triangle *t, double x, double y)
{
    assay_surface s;
    surface_at(t, 0.3, 0.3, &s);
    assert_near(s.ns.x, x, 0.01);
    assert_near(s.ns.y, y, 0.01);
    assert_near(s.ns.z, sqrt(1.0 - x * x - y * y), 0.01);
}

/* With the tangents that the loader makes of texture coordinates. */
static void take_tangents(one_triangle *t)
{
    uint32_t        indices[3] = {0, 1, 2};
    assay_context  *context    = measure_context(1);
    assay_primitive p          = t->primitive;
    p.vertex_count             = 3;
    p.triangle_count           = 1;
    p.indices                  = indices;
    p.positions                = t->positions + 3;
    p.normals                  = t->shape.normals;
    assert_int_equal(assay_primitive_make_tangents(context, &p, &t->material.normal_texture),
                     ASSAY_OK);
    t->shape.tangents = NULL;
    if (p.tangents) {
        memcpy(t->tangents, p.tangents, sizeof t->tangents);
        t->shape.tangents = t->tangents;
        assay_release(context, p.tangents);
    }
    assay_context_destroy(context);
}

static void assert_leans_by_uv(one_triangle *t, double x, double y)
{
    take_tangents(t);
    assert_leans(t, x, y);
}

/* An image upright on the triangle: u to +X, v down; green leans up, to +Y. */
static const float upright[6]    = {0.0f, 1.0f, 1.0f, 1.0f, 0.0f, 0.0f};
static const float mirrored[6]   = {1.0f, 1.0f, 0.0f, 1.0f, 1.0f, 0.0f};
static const float quarter[6]    = {0.0f, 0.0f, 0.0f, 1.0f, 1.0f, 0.0f}; /* u to +Y, v to +X */
static const float degenerate[6] = {0.0f, 0.0f, 1.0f, 1.0f, 2.0f, 2.0f};

static void maps_follow_texture_coordinates(void **state)
{
    one_triangle t;
    (void)state;
    make(&t);
    set_normal_map(&t, 0.5, 0.25);
    set_uv(&t, 0, upright);
    assert_leans_by_uv(&t, 0.5, 0.25);
    set_uv(&t, 0, mirrored);
    assert_leans_by_uv(&t, -0.5, 0.25);
    set_uv(&t, 0, quarter);
    assert_leans_by_uv(&t, -0.25, 0.5);
    set_uv(&t, 0, degenerate);
    assert_leans_by_uv(&t, 0.0, 0.0);
    t.primitive.uv[0] = NULL;
    assert_leans_by_uv(&t, 0.0, 0.0);
    /* the second set, where the reference says so */
    set_uv(&t, 1, mirrored);
    t.material.normal_texture.texcoord = 1;
    assert_leans_by_uv(&t, -0.5, 0.25);
}

/* KHR_texture_transform turns the image, and what leans in it: a quarter turn takes u to where v
 * fell. */
static void maps_follow_the_transform(void **state)
{
    one_triangle       t;
    assay_texture_ref *ref = NULL;
    (void)state;
    make(&t);
    set_uv(&t, 0, upright);
    set_normal_map(&t, 0.5, 0.25);
    ref           = &t.material.normal_texture;
    ref->rotation = 0.5 * ASSAY_PI;
    assay_texture_ref_prepare(ref);
    /* u' = v, v' = -u: u' grows to -Y, v' grows to -X */
    assert_leans_by_uv(&t, 0.25, -0.5);
    ref->rotation = 0.0;
    ref->scale[0] = -2.0;
    assay_texture_ref_prepare(ref);
    assert_leans_by_uv(&t, -0.5, 0.25);
}

static void maps_follow_tangents(void **state)
{
    one_triangle t;
    (void)state;
    make(&t);
    set_uv(&t, 0, mirrored); /* not looked at */
    set_normal_map(&t, 0.5, 0.25);
    for (int w = -1; w <= 1; w += 2) {
        for (int i = 0; i < 3; i++) {
            t.tangents[4 * i + 1] = 1.0f;
            t.tangents[4 * i + 3] = (float)w;
        }
        t.shape.tangents = t.tangents;
        /* tangent +Y, normal +Z: bitangent -X times w */
        assert_leans(&t, -0.25 * w, 0.5);
    }
}

static void normal_scale_scales(void **state)
{
    one_triangle  t;
    assay_surface s;
    (void)state;
    make(&t);
    set_uv(&t, 0, upright);
    set_normal_map(&t, 0.5, 0.25);
    t.material.normal_scale = 0.0;
    assert_leans_by_uv(&t, 0.0, 0.0);
    t.material.normal_scale = -1.0;
    assert_leans_by_uv(&t, -0.5, -0.25);
    t.material.normal_scale = 1e6;
    surface_at(&t, 0.3, 0.3, &s);
    assert_true(s.ns.z >= 0x1p-10 - 1e-15);
    assert_near(s.ns.y / s.ns.x, 0.5, 0.02);
}

static void frames_follow_the_tangent_where_it_counts(void **state)
{
    one_triangle  t;
    assay_surface s;
    (void)state;
    make(&t);
    set_uv(&t, 0, quarter);
    take_tangents(&t);
    t.material.model = ASSAY_MATERIAL_WARD;
    surface_at(&t, 0.2, 0.2, &s);
    assert_vec3(s.frame.x, 0.0, 1.0, 0.0);
    assert_vec3(s.frame.y, -1.0, 0.0, 0.0);
    t.material.model = ASSAY_MATERIAL_WARD_PUBLISHED;
    set_uv(&t, 0, mirrored);
    take_tangents(&t);
    surface_at(&t, 0.2, 0.2, &s);
    assert_vec3(s.frame.x, -1.0, 0.0, 0.0);
}

/* ---- materials ---- */

static void base_color_is_a_product(void **state)
{
    static const float uv[6] = {0.0f};
    one_triangle       t;
    assay_surface      s;
    assay_rgb          color;
    double             coverage;
    (void)state;
    make(&t);
    set_uv(&t, 0, uv);
    set_texture(&t, &t.material.base_color_texture, 188, 128, 255, 102);
    for (int i = 0; i < 12; i++) {
        t.colors[i] = i % 4 == 3 ? 0.5f : 0.25f;
    }
    t.primitive.colors       = t.colors;
    t.material.base_color[0] = 0.5;
    t.material.base_color[3] = 0.8;
    t.material.alpha_mode    = ASSAY_ALPHA_BLEND;
    surface_at(&t, 0.2, 0.2, &s);
    assay_surface_base_color(&t.scene, &s, &color, &coverage);
    assert_near(color.r, 0.125 * assay_srgb_decode8(188), 1e-15);
    assert_near(color.g, 0.25 * assay_srgb_decode8(128), 1e-15);
    assert_near(color.b, 0.25, 1e-15);
    assert_near(coverage, 0.8 * 0.4 * 0.5, 1e-15);
    assert_near(coverage_at(&t, 0.2, 0.2), coverage, 0.0);
    /* COLOR_0 may exceed 1; a reflectance may not */
    for (int i = 0; i < 12; i++) {
        t.colors[i] = i % 4 == 0 ? -1.0f : 100.0f;
    }
    surface_at(&t, 0.2, 0.2, &s);
    assay_surface_base_color(&t.scene, &s, &color, &coverage);
    assert_vec3(vec3(color.r, color.g, color.b), 0.0, 1.0, 1.0);
    assert_near(coverage, 1.0, 0.0);
}

static void coverage_follows_the_alpha_mode(void **state)
{
    static const struct {
        assay_alpha_mode     mode;
        assay_material_model model;
        double               alpha, coverage;
    } rows[] = {{ASSAY_ALPHA_OPAQUE, ASSAY_MATERIAL_PBR, 0.2, 1.0},
                {ASSAY_ALPHA_MASK, ASSAY_MATERIAL_PBR, 0.49, 0.0},
                {ASSAY_ALPHA_MASK, ASSAY_MATERIAL_PBR, 0.5, 1.0},
                {ASSAY_ALPHA_BLEND, ASSAY_MATERIAL_PBR, 0.2, 0.2},
                {ASSAY_ALPHA_BLEND, ASSAY_MATERIAL_UNLIT, 0.2, 0.2},
                {ASSAY_ALPHA_BLEND, ASSAY_MATERIAL_LAMBERT, 0.2, 1.0},
                {ASSAY_ALPHA_MASK, ASSAY_MATERIAL_LAMBERT, 0.2, 1.0}};
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        one_triangle           t;
        assay_surface          s;
        assay_surface_material m;
        make(&t);
        t.material.alpha_mode    = rows[i].mode;
        t.material.model         = rows[i].model;
        t.material.base_color[3] = rows[i].alpha;
        surface_at(&t, 0.2, 0.2, &s);
        assay_surface_material_at(&t.scene, &s, &m);
        assert_near(m.coverage, rows[i].coverage, 0.0);
        assert_near(coverage_at(&t, 0.2, 0.2), rows[i].coverage, 0.0);
    }
}

static void emission_has_its_sides(void **state)
{
    one_triangle  t;
    assay_surface s;
    (void)state;
    make(&t);
    surface_at(&t, 0.2, 0.2, &s);
    assert_true(rgb_is_black(assay_surface_emission(&t.scene, &s, true)));
    assert_false(assay_material_emits(&t.material));
    t.material.emissive     = rgb(1.0, 2.0, 30.0);
    t.material.double_sided = true;
    assert_true(assay_material_emits(&t.material));
    assert_near(assay_surface_emission(&t.scene, &s, true).b, 30.0, 0.0);
    assert_true(rgb_is_black(assay_surface_emission(&t.scene, &s, false)));
    t.material.emission_two_sided = true;
    assert_near(assay_surface_emission(&t.scene, &s, false).g, 2.0, 0.0);
    set_texture(&t, &t.material.emissive_texture, 188, 255, 0, 0);
    const assay_rgb textured = assay_surface_emission(&t.scene, &s, true);
    assert_near(textured.r, assay_srgb_decode8(188), 1e-15);
    assert_near(textured.g, 2.0, 0.0);
    assert_near(textured.b, 0.0, 0.0);
}

static void unlit_materials_show_their_color(void **state)
{
    one_triangle  t;
    assay_surface s;
    (void)state;
    make(&t);
    t.material.model         = ASSAY_MATERIAL_UNLIT;
    t.material.base_color[0] = 0.25;
    t.material.emissive      = rgb(9.0, 9.0, 9.0);
    surface_at(&t, 0.2, 0.2, &s);
    assert_false(assay_material_emits(&t.material));
    assert_near(assay_surface_emission(&t.scene, &s, true).r, 0.25, 0.0);
    assert_near(assay_surface_emission(&t.scene, &s, true).g, 1.0, 0.0);
    assert_true(rgb_is_black(assay_surface_emission(&t.scene, &s, false)));
    t.material.double_sided = true;
    assert_near(assay_surface_emission(&t.scene, &s, false).r, 0.25, 0.0);
}

/* One texel whose channels all differ, through each reference in turn. */
static void channels_are_those_of_the_specification(void **state)
{
    one_triangle           t;
    assay_surface          s;
    assay_surface_material m;
    (void)state;
    make(&t);
    t.material.metallic        = 0.5;
    t.material.roughness       = 0.75;
    t.material.transmission    = 0.25;
    t.material.specular_factor = 0.5;
    t.material.specular_color  = rgb(2.0, 1.0, 0.5);
    surface_at(&t, 0.2, 0.2, &s);
    assay_surface_material_at(&t.scene, &s, &m);
    assert_near(m.metallic, 0.5, 0.0);
    assert_near(m.roughness, 0.75, 0.0);
    assert_near(m.transmission, 0.25, 0.0);
    assert_near(m.specular_factor, 0.5, 0.0);
    assert_near(m.specular_color.r, 2.0, 0.0);
    assert_near(m.base_color.g, 1.0, 0.0);
    set_texture(&t, &t.material.metallic_roughness_texture, 51, 102, 153, 204);
    t.material.transmission_texture.texture       = t.material.specular_texture.texture =
        t.material.specular_color_texture.texture = 0;
    assay_surface_material_at(&t.scene, &s, &m);
    assert_near(m.roughness, 0.75 * 0.4, 1e-15);
    assert_near(m.metallic, 0.5 * 0.6, 1e-15);
    assert_near(m.transmission, 0.25 * 0.2, 1e-15);
    assert_near(m.specular_factor, 0.5 * 0.8, 1e-15);
    assert_near(m.specular_color.r, 2.0 * assay_srgb_decode8(51), 1e-15);
    assert_near(m.specular_color.g, assay_srgb_decode8(102), 1e-15);
    assert_near(m.specular_color.b, 0.5 * assay_srgb_decode8(153), 1e-15);
    /* a forced Lambertian looks nothing of that up */
    t.material.model = ASSAY_MATERIAL_LAMBERT;
    assay_surface_material_at(&t.scene, &s, &m);
    assert_near(m.roughness, 0.75, 0.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(areas_and_normals),
                                       cmocka_unit_test(everything_is_interpolated),
                                       cmocka_unit_test(normals_are_interpolated_and_unit),
                                       cmocka_unit_test(leaning_normals_are_bent_back),
                                       cmocka_unit_test(inverted_normals_are_turned_round),
                                       cmocka_unit_test(normals_stay_in_front_whatever_comes),
                                       cmocka_unit_test(maps_follow_texture_coordinates),
                                       cmocka_unit_test(maps_follow_the_transform),
                                       cmocka_unit_test(maps_follow_tangents),
                                       cmocka_unit_test(normal_scale_scales),
                                       cmocka_unit_test(frames_follow_the_tangent_where_it_counts),
                                       cmocka_unit_test(base_color_is_a_product),
                                       cmocka_unit_test(coverage_follows_the_alpha_mode),
                                       cmocka_unit_test(emission_has_its_sides),
                                       cmocka_unit_test(unlit_materials_show_their_color),
                                       cmocka_unit_test(channels_are_those_of_the_specification)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
