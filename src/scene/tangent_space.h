/* tangent_space.h - tangents of a mesh that brings none. */
#ifndef ASSAY_SCENE_TANGENT_SPACE_H
#define ASSAY_SCENE_TANGENT_SPACE_H

#include "scene/scene_data.h"

/* Gives the primitive tangents by the rules of MikkTSpace [mikkelsen08], as glTF asks, from its
 * positions, normals (flat: those of its triangles) and the coordinates of the reference, with its
 * transform.  They are unit vectors in the plane of the vertex normal that point to growing u, or
 * zero where no texture coordinates around the vertex span a plane; w is the sign of the bitangent,
 * which points to falling v.  Vertices whose triangles disagree are doubled, with all that they
 * have, morph targets included, at the end of the arrays; the order of triangles stays.
 * Nothing happens where there are tangents already, or no coordinates.
 * Errors: MEMORY; the primitive then looks as before. */
assay_status assay_primitive_make_tangents(assay_context *context, assay_primitive *primitive,
                                           const assay_texture_ref *ref);

#endif
