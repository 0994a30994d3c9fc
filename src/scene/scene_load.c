/* scene_load.c - a scene from a file or from memory: the steps in their order.
 *
 * Invariant: either a whole scene comes out, or nothing does and everything is released. */
#include <assert.h>
#include <locale.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "assay/image.h"
#include "core/alloc.h"
#include "core/context.h"
#include "io/image_decode.h"
#include "scene/environment.h"
#include "scene/gltf_loader.h"
#include "scene/scene_build.h"
#include "scene/scene_text.h"

assay_scene_options assay_scene_options_default(void)
{
    return (assay_scene_options){.scene_index = -1, .environment_scale = 1.0};
}

static assay_status check_options(assay_context *context, const assay_scene_options *o)
{
    const double b[3]  = {o->background.r, o->background.g, o->background.b};
    bool         sound = o->scene_index >= -1;
    if (!sound) {
        return assay_fail(context, ASSAY_ERR_ARGUMENT, "scene index %d: must be -1 or more",
                          o->scene_index);
    }
    if (!(o->environment_scale >= 0.0) || !isfinite(o->environment_scale)) {
        return assay_fail(context, ASSAY_ERR_ARGUMENT,
                          "environment scale %g: must be finite and at least 0",
                          o->environment_scale);
    }
    if (!isfinite(o->environment_rotation)) {
        return assay_fail(context, ASSAY_ERR_ARGUMENT, "environment rotation %g: must be finite",
                          o->environment_rotation);
    }
    for (int c = 0; c < 3; c++) {
        sound = sound && b[c] >= 0.0 && isfinite(b[c]);
    }
    return sound ? ASSAY_OK
                 : assay_fail(context, ASSAY_ERR_ARGUMENT,
                              "background %g, %g, %g: must be finite and at least 0", b[0], b[1],
                              b[2]);
}

/* ---- the document ---- */

static void note_extension(void *user, const char *name)
{
    assay_gltf_loader *loader = user;
    assay_scene       *scene  = loader->scene;
    char               clean[ASSAY_GLTF_MAX_NAME], line[ASSAY_GLTF_MAX_NAME + 64];
    assay_text_clean(name, clean, sizeof clean);
    snprintf(line, sizeof line, "the extension %s is not supported and ignored", clean);
    for (uint32_t i = 0; i < scene->warning_count; i++) {
        if (strcmp(scene->warnings[i], line) == 0) {
            return;
        }
    }
    assay_scene_warn(scene, "%s", line);
}

/* Keeps extensionsUsed for the report. */
static assay_status keep_extensions(assay_gltf_loader *loader)
{
    enum { MOST = 100 };
    const assay_json *array = assay_json_member(loader->json.nodes, "extensionsUsed");
    assay_scene      *scene = loader->scene;
    const uint32_t    count = array ? (array->count < MOST ? array->count : MOST) : 0;
    const assay_json *from  = array ? array->child : NULL;
    scene->extensions       = assay_allocate(loader->context, count, sizeof *scene->extensions);
    if (!scene->extensions) {
        return assay_fail_memory(loader->context, "the scene's extensions");
    }
    for (uint32_t i = 0; i < count; i++, from = from->next) {
        scene->extensions[i] = assay_gltf_copy_name(loader->context, from->text);
        if (!scene->extensions[i]) {
            return assay_fail_memory(loader->context, "the scene's extensions");
        }
        scene->extension_count++;
    }
    return ASSAY_OK;
}

/* Text to tree, tree checked, and what tinygltf makes of it. */
static assay_status read_document(assay_gltf_loader *loader)
{
    char        *text   = NULL;
    size_t       count  = 0;
    assay_status status = assay_json_read(loader->context, loader->file, loader->text,
                                          loader->text_count, &loader->json);
    loader->schema      = (assay_gltf_schema){.context      = loader->context,
                                              .file         = loader->file,
                                              .on_extension = note_extension,
                                              .user         = loader};
    if (status == ASSAY_OK) {
        status = assay_gltf_check_document(&loader->schema, loader->json.nodes);
    }
    if (status == ASSAY_OK) {
        status = keep_extensions(loader);
    }
    if (status == ASSAY_OK) {
        status =
            assay_gltf_write_text(loader->context, loader->file, loader->json.nodes, &text, &count);
    }
    if (status == ASSAY_OK) {
        status = assay_gltf_parse(loader->context, loader->file, text, count, &loader->document);
    }
    assay_release(loader->context, text);
    return status;
}

