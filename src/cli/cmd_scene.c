/* cmd_scene.c - `assay scene SCENE.gltf [--json]`. */
#include <stdio.h>

#include "console.h"
#include "options.h"
#include "scene_options.h"

typedef struct {
    const char       *path;
    cli_scene_request options;
    uint64_t          memory_limit;
    bool              json, help;
} scene_request;

enum { OPT_JSON, OPT_MEMORY, OPT_HELP };
static const cli_option OPTIONS[] = {{"json", 0, NULL, "print JSON"},
                                     CLI_MEMORY_OPTION,
                                     {"help", 'h', NULL, "this text"},
                                     CLI_SCENE_OPTIONS,
                                     {0}};

static const char *take(void *user, int index, const char *value)
{
    scene_request *request = user;
    const char    *problem = NULL;
    switch (index) {
    case OPT_JSON: request->json = true; return NULL;
    case OPT_MEMORY: return cli_read_bytes(value, &request->memory_limit);
    case OPT_HELP: request->help = true; return NULL;
    default: break;
    }
    if (index >= 0) {
        cli_scene_option(&request->options, OPTIONS[index].name, value, &problem);
        return problem;
    }
    if (request->path) {
        return "one scene at a time";
    }
    request->path = value;
    return NULL;
}

static void print_scene(const char *path, const assay_scene *scene)
{
    const assay_scene_info i = assay_scene_describe(scene);
    printf("%s\n", path);
    printf("  triangles   %u (vertices %u, meshes %u, instances %u, nodes %u)\n", i.triangles,
           i.vertices, i.meshes, i.instances, i.nodes);
    printf("  bounds      %.6g %.6g %.6g ... %.6g %.6g %.6g m\n", i.bounds_min.x, i.bounds_min.y,
           i.bounds_min.z, i.bounds_max.x, i.bounds_max.y, i.bounds_max.z);
    printf("  materials   %u (textures %u, images %u)\n", i.materials, i.textures, i.images);
    printf("  lights      %u emissive triangles, %u point, %u spot, %u directional%s\n",
           i.emissive_triangles, i.point_lights, i.spot_lights, i.directional_lights,
           i.has_environment ? ", environment map" : "");
    printf("  animations  %u (%.6g s), skins %u\n", i.animations, i.duration, i.skins);
    for (uint32_t c = 0; c < i.cameras; c++) {
        printf("  camera %-4u %s\n", c, assay_scene_camera_name(scene, c));
    }
    for (uint32_t w = 0; w < i.warnings; w++) {
        printf("  warning     %s\n", assay_scene_warning(scene, w));
    }
    printf("  digest      %s\n", assay_scene_digest(scene));
}

static assay_status report(assay_context *context, const scene_request *request)
{
    assay_scene *scene = NULL;
    char        *text  = NULL;
    assay_status status =
        assay_scene_load(context, request->path, &request->options.options, &scene);
    if (status == ASSAY_OK && request->json) {
        status = assay_scene_report_json(scene, &text);
        if (status == ASSAY_OK) {
            puts(text);
        }
    } else if (status == ASSAY_OK) {
        print_scene(request->path, scene);
    }
    assay_text_destroy(context, text);
    assay_scene_destroy(scene);
    return status;
}

int cli_scene(int count, char **argv)
{
    scene_request request = {.options = cli_scene_request_default()};
    cli_console   console;
    if (!cli_parse("scene", count, argv, OPTIONS, take, NULL, &request)) {
        return CLI_EXIT_USAGE;
    }
    if (request.help) {
        printf("usage: assay scene SCENE.gltf [--json] ...\n");
        cli_print_options(OPTIONS);
        return 0;
    }
    const char *problem =
        request.path && *request.path ? cli_scene_check(&request.options) : "no scene given";
    if (problem) {
        cli_complain("scene", "%s (assay scene --help lists the options)", problem);
        return CLI_EXIT_USAGE;
    }
    /* Warnings are part of the report; they are not said twice. */
    assay_context *context = cli_console_open(&console, "scene", true, 0, request.memory_limit);
    if (!context) {
        return assay_status_exit_code(ASSAY_ERR_MEMORY);
    }
    const int code = cli_console_finish(&console, context, report(context, &request));
    assay_context_destroy(context);
    return code;
}
