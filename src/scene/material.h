/* material.h - materials and textures as loaded. */
#ifndef ASSAY_SCENE_MATERIAL_H
#define ASSAY_SCENE_MATERIAL_H

#include <stdbool.h>
#include <stdint.h>

#include "math/vec.h"

#define ASSAY_NONE UINT32_MAX

typedef enum { ASSAY_WRAP_REPEAT, ASSAY_WRAP_CLAMP, ASSAY_WRAP_MIRROR } assay_wrap;

/* Decoded pixels, row 0 on top (v = 0), RGBA interleaved. */
typedef struct {
    char    *name; /* for messages: "images/3 (bricks.png)" */
    uint32_t width, height;
    uint8_t  bits;  /* 8 or 16 a component                   */
    bool     tiled; /* false: row by row; true: by tiles of 4 x 4, see texture.h */
    void    *texels;
} assay_texture_image;

typedef struct {
    uint32_t   image;
    assay_wrap wrap_u, wrap_v;
    bool       nearest; /* magFilter NEAREST; everything else is bilinear, level 0 */
} assay_texture;

/* A material's use of a texture. texture == ASSAY_NONE: not textured. */
typedef struct {
    uint32_t texture;
    uint32_t texcoord; /* 0 or 1                                              */
    double   offset[2], rotation, scale[2]; /* KHR_texture_transform                       */
    double   uv_matrix[2][3]; /* the same, ready to apply                            */
} assay_texture_ref;

typedef enum { ASSAY_ALPHA_OPAQUE, ASSAY_ALPHA_MASK, ASSAY_ALPHA_BLEND } assay_alpha_mode;

typedef enum {
    ASSAY_MATERIAL_PBR,   /* glTF metallic-roughness with extensions   */
    ASSAY_MATERIAL_UNLIT, /* KHR_materials_unlit: emits its base colour to the camera, scatters
                             nothing */
    ASSAY_MATERIAL_PHONG, /* extras.assay {"brdf":"phong"}             */
    ASSAY_MATERIAL_WARD,  /* extras.assay {"brdf":"ward"}              */
    ASSAY_MATERIAL_WARD_PUBLISHED,
    ASSAY_MATERIAL_LAMBERT /* force_diffuse: base colour / pi on both sides, nothing else */
} assay_material_model;

typedef struct {
    char                *name;
    assay_material_model model;
    double               base_color[4];
    double               metallic, roughness;
    double               normal_scale;
    assay_rgb            emissive; /* factor * strength, W/(m2 sr) */
    assay_alpha_mode     alpha_mode;
    double               alpha_cutoff;
    bool                 double_sided;
    bool                 emission_two_sided; /* as the file says, even where force_diffuse made the
                                                material double_sided                               */
    double            ior, specular_factor, transmission;
    assay_rgb         specular_color;
    bool              solid;                /* a volume lies behind: refraction            */
    double            attenuation_distance; /* m, INFINITY without                      */
    assay_rgb         attenuation_color;
    double            exponent;         /* Phong                                       */
    double            alpha_x, alpha_y; /* Ward                                        */
    assay_texture_ref base_color_texture, metallic_roughness_texture, normal_texture,
        emissive_texture, specular_texture, specular_color_texture, transmission_texture;
} assay_material;

#endif