static assay_status build_shapes(assay_gltf_loader *loader)
{
    return assay_scene_build_shapes(loader->scene, loader->file);
}

static assay_status build_scratch(assay_gltf_loader *loader)
{
    return assay_scene_build_scratch(loader->scene);
}

/* Until here the hash has seen the scene's own files alone; a copy of it ends here. */
static void finish_files_digest(const assay_gltf_loader *loader)
{
    assay_hash files = loader->hash;
    assay_hash_finish(&files, loader->scene->files_digest);
}

static void digest_of(const assay_gltf_bytes *bytes, char digest_out[65])
{
    assay_hash hash;
    assay_hash_start(&hash);
    assay_hash_add(&hash, bytes->bytes, (size_t)bytes->count);
    assay_hash_finish(&hash, digest_out);
}

static assay_status load_environment(assay_gltf_loader *loader)
{
    const assay_scene_options *options = &loader->scene->options;
    assay_gltf_bytes           bytes   = {0};
    assay_image               *image   = NULL;
    finish_files_digest(loader);
    if (!options->environment_path) {
        return ASSAY_OK;
    }
    char name[512];
    assay_text_clean(options->environment_path, name, sizeof name);
    assay_status status = assay_gltf_read_file(loader, options->environment_path, name, &bytes);
    if (status == ASSAY_OK) {
        static const char *const channels[] = {"R", "G", "B", NULL};
        digest_of(&bytes, loader->scene->environment_digest);
        status = assay_image_decode(loader->context, bytes.bytes, (size_t)bytes.count, name,
                                    channels, &image);
    }
    assay_gltf_release_bytes(loader->context, &bytes);
    if (status == ASSAY_OK) {
        status = assay_environment_create(loader->context, image, options->environment_scale,
                                          options->environment_rotation, options->environment_path,
                                          &loader->scene->environment);
    }
    assay_image_destroy(image);
    return status;
}

typedef assay_status (*load_step)(assay_gltf_loader *);

static assay_status load_all(assay_gltf_loader *loader)
{
    static const load_step steps[] = {
        assay_gltf_load_buffers,
        assay_gltf_load_lights,
        assay_gltf_load_materials,
        assay_gltf_load_nodes,
        assay_gltf_load_meshes,
        build_shapes,
        assay_gltf_load_skins,
        assay_gltf_load_animations,
        assay_gltf_load_textures,
        load_environment,
        build_scratch,
    };
    const uint32_t *lengths = loader->schema.lengths;
    loader->steps = 2 + (uint64_t)lengths[ASSAY_GLTF_BUFFERS] + lengths[ASSAY_GLTF_MESHES] +
                    lengths[ASSAY_GLTF_IMAGES];
    assay_status status = assay_gltf_step(loader);
    for (size_t i = 0; i < sizeof steps / sizeof *steps && status == ASSAY_OK; i++) {
        status = steps[i](loader);
    }
    return status;
}

/* ---- the whole ---- */

/* The options count, too: the same file with another background is another scene. */
static void finish_digest(assay_gltf_loader *loader)
{
    const assay_scene_options *o = &loader->scene->options;
    char                       text[256];
    snprintf(text, sizeof text,
             "scene=%d env=%d scale=%a rotation=%a background=%a,%a,%a "
             "force_diffuse=%d solid_transmission=%d",
             o->scene_index, o->environment_path != NULL, o->environment_scale,
             o->environment_rotation, o->background.r, o->background.g, o->background.b,
             o->force_diffuse, o->solid_transmission);
    assay_hash_add_text(&loader->hash, text);
    assay_hash_finish(&loader->hash, loader->scene->digest);
}

static void warn_of_emptiness(assay_scene *scene)
{
    if (scene->triangle_count == 0) {
        assay_scene_warn(scene, "the scene has no triangles");
    }
    if (!assay_scene_describe(scene).has_light) {
        assay_scene_warn(scene, "nothing in the scene emits light: its images are black without an "
                                "environment or a background");
    }
    if (scene->camera_is_made) {
        assay_scene_warn(scene, "the scene has no camera: one that frames it is used");
    }
}

