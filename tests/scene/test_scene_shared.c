/* test_scene_shared.c - every shared scene loads or is refused for a stated reason; the table of it
 * is printed. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "scene/scene_data.h"
#include "support/gltf_maker.h"

enum { MAX_SCENES = 200, MAX_PATH = 512 };

typedef struct {
    char (*paths)[MAX_PATH];
    int count;
} list;

static bool ends_with(const char *text, const char *end)
{
    const size_t a = strlen(text), b = strlen(end);
    return a > b && strcmp(text + a - b, end) == 0;
}

/* Folders are at most four deep. */
static void find_scenes(const char *folder, int depth, list *found)
{
    DIR *open = opendir(folder);
    if (!open) {
        return;
    }
    for (const struct dirent *e = readdir(open); e; e = readdir(open)) {
        char        path[MAX_PATH];
        struct stat about;
        if (e->d_name[0] == '.' ||
            snprintf(path, sizeof path, "%s/%s", folder, e->d_name) >= (int)sizeof path ||
            stat(path, &about) != 0) {
            continue;
        }
        if (S_ISDIR(about.st_mode) && depth < 4) {
            find_scenes(path, depth + 1, found);
        } else if ((ends_with(path, ".gltf") || ends_with(path, ".glb")) &&
                   found->count < MAX_SCENES) {
            strcpy(found->paths[found->count++], path);
        }
    }
    closedir(open);
}

static int compare_paths(const void *a, const void *b) { return strcmp(a, b); }

/* Whether the scene is whole: indices in range, materials there, everything finite. */
static void check_whole(const assay_scene *scene)
{
    for (size_t i = 0; i < (size_t)scene->triangle_count * 3; i++) {
        const assay_shape *s = &scene->shapes[scene->triangle_shape[i / 3]];
        assert_true(scene->indices[i] >= s->first_vertex &&
                    scene->indices[i] < s->first_vertex + s->vertex_count);
        assert_true(s->material < scene->material_count);
    }
    for (size_t i = 0; i < (size_t)scene->vertex_count * 3; i++) {
        assert_true(isfinite(scene->positions[i]));
    }
    for (uint32_t i = 0; i < scene->shape_count; i++) {
        for (size_t v = 0; scene->shapes[i].normals && v < scene->shapes[i].vertex_count; v++) {
            const float *n      = scene->shapes[i].normals + 3 * v;
            const double length = vec3_length(vec3(n[0], n[1], n[2]));
            assert_true(length == 0.0 || fabs(length - 1.0) < 1e-6);
        }
    }
}

/* The two most common warnings as two words each. */
static const char *short_warning(const char *warning)
{
    return strncmp(warning, "nothing in the scene emits", 26) == 0 ? "no light"
           : strncmp(warning, "the scene has no camera", 23) == 0  ? "no camera"
                                                                   : warning;
}

static void print_scene(const char *name, const assay_scene *scene)
{
    const assay_scene_info i           = assay_scene_describe(scene);
    char                   notes[2048] = "";
    for (uint32_t w = 0; w < i.warnings; w++) {
        const size_t used = strlen(notes);
        snprintf(notes + used, sizeof notes - used, "%s%s", w ? "; " : "",
                 short_warning(assay_scene_warning(scene, w)));
    }
    print_message("%-62s %8u %4u %4u %3u %3u %6u %5g %s\n", name, i.triangles, i.materials,
                  i.images, i.cameras, i.point_lights + i.spot_lights + i.directional_lights,
                  i.emissive_triangles, i.duration, notes);
}

static const char *shared_folder(void)
{
    const char *folder = getenv("ASSAY_SHARED_SCENES");
    struct stat about;
    folder = folder ? folder : "../shared/scenes";
    return stat(folder, &about) == 0 ? folder : NULL;
}

