/* gltf_schema.h - the shape of a glTF document as a table, and the walk that checks a text by it.
 */
#ifndef ASSAY_SCENE_GLTF_SCHEMA_H
#define ASSAY_SCENE_GLTF_SCHEMA_H

#include "scene/gltf_json.h"

/* Arrays of the root that indices point into; lights are those of KHR_lights_punctual. */
typedef enum {
    ASSAY_GLTF_ACCESSORS,
    ASSAY_GLTF_ANIMATIONS,
    ASSAY_GLTF_BUFFERS,
    ASSAY_GLTF_BUFFER_VIEWS,
    ASSAY_GLTF_CAMERAS,
    ASSAY_GLTF_IMAGES,
    ASSAY_GLTF_LIGHTS,
    ASSAY_GLTF_MATERIALS,
    ASSAY_GLTF_MESHES,
    ASSAY_GLTF_NODES,
    ASSAY_GLTF_SAMPLERS,
    ASSAY_GLTF_SCENES,
    ASSAY_GLTF_SKINS,
    ASSAY_GLTF_TEXTURES,
    ASSAY_GLTF_ARRAY_COUNT
} assay_gltf_array;

typedef enum {
    ASSAY_GLTF_COUNT,      /* whole number in [minimum, maximum]; maximum 0: 1e14        */
    ASSAY_GLTF_NUMBER,     /* in [minimum, maximum]; both 0: any                         */
    ASSAY_GLTF_NUMBERS,    /* array of `count` such numbers; count 0: any length         */
    ASSAY_GLTF_TEXT,       /* string                                                     */
    ASSAY_GLTF_TEXTS,      /* array of strings                                           */
    ASSAY_GLTF_BOOL,       /* true or false                                              */
    ASSAY_GLTF_WORD,       /* one of the words of `what`, separated by '|'               */
    ASSAY_GLTF_CODE,       /* one of the whole numbers of `what`, separated by '|'       */
    ASSAY_GLTF_INDEX,      /* whole number below the length of `array`                   */
    ASSAY_GLTF_INDICES,    /* array of at least one of these                             */
    ASSAY_GLTF_INDEX_MAP,  /* object with only such members                              */
    ASSAY_GLTF_INDEX_MAPS, /* array of these objects                                     */
    ASSAY_GLTF_OBJECT,     /* object of type `what`                                      */
    ASSAY_GLTF_OBJECTS     /* array of these                                             */
} assay_gltf_kind;

/* One member of an object. */
typedef struct {
    const char      *member;
    const char      *what;
    double           minimum, maximum;
    assay_gltf_kind  kind;
    assay_gltf_array array;
    int              count;
    bool             required;
    bool             above; /* greater than the minimum, not equal to it */
} assay_gltf_rule;

/* A type of object: at most 32 members.  Members that no rule names are left alone, as glTF asks,
 * or refused where the type is strict.  An extension's object is the type "material.KHR_...". */
typedef struct {
    const char            *name;
    const assay_gltf_rule *rules;
    int                    rule_count;
    bool                   strict;
} assay_gltf_type;

/* NULL where there is no such type. */
const assay_gltf_type *assay_gltf_find_type(const char *name);
/* Whether assay does what an extension asks for. */
bool assay_gltf_extension_supported(const char *name);

/* Told once an object of an unsupported extension; may be told the same name again. */
typedef void (*assay_gltf_on_extension)(void *user, const char *name);

typedef struct {
    assay_context          *context;
    const char             *file;                            /* for messages */
    uint32_t                lengths[ASSAY_GLTF_ARRAY_COUNT]; /* filled by the check */
    assay_gltf_on_extension on_extension;
    void                   *user;
} assay_gltf_schema;

/* Checks the version, the required extensions and then everything that the table names, indices
 * against the arrays that they point into.  The message names file and place
 * ("scene.gltf: nodes/3/mesh: ...").  Errors: FORMAT, UNSUPPORTED. */
assay_status assay_gltf_check_document(assay_gltf_schema *schema, const assay_json *root);

/* Checks one object by a type; `place` names it in messages. */
assay_status assay_gltf_check_object(assay_gltf_schema *schema, const assay_json *object,
                                     const char *type, const char *place);

#endif