static assay_status load_bytes(assay_gltf_loader *loader, const uint8_t *bytes, size_t count)
{
    /* The decimal point of a caller's locale must not change what a number means. */
    const locale_t plain = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    if (plain == (locale_t)0) {
        return assay_fail_memory(loader->context, "a locale");
    }
    const locale_t before = uselocale(plain);
    assay_status   status = assay_gltf_split(loader, bytes, count);
    if (status == ASSAY_OK) {
        status = read_document(loader);
    }
    if (status == ASSAY_OK) {
        status = load_all(loader);
    }
    if (status == ASSAY_OK) {
        status = assay_scene_evaluate(loader->scene, 0.0);
    }
    if (status == ASSAY_OK) {
        finish_digest(loader);
        warn_of_emptiness(loader->scene);
        loader->steps_done = loader->steps;
        status             = assay_gltf_step(loader);
    }
    if (status == ASSAY_OK && loader->scene->warnings_lost) {
        status = assay_fail_memory(loader->context, "a warning");
    }
    uselocale(before);
    freelocale(plain);
    return status;
}

static assay_status make_scene(assay_context *context, const char *name,
                               const assay_scene_options *options, assay_scene **scene_out)
{
    char         clean[512];
    assay_scene *scene = assay_allocate(context, 1, sizeof *scene);
    if (!scene) {
        return assay_fail_memory(context, "a scene");
    }
    assay_text_clean(name, clean, sizeof clean);
    scene->context                  = context;
    scene->options                  = *options;
    scene->options.environment_path = NULL;
    scene->path                     = assay_copy_text(context, clean);
    if (options->environment_path) {
        scene->options.environment_path = assay_copy_text(context, options->environment_path);
    }
    if (!scene->path || (options->environment_path && !scene->options.environment_path)) {
        assay_scene_destroy(scene);
        return assay_fail_memory(context, "a scene");
    }
    *scene_out = scene;
    return ASSAY_OK;
}

/* bytes NULL: read from the path `name`. */
static assay_status load(assay_context *context, const uint8_t *bytes, size_t count,
                         const char *name, const char *folder, const assay_scene_options *options,
                         assay_scene **scene_out)
{
    const assay_scene_options defaults = assay_scene_options_default();
    assay_gltf_loader         loader   = {.context = context, .folder = folder};
    assay_gltf_bytes          file     = {.bytes = bytes, .count = count};
    assay_status              status   = check_options(context, options ? options : &defaults);
    if (status == ASSAY_OK) {
        status = make_scene(context, name, options ? options : &defaults, &loader.scene);
    }
    if (status != ASSAY_OK) {
        return status;
    }
    assert(loader.scene);
    loader.file = loader.scene->path;
    assay_hash_start(&loader.hash);
    if (bytes) {
        assay_hash_add(&loader.hash, &file.count, sizeof file.count);
        assay_hash_add(&loader.hash, bytes, count);
    } else {
        status = assay_gltf_read_file(&loader, name, loader.file, &file);
    }
    if (status == ASSAY_OK) {
        status = load_bytes(&loader, file.bytes, (size_t)file.count);
    }
    assay_gltf_loader_release(&loader);
    assay_gltf_release_bytes(context, &file);
    if (status != ASSAY_OK) {
        assay_scene_destroy(loader.scene);
        return status;
    }
    *scene_out = loader.scene;
    return ASSAY_OK;
}

assay_status assay_scene_load(assay_context *context, const char *path,
                              const assay_scene_options *options, assay_scene **scene_out)
{
    const char *slash  = strrchr(path, '/');
    char       *folder = assay_copy_text(context, path);
    if (!folder) {
        return assay_fail_memory(context, "a path");
    }
    folder[slash ? (slash == path ? 1 : slash - path) : 0] = 0;
    const assay_status status = load(context, NULL, 0, path, folder, options, scene_out);
    assay_release(context, folder);
    return status;
}

assay_status assay_scene_load_memory(assay_context *context, const uint8_t *bytes, size_t count,
                                     const char *name, const char *folder,
                                     const assay_scene_options *options, assay_scene **scene_out)
{
    static const uint8_t nothing = 0;
    return load(context, bytes ? bytes : &nothing, bytes ? count : 0, name, folder, options,
                scene_out);
}

assay_status assay_scene_set_time(assay_scene *scene, double seconds)
{
    if (!isfinite(seconds)) {
        return assay_fail(scene->context, ASSAY_ERR_DOMAIN, "time %g s: must be finite", seconds);
    }
    if (scene->is_static) {
        scene->time = seconds;
        return ASSAY_OK;
    }
    return assay_scene_evaluate(scene, seconds);
}