static void test_shared_scenes(void **state)
{
    const char *folder = shared_folder();
    list        found  = {calloc(MAX_SCENES, MAX_PATH), 0};
    (void)state;
    if (!folder) {
        free(found.paths);
        skip();
    }
    find_scenes(folder, 0, &found);
    qsort(found.paths, (size_t)found.count, MAX_PATH, compare_paths);
    print_message("%-62s %8s %4s %4s %3s %3s %6s %5s %s\n", "scene", "triang.", "mat.", "img.",
                  "cam", "lgt", "emit.", "s", "warnings, or why it is refused");
    int loaded = 0;
    for (int i = 0; i < found.count; i++) {
        assay_context     *context = gltf_context();
        assay_scene       *scene   = NULL;
        const char        *name    = found.paths[i] + strlen(folder) + 1;
        const assay_status status  = assay_scene_load(context, found.paths[i], NULL, &scene);
        if (status == ASSAY_OK) {
            print_scene(name, scene);
            check_whole(scene);
            assert_int_equal(assay_scene_set_time(scene, 0.3), ASSAY_OK);
            check_whole(scene);
            loaded++;
        } else {
            print_message("%-62s %s: %s\n", name, assay_status_text(status),
                          assay_context_error(context));
            assert_true(status == ASSAY_ERR_UNSUPPORTED || status == ASSAY_ERR_FORMAT ||
                        status == ASSAY_ERR_LIMIT);
        }
        assay_scene_destroy(scene);
        assay_context_destroy(context);
    }
    print_message("%d of %d scenes load\n", loaded, found.count);
    free(found.paths);
    assert_true(found.count == 0 || loaded > 0);
}

/* Facts that the samples state about themselves, so that a loader that loads the wrong thing is
 * seen: file, triangles, cameras, largest corner of the bounds. */
static void test_known_samples(void **state)
{
    static const struct {
        const char *path;
        uint32_t    triangles, cameras;
        assay_vec3  low, high; /* as the accessors' min and max say, through the nodes */
    } samples[] = {
        {"khronos/Box/glTF/Box.gltf", 12, 0, {-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}},
        {"khronos/Box/glTF-Binary/Box.glb", 12, 0, {-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}},
        {"khronos/Box/glTF-Embedded/Box.gltf", 12, 0, {-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}},
        {"khronos/Triangle/glTF/Triangle.gltf", 1, 0, {0, 0, 0}, {1, 1, 0}},
        {"khronos/SimpleMeshes/glTF/SimpleMeshes.gltf", 2, 0, {0, 0, 0}, {2, 1, 0}},
        {"khronos/Cameras/glTF/Cameras.gltf", 2, 2, {0, 0, -0.70759}, {1, 0.706623, 0}},
        {"khronos/SimpleSkin/glTF/SimpleSkin.gltf", 8, 0, {-0.5, 0, 0}, {0.5, 2, 0}},
        {"khronos/TwoSidedPlane/glTF/TwoSidedPlane.gltf", 2, 0, {-1, 0, -1}, {1, 0, 1}},
    };
    const char *folder = shared_folder();
    (void)state;
    if (!folder) {
        skip();
    }
    for (size_t i = 0; i < sizeof samples / sizeof *samples; i++) {
        char           path[MAX_PATH];
        assay_context *context = gltf_context();
        assay_scene   *scene   = NULL;
        snprintf(path, sizeof path, "%s/%s", folder, samples[i].path);
        if (assay_scene_load(context, path, NULL, &scene) != ASSAY_OK) {
            fail_msg("%s", assay_context_error(context));
        }
        const assay_scene_info info = assay_scene_describe(scene);
        assert_int_equal(info.triangles, samples[i].triangles);
        assert_int_equal(info.cameras, samples[i].cameras);
        assert_true(vec3_length(vec3_sub(info.bounds_min, samples[i].low)) < 1e-5);
        assert_true(vec3_length(vec3_sub(info.bounds_max, samples[i].high)) < 1e-5);
        assay_scene_destroy(scene);
        assay_context_destroy(context);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_shared_scenes),
        cmocka_unit_test(test_known_samples),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
