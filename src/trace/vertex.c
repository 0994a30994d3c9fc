/* vertex.c - from a hit to something that scatters. */
#include "trace/vertex.h"

#include "core/numerics.h"

static assay_bsdf_model model_of(const assay_material *material)
{
    switch (material->model) {
    case ASSAY_MATERIAL_LAMBERT: return ASSAY_BSDF_LAMBERT;
    case ASSAY_MATERIAL_UNLIT: return ASSAY_BSDF_BLACK;
    case ASSAY_MATERIAL_PHONG: return ASSAY_BSDF_PHONG;
    case ASSAY_MATERIAL_WARD: return ASSAY_BSDF_WARD;
    case ASSAY_MATERIAL_WARD_PUBLISHED: return ASSAY_BSDF_WARD_PUBLISHED;
    case ASSAY_MATERIAL_PBR: break;
    }
    return ASSAY_BSDF_METALLIC_ROUGHNESS;
}

assay_bsdf assay_vertex_bsdf(const assay_material *material, const assay_surface_material *at)
{
    assay_bsdf bsdf = {
        .model           = model_of(material),
        .base_color      = at->base_color,
        .metallic        = at->metallic,
        .roughness       = at->roughness,
        .ior             = material->ior,
        .specular_factor = at->specular_factor,
        .specular_color  = at->specular_color,
        .transmission    = at->transmission,
        .solid           = material->solid,
        .exponent        = material->exponent,
        .alpha_x         = material->alpha_x,
        .alpha_y         = material->alpha_y,
    };
    /* Without metal, specular reflection and transmission, metallic-roughness is Lambert's law, and
     * that is cheaper and reads better in an image of lobes. */
    if (bsdf.model == ASSAY_BSDF_METALLIC_ROUGHNESS && bsdf.metallic == 0.0 &&
        bsdf.specular_factor == 0.0 && bsdf.transmission == 0.0) {
        bsdf.model = ASSAY_BSDF_LAMBERT;
    }
    return bsdf;
}

void assay_vertex_place(const assay_world *world, const assay_hit *hit, assay_vec3 direction,
                        assay_vertex *vertex_out)
{
    assay_vertex *v = vertex_out;
    assay_surface_at(world->scene, hit->triangle, hit->u, hit->v, &v->surface);
    v->wo    = vec3_negate(direction);
    v->front = vec3_dot(v->wo, v->surface.ng) >= 0.0;
    /* A shading normal that looks away from where the surface is seen would make a front a back:
     * the geometric normal then stands in for it. */
    if ((vec3_dot(v->wo, v->surface.ns) >= 0.0) != v->front) {
        v->surface.ns    = v->surface.ng;
        v->surface.frame = frame3_from_zx(v->surface.ng, v->surface.frame.x);
    }
    v->frame    = v->surface.frame;
    v->wo_local = frame3_to_local(&v->frame, v->wo);

    const assay_material *material = &world->scene->materials[v->surface.material];
    v->transmits = material->model == ASSAY_MATERIAL_PBR && material->transmission > 0.0;
    v->dressed   = false;
    assay_surface_prefetch(world->scene, &v->surface);
}

void assay_vertex_dress(const assay_world *world, assay_vertex *vertex)
{
    if (!vertex->dressed) {
        assay_surface_material at;
        assay_surface_material_at(world->scene, &vertex->surface, &at);
        vertex->bsdf = assay_vertex_bsdf(&world->scene->materials[vertex->surface.material], &at);
        vertex->dressed = true;
    }
}

void assay_vertex_receiver(assay_vec3 position, const assay_frame3 *frame, assay_vec3 ng,
                           assay_vertex *vertex_out)
{
    *vertex_out                  = (assay_vertex){0};
    vertex_out->surface.triangle = ASSAY_NO_TRIANGLE;
    vertex_out->surface.position = position;
    vertex_out->surface.ng       = ng;
    vertex_out->surface.ns       = frame->z;
    vertex_out->surface.frame    = *frame;
    vertex_out->frame            = *frame;
    vertex_out->bsdf             = assay_bsdf_default(ASSAY_BSDF_LAMBERT);
    vertex_out->bsdf.base_color  = rgb_grey(ASSAY_PI);
    vertex_out->wo               = frame->z;
    vertex_out->wo_local         = vec3(0.0, 0.0, 1.0);
    vertex_out->front            = true;
    vertex_out->dressed          = true;
}
