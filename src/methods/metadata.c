/* metadata.c - Invariant: every option that can change a pixel changes an attribute, and nothing
 * else does: no time, no path of this machine, no number of threads. */
#include "methods/metadata.h"

#include <stdio.h>
#include <string.h>

#include "scene/scene_text.h"

/* An image and how far its description went. */
typedef struct {
    assay_image *image;
    assay_status status;
} description;

static void set_text(description *d, const char *name, const char *value)
{
    if (d->status == ASSAY_OK) {
        d->status = assay_image_set_attribute(d->image, name, value);
    }
}

static void set_switch(description *d, const char *name, bool on)
{
    set_text(d, name, on ? "on" : "off");
}

static void set_triple(description *d, const char *name, double x, double y, double z)
{
    char text[96];
    snprintf(text, sizeof text, "%.17g %.17g %.17g", x, y, z);
    set_text(d, name, text);
}

static void set_vector(description *d, const char *name, assay_vec3 v)
{
    set_triple(d, name, v.x, v.y, v.z);
}

static void set_number(description *d, const char *name, double x)
{
    char text[32];
    snprintf(text, sizeof text, "%.17g", x);
    set_text(d, name, text);
}

/* Without its folder: where a file lies says nothing about the image. */
static void set_file(description *d, const char *name, const char *path)
{
    char        clean[512];
    const char *slash = strrchr(path, '/');
    assay_text_clean(slash ? slash + 1 : path, clean, sizeof clean);
    set_text(d, name, clean);
}

static void describe_surroundings(description *d, const assay_scene *scene)
{
    const assay_scene_options *o = &scene->options;
    if (!scene->environment) {
        set_triple(d, "assay:scene.background", o->background.r, o->background.g, o->background.b);
        return;
    }
    set_file(d, "assay:scene.environment", o->environment_path);
    set_text(d, "assay:scene.environment.digest", scene->environment_digest);
    set_number(d, "assay:scene.environment.scale", o->environment_scale);
    set_number(d, "assay:scene.environment.rotation", o->environment_rotation);
}

static void describe_scene(description *d, const assay_scene *scene)
{
    const assay_scene_options *o = &scene->options;
    char                       index[16];
    snprintf(index, sizeof index, "%d", o->scene_index);
    set_file(d, "assay:scene.file", scene->path);
    set_text(d, "assay:scene.files_digest", scene->files_digest);
    set_text(d, "assay:scene.digest", scene->digest);
    set_text(d, "assay:scene.index", o->scene_index < 0 ? "default" : index);
    set_number(d, "assay:scene.time", scene->time);
    set_switch(d, "assay:scene.force_diffuse", o->force_diffuse);
    set_switch(d, "assay:scene.solid_transmission", o->solid_transmission);
    describe_surroundings(d, scene);
}

static void describe_camera(description *d, const assay_camera *camera)
{
    set_text(d, "assay:camera", camera->name);
    set_vector(d, "assay:camera.position", camera->position);
    set_vector(d, "assay:camera.forward", camera->forward);
    set_vector(d, "assay:camera.up", camera->up);
    set_vector(d, "assay:camera.right", camera->right);
    if (camera->orthographic) {
        set_number(d, "assay:camera.xmag", camera->xmag);
        set_number(d, "assay:camera.ymag", camera->ymag);
    } else {
        set_number(d, "assay:camera.yfov", camera->yfov);
    }
}

assay_status assay_metadata_add(assay_image *image, const assay_method *method,
                                const assay_params *params, const assay_frame *frame)
{
    char        text[96];
    description d = {image, ASSAY_OK};
    set_text(&d, "assay:version", assay_version());
    set_text(&d, "assay:method", method->name);
    snprintf(text, sizeof text, "%llu", (unsigned long long)frame->seed);
    set_text(&d, "assay:seed", text);
    describe_scene(&d, frame->world->scene);
    describe_camera(&d, frame->camera);
    if (method->keeps_light && frame->frames_before > 0) {
        snprintf(text, sizeof text, "%llu", (unsigned long long)frame->frames_before);
        set_text(&d, "assay:frames.before", text);
        set_number(&d, "assay:frames.since", frame->since);
    }
    for (const assay_param_desc *p = method->params; p->name; p++) {
        snprintf(text, sizeof text, "assay:%s.%s", method->name, p->name);
        set_text(&d, text, assay_params_text(params, p->name));
    }
    return d.status;
}
