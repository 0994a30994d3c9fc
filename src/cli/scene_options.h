/* scene_options.h - the options by which every command takes a scene. */
#ifndef ASSAY_CLI_SCENE_OPTIONS_H
#define ASSAY_CLI_SCENE_OPTIONS_H

#include "assay/scene.h"

typedef struct {
    assay_scene_options options;
    bool                has_background, has_scale, has_rotation; /* given, whatever the value */
} cli_scene_request;

cli_scene_request cli_scene_request_default(void);

/* To be put into a table of options; the handler of a command passes such names on. */
#define CLI_SCENE_OPTIONS                                                                          \
    {"scene-index", 0, "N", "which glTF scene (default: the file's own)"},                         \
        {"env", 0, "F", "environment map, latitude-longitude, .exr or .hdr"},                      \
        {"env-scale", 0, "S", "radiance of --env times S"},                                        \
        {"env-rotation-deg", 0, "D", "--env turned about +Y, counter-clockwise from above"},       \
        {"background", 0, "R,G,B", "constant radiance from outside, instead of --env"},            \
        {"force-diffuse", 0, NULL, "all surfaces two-sided Lambertian of their base colour"},      \
    {                                                                                              \
        "solid-transmission", 0, NULL, "transmissive materials without a volume refract"           \
    }

/* True where the name is one of these, with *problem set to NULL or to what is wrong. */
bool cli_scene_option(cli_scene_request *request, const char *name, const char *value,
                      const char **problem);

/* What the options say together; NULL, or what is wrong. */
const char *cli_scene_check(const cli_scene_request *request);

#endif
