/* scene_options.c - from words to assay_scene_options. */
#include "scene_options.h"

#include <string.h>

#include "options.h"

static const char *read_not_negative(const char *text, double *value)
{
    double      read;
    const char *problem = cli_read_real(text, &read);
    if (problem || read < 0.0) {
        return "takes a number >= 0";
    }
    *value = read;
    return NULL;
}

static const char *read_index(const char *text, int *value)
{
    long        read;
    const char *problem = cli_read_count(text, 0, 1000000, &read);
    if (!problem) {
        *value = (int)read;
    }
    return problem ? "takes a whole number from 0" : NULL;
}

static const char *read_background(const char *text, assay_rgb *value)
{
    double      v[3];
    const char *problem = cli_read_triple(text, v);
    if (problem || v[0] < 0.0 || v[1] < 0.0 || v[2] < 0.0) {
        return "takes three numbers >= 0, as in 1,0.5,0";
    }
    *value = (assay_rgb){v[0], v[1], v[2]};
    return NULL;
}

static const char *read_degrees(const char *text, double *radians)
{
    double      degrees;
    const char *problem = cli_read_real(text, &degrees);
    if (!problem) {
        *radians = degrees * (3.14159265358979323846 / 180.0);
    }
    return problem;
}

cli_scene_request cli_scene_request_default(void)
{
    return (cli_scene_request){.options = assay_scene_options_default()};
}

bool cli_scene_option(cli_scene_request *request, const char *name, const char *value,
                      const char **problem)
{
    assay_scene_options *options = &request->options;
    *problem                     = NULL;
    if (strcmp(name, "scene-index") == 0) {
        *problem = read_index(value, &options->scene_index);
    } else if (strcmp(name, "env") == 0) {
        options->environment_path = value;
        *problem                  = *value ? NULL : "takes the name of a file";
    } else if (strcmp(name, "env-scale") == 0) {
        request->has_scale = true;
        *problem           = read_not_negative(value, &options->environment_scale);
    } else if (strcmp(name, "env-rotation-deg") == 0) {
        request->has_rotation = true;
        *problem              = read_degrees(value, &options->environment_rotation);
    } else if (strcmp(name, "background") == 0) {
        request->has_background = true;
        *problem                = read_background(value, &options->background);
    } else if (strcmp(name, "force-diffuse") == 0) {
        options->force_diffuse = true;
    } else if (strcmp(name, "solid-transmission") == 0) {
        options->solid_transmission = true;
    } else {
        return false;
    }
    return true;
}

const char *cli_scene_check(const cli_scene_request *request)
{
    const bool map = request->options.environment_path != NULL;
    if (map && request->has_background) {
        return "--env and --background: the one takes the place of the other";
    }
    if (!map && request->has_scale) {
        return "--env-scale without --env does nothing";
    }
    if (!map && request->has_rotation) {
        return "--env-rotation-deg without --env does nothing";
    }
    return NULL;
}
