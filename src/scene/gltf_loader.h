/* gltf_loader.h - the loading of one glTF file: its state, and the steps in their order.
 *
 * Every step fills a part of loader->scene, fails with a message that names file and place, and
 * leaves what it made to assay_scene_destroy and assay_gltf_loader_release. */
#ifndef ASSAY_SCENE_GLTF_LOADER_H
#define ASSAY_SCENE_GLTF_LOADER_H

#include "core/hash.h"
#include "scene/gltf_document.h"
#include "scene/gltf_schema.h"

/* Bytes of a buffer. */
typedef struct {
    const uint8_t *bytes; /* NULL: not loaded */
    uint64_t       count;
    void          *owned; /* NULL where the bytes are those of the main file */
} assay_gltf_bytes;

typedef struct {
    assay_context *context;
    assay_scene   *scene;
    const char    *file;   /* the main file's name as messages give it                    */
    const char    *folder; /* what relative URIs start from, NULL: no other file is read  */
    assay_hash     hash;   /* of all files, in the order of their reading                 */
    uint64_t       bytes_read, bytes_decoded, texel_bytes; /* against the limits          */
    uint64_t       steps_done, steps;

    const char    *text; /* the JSON text, inside of the main file's bytes       */
    size_t         text_count;
    const uint8_t *chunk; /* the binary chunk, likewise, or NULL                  */
    size_t         chunk_count;

    assay_json_document json;
    assay_gltf_schema   schema;
    assay_gltf_document document;
    assay_gltf_bytes   *buffers; /* buffer_count */
    uint32_t            buffer_count;
} assay_gltf_loader;

void assay_gltf_loader_release(assay_gltf_loader *loader);

/* "FILE: " and the message, made a single clean line; returns the status. */
assay_status assay_gltf_fail(const assay_gltf_loader *loader, assay_status status,
                             const char *format, ...) __attribute__((format(printf, 3, 4)));

/* Adds to the bytes that accessors took.  Errors: LIMIT. */
assay_status assay_gltf_count_decoded(assay_gltf_loader *loader, uint64_t elements, uint64_t size);

/* One step of the progress of phase "load" is done.  Errors: CANCELLED. */
assay_status assay_gltf_step(assay_gltf_loader *loader);

/* ---- gltf_file.c: bytes from files and URIs ---- */

/* Reads a regular file of at most ASSAY_GLTF_MAX_FILE_BYTES and adds it to the hash; `name` is for
 * messages.  Errors: NOT_FOUND (missing, unreadable, not a regular file), FORMAT (empty), LIMIT,
 * MEMORY. */
assay_status assay_gltf_read_file(assay_gltf_loader *loader, const char *path, const char *name,
                                  assay_gltf_bytes *bytes_out);
/* The bytes of a data URI, or of the file that a relative URI names.  `place` is for messages
 * ("buffers/0").  Errors: as read_file, FORMAT (malformed data URI), UNSUPPORTED (other URIs). */
assay_status assay_gltf_read_uri(assay_gltf_loader *loader, const char *uri, const char *place,
                                 assay_gltf_bytes *bytes_out);
void         assay_gltf_release_bytes(assay_context *context, assay_gltf_bytes *bytes);

/* ---- gltf_uri.c: parts of URIs ---- */

/* Whether a URI has a scheme ("data:", "http:", "C:"). */
bool assay_gltf_uri_has_scheme(const char *uri);
/* Decodes %XX in place; a '%' without two hexadecimal digits stays.  False, but decoded, where
 * there was a %00. */
bool assay_gltf_uri_decode(char *text, size_t *length_out);
/* Decodes base64 (RFC 4648, padding optional) in place; false where it is none. */
bool assay_gltf_base64_decode(char *text, size_t length, size_t *length_out);

/* ---- gltf_container.c ---- */

/* Splits the main file into text and binary chunk; GLB is told by its first bytes.
 * Errors: FORMAT, UNSUPPORTED (GLB of another version). */
assay_status assay_gltf_split(assay_gltf_loader *loader, const uint8_t *bytes, size_t count);

/* ---- gltf_write.c ---- */

/* The document again as text for tinygltf: no buffers, images, materials, extras and extensions;
 * whole numbers without fraction or exponent, others with 17 digits.  Release *text_out with
 * assay_release.  Errors: MEMORY, LIMIT (2 GiB). */
assay_status assay_gltf_write_text(assay_context *context, const char *file, const assay_json *root,
                                   char **text_out, size_t *count_out);

/* ---- gltf_buffer.c ---- */

assay_status assay_gltf_load_buffers(assay_gltf_loader *loader);

/* The bytes of a buffer view.  Errors: FORMAT (beyond its buffer). */
assay_status assay_gltf_view_bytes(const assay_gltf_loader *loader, uint32_t view,
                                   const uint8_t **bytes_out, uint64_t *count_out);

/* ---- gltf_accessor.c ---- */

/* What a use of an accessor asks of it. */
typedef struct {
    char     place[128];    /* for messages: "meshes/3/primitives/0: accessor 7 (POSITION)"    */
    uint32_t columns, rows; /* what its type must be                                           */
    bool     whole;         /* unsigned integers as they are, not numbers                      */
    bool     needs_unit;    /* integers must be normalized                                     */
    bool     vertex;        /* strides count                                                   */
} assay_gltf_use;

/* Checks type, component type and every byte range of an accessor.  Errors: FORMAT, LIMIT. */
assay_status assay_gltf_check_accessor(assay_gltf_loader *loader, uint32_t accessor,
                                       const assay_gltf_use *use);

/* Reads `count` elements: the first ones, or those that `chosen` lists in ascending order, integers
 * normalized where the accessor says so, sparse ones put in.  Element i starts at
 * (*values)[i * stride + first].  Where *values is NULL it is allocated, zeros, count * stride; it
 * is the caller's, on errors too.  The accessor was checked, and has the elements.
 * Errors: FORMAT (NaN, infinite, sparse indices), LIMIT, MEMORY. */
assay_status assay_gltf_read_floats(assay_gltf_loader *loader, uint32_t accessor,
                                    const assay_gltf_use *use, const uint32_t *chosen,
                                    uint32_t count, uint32_t stride, uint32_t first,
                                    float **values);

/* The same for unsigned integers. */
assay_status assay_gltf_read_whole(assay_gltf_loader *loader, uint32_t accessor,
                                   const assay_gltf_use *use, const uint32_t *chosen,
                                   uint32_t count, uint32_t stride, uint32_t first,
                                   uint32_t **values);

/* ---- the parts of a scene, in the order of their loading ---- */

assay_status assay_gltf_load_lights(assay_gltf_loader *loader);     /* gltf_light.c     */
assay_status assay_gltf_load_materials(assay_gltf_loader *loader);  /* gltf_material.c  */
assay_status assay_gltf_load_nodes(assay_gltf_loader *loader);      /* gltf_node.c      */
assay_status assay_gltf_load_meshes(assay_gltf_loader *loader);     /* gltf_mesh.c      */
assay_status assay_gltf_load_skins(assay_gltf_loader *loader);      /* gltf_skin.c      */
assay_status assay_gltf_load_animations(assay_gltf_loader *loader); /* gltf_animation.c */
assay_status assay_gltf_load_textures(assay_gltf_loader *loader);   /* gltf_texture.c   */

/* extras.assay of a material (gltf_brdf.c).  Errors: FORMAT. */
assay_status assay_gltf_load_brdf(assay_gltf_loader *loader, const assay_json *extras,
                                  const char *place, assay_material *material);

#endif
