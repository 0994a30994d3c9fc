/* test_own_scenes.c - the files in scenes/ are what their program writes, and well modelled. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "../../scenes/gen/own_scenes.h"
#include "../support/mesh_checks.h"
#include "../support/near.h"
#include "../support/temporary.h"
#include "assay/scene.h"

#define ROOT "scenes"

/* ---- files ---- */

static bool same_bytes(const uint8_t *a, size_t a_size, const uint8_t *b, size_t b_size)
{
    return a_size == b_size && memcmp(a, b, a_size) == 0;
}

static void compare_file(const char *folder, const char *name, const char *ending, size_t *total)
{
    char   kept[512], made[512];
    size_t kept_size, made_size;
    snprintf(kept, sizeof kept, ROOT "/%s/%s.%s", name, name, ending);
    snprintf(made, sizeof made, "%s/%s/%s.%s", folder, name, name, ending);
    uint8_t *const a = temporary_read(kept, &kept_size);
    uint8_t *const b = temporary_read(made, &made_size);
    if (!same_bytes(a, kept_size, b, made_size)) {
        fail_msg("%s is not what its program writes: make scenes", kept);
    }
    b[made_size / 2] ^= 1; /* mutant */
    assert_false(same_bytes(a, kept_size, b, made_size));
    *total += kept_size;
    free(a);
    free(b);
    assert_int_equal(remove(made), 0);
}

static void files_are_written_again(void **state)
{
    (void)state;
    temporary folder = temporary_create();
    size_t    total  = 0;
    for (int i = 0; i < OWN_SCENE_COUNT; i++) {
        const own_scene *const scene    = &own_scene_list()[i];
        gltf_document *const   document = scene->make();
        assert_true(gltf_write(document, folder.folder));
        gltf_destroy(document);
        compare_file(folder.folder, scene->name, "gltf", &total);
        compare_file(folder.folder, scene->name, "bin", &total);
        assert_int_equal(rmdir(temporary_path(&folder, scene->name)), 0);
    }
    assert_true(total < 3000000);
    temporary_destroy(&folder);
}

static void unwritable_folder_is_reported(void **state)
{
    (void)state;
    gltf_document *const document = make_furnace();
    assert_false(gltf_write(document, ROOT "/no such folder"));
    gltf_destroy(document);
}

/* ---- documents ---- */

static void documents_hold_together(void **state)
{
    (void)state;
    for (int i = 0; i < OWN_SCENE_COUNT; i++) {
        own_gltf scene = own_gltf_read(ROOT, own_scene_list()[i].name);
        own_gltf_release(&scene);
    }
}

static cJSON *field(cJSON *json, const char *array, int index, const char *key)
{
    return cJSON_GetObjectItemCaseSensitive(
        cJSON_GetArrayItem(cJSON_GetObjectItemCaseSensitive(json, array), index), key);
}

static void damaged_documents_are_noticed(void **state)
{
    (void)state;
    static const struct {
        const char *array, *key;
        int         index;
        double      change;
    } damages[]    = {{"buffers", "byteLength", 0, 4},   {"bufferViews", "byteLength", 1, 4},
                      {"accessors", "count", 0, -1},     {"accessors", "count", 1, 1},
                      {"accessors", "bufferView", 0, 7}, {"nodes", "mesh", 0, 99},
                      {"nodes", "camera", 8, 1},         {"accessors", "byteOffset", 2, 12}};
    own_gltf scene = own_gltf_read(ROOT, "cornell-box");
    for (size_t i = 0; i < sizeof damages / sizeof *damages; i++) {
        cJSON *const item = field(scene.json, damages[i].array, damages[i].index, damages[i].key);
        assert_non_null(item);
        const double before = item->valuedouble;
        cJSON_SetNumberValue(item, before + damages[i].change);
        assert_non_null(own_gltf_defect(scene.json, scene.bin, scene.bin_size));
        cJSON_SetNumberValue(item, before);
        assert_null(own_gltf_defect(scene.json, scene.bin, scene.bin_size));
    }
    own_gltf_release(&scene);
}

/* ---- geometry ---- */

/* Triangles after instancing, counted by hand from what each scene is made of. */
static size_t stated_triangles(const char *name)
{
    static const struct {
        const char *name;
        size_t      count;
    } stated[] = {{"cornell-box", 6 * 2 - 2 + 8 + 2 * 10},
                  {"cornell-box-glossy", 6 * 2 - 2 + 8 + 2 * 10},
                  {"furnace", 12},
                  {"furnace-sphere", 20 * 64},
                  {"rectangle-over-plane", 4},
                  {"two-plates", 4},
                  {"spheres", 8 * 20 * 64 + 3 * 2},
                  {"lobes", 3 * 20 * 256},
                  {"animated", 2 * 2 + 4 * 12 + 12 * 8 + 4}};
    for (size_t i = 0; i < sizeof stated / sizeof *stated; i++) {
        if (strcmp(stated[i].name, name) == 0) {
            return stated[i].count;
        }
    }
    return 0;
}

static void triangles_are_sound(void **state)
{
    (void)state;
    for (int i = 0; i < OWN_SCENE_COUNT; i++) {
        const char *const name  = own_scene_list()[i].name;
        own_gltf          scene = own_gltf_read(ROOT, name);
        own_mesh          soup  = own_gltf_flatten(&scene);
        for (int m = 0; m < scene.mesh_count; m++) {
            assert_int_equal(mesh_degenerate_triangles(&scene.meshes[m]), 0);
            assert_int_equal(mesh_wrong_normals(&scene.meshes[m]), 0);
        }
        assert_int_equal(mesh_degenerate_triangles(&soup), 0);
        assert_int_equal(mesh_coplanar_overlaps(&soup), 0);
        if (strcmp(name, "colonnade") == 0) {
            assert_in_range(soup.triangle_count, 60000, 100000);
        } else {
            assert_int_equal(soup.triangle_count, stated_triangles(name));
        }
        own_mesh_release(&soup);
        own_gltf_release(&scene);
    }
}

/* Every check must notice its own kind of damage. */
static void unsound_triangles_are_noticed(void **state)
{
    (void)state;
    own_gltf  scene  = own_gltf_read(ROOT, "spheres");
    own_mesh *sphere = &scene.meshes[0];
    double    smallest, sum;
    sphere->normals[3 * sphere->indices[30]] += 0.01f;
    assert_true(mesh_wrong_normals(sphere) >= 5);
    const uint32_t kept = sphere->indices[31];
    sphere->indices[31] = sphere->indices[30];
    assert_int_equal(mesh_degenerate_triangles(sphere), 1);
    sphere->indices[31] = sphere->indices[32];
    sphere->indices[32] = kept; /* one triangle turned over */
    assert_int_equal(mesh_degenerate_triangles(sphere), 0);
    assert_int_equal(mesh_unmatched_edges(sphere, NULL), 3);
    sphere->indices[32] = sphere->indices[31];
    sphere->indices[31] = kept;
    assert_int_equal(mesh_unmatched_edges(sphere, NULL), 0);
    mesh_volumes(sphere, &smallest, &sum);
    assert_true(smallest > 0.0);
    for (size_t t = 0; t < sphere->triangle_count; t++) { /* inside out */
        const uint32_t b           = sphere->indices[3 * t + 1];
        sphere->indices[3 * t + 1] = sphere->indices[3 * t + 2];
        sphere->indices[3 * t + 2] = b;
    }
    mesh_volumes(sphere, &smallest, &sum);
    assert_true(smallest < 0.0);
    assert_true(mesh_concave_edges(sphere) > 0);
    own_gltf_release(&scene);

    scene             = own_gltf_read(ROOT, "cornell-box");
    const char *two[] = {"floor", "ceiling", "floor"};
    own_mesh    soup  = own_gltf_join(&scene, two, 3);
    assert_int_equal(mesh_coplanar_overlaps(&soup), 2);
    own_mesh_release(&soup);
    own_gltf_release(&scene);
}

/* ---- what each scene promises ---- */

static bool on_the_floor(assay_vec3 a, assay_vec3 b) { return a.y == 0.0 && b.y == 0.0; }

static bool at_the_front(assay_vec3 a, assay_vec3 b) { return a.z == 0.0 && b.z == 0.0; }

/* Signed distance of a point in front of each triangle, the least of all. */
static double least_distance_in_front(const own_mesh *mesh, assay_vec3 point)
{
    double least = INFINITY;
    for (size_t t = 0; t < mesh->triangle_count; t++) {
        const assay_vec3 a = own_mesh_corner(mesh, t, 0);
        const assay_vec3 n = vec3_normalize(vec3_cross(vec3_sub(own_mesh_corner(mesh, t, 1), a),
                                                       vec3_sub(own_mesh_corner(mesh, t, 2), a)));
        const double     distance = vec3_dot(n, vec3_sub(point, a));
        least                     = distance < least ? distance : least;
    }
    return least;
}

static void cornell_box_is_the_measured_one(void **state)
{
    (void)state;
    static const char *const names[2] = {"cornell-box", "cornell-box-glossy"};
    static const char *const room[6]  = {"floor",     "light",      "ceiling",
                                         "back wall", "right wall", "left wall"};
    for (int i = 0; i < 2; i++) {
        own_gltf scene = own_gltf_read(ROOT, names[i]);
        own_mesh walls = own_gltf_join(&scene, room, 6);
        assert_int_equal(mesh_unmatched_edges(&walls, at_the_front), 0);
        assert_true(mesh_unmatched_edges(&walls, NULL) >= 4);
        /* 0.2 m from the nearest wall, the ceiling, which is 548.8 mm up. */
        assert_near(least_distance_in_front(&walls, vec3(0.278, 0.3488, 0.28)), 0.2, 1e-6);
        own_mesh_release(&walls);
        const own_mesh *const light = own_gltf_mesh(&scene, "light");
        assert_near((double)light->positions[1], 0.5488, 1e-7);
        for (int block = 0; block < 2; block++) {
            const own_mesh *const mesh =
                own_gltf_mesh(&scene, block ? "tall block" : "short block");
            double smallest, sum;
            assert_int_equal(mesh_unmatched_edges(mesh, on_the_floor), 0);
            /* The missing foot is in y = 0 and adds nothing.  Feet by the shoelace formula. */
            mesh_volumes(mesh, &smallest, &sum);
            assert_near(smallest, block ? 0.330 * 0.0276265 : 0.165 * 0.027633, 1e-7);
        }
        own_gltf_release(&scene);
    }
}

static void furnaces_are_closed(void **state)
{
    (void)state;
    double   smallest, sum;
    own_gltf scene = own_gltf_read(ROOT, "furnace");
    assert_int_equal(mesh_unmatched_edges(&scene.meshes[0], NULL), 0);
    mesh_volumes(&scene.meshes[0], &smallest, &sum);
    assert_near(sum, -1.0, 1e-12); /* fronts inwards */
    own_gltf_release(&scene);

    scene = own_gltf_read(ROOT, "furnace-sphere");
    assert_int_equal(mesh_unmatched_edges(&scene.meshes[0], NULL), 0);
    assert_int_equal(mesh_concave_edges(&scene.meshes[0]), 0);
    mesh_volumes(&scene.meshes[0], &smallest, &sum);
    assert_in_range((int)(1000.0 * sum), 4100, 4188); /* below 4/3 pi */
    own_gltf_release(&scene);
}

static bool is_sheet(const char *mesh)
{
    static const char *const sheets[] = {"light tiles", "dark tiles", "red cloth",
                                         "green cloth", "blue cloth", "sky",
                                         "floor",       "panel",      "back wall"};
    for (size_t s = 0; s < sizeof sheets / sizeof *sheets; s++) {
        if (strcmp(sheets[s], mesh) == 0) {
            return true;
        }
    }
    return false;
}

static void solids_are_closed(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        int         solids;
    } scenes[3] = {{"colonnade", 24}, {"spheres", 8}, {"animated", 5}};
    for (int k = 0; k < 3; k++) {
        own_gltf scene  = own_gltf_read(ROOT, scenes[k].name);
        int      solids = 0;
        for (int i = 0; i < scene.mesh_count; i++) {
            const own_mesh *const mesh = &scene.meshes[i];
            double                smallest, sum;
            if (is_sheet(mesh->name)) {
                continue;
            }
            const size_t open = mesh_unmatched_edges(mesh, NULL);
            mesh_volumes(mesh, &smallest, &sum);
            if (open || !(smallest > 0.0)) {
                fail_msg("%s: %zu open edges, smallest volume %g", mesh->name, open, smallest);
            }
            solids++;
        }
        assert_int_equal(solids, scenes[k].solids);
        own_gltf_release(&scene);
    }
}

/* ---- the library's own loader ---- */

static void library_loads_them_without_a_warning(void **state)
{
    (void)state;
    assay_context *context;
    assert_int_equal(assay_context_create(NULL, &context), ASSAY_OK);
    for (int i = 0; i < OWN_SCENE_COUNT; i++) {
        const char *const name  = own_scene_list()[i].name;
        const bool        unlit = strcmp(name, "furnace-sphere") == 0 || strcmp(name, "lobes") == 0;
        assay_scene_options options = assay_scene_options_default();
        options.background.r        = unlit ? 1.0 : 0.0;
        char         path[256];
        assay_scene *scene;
        snprintf(path, sizeof path, ROOT "/%s/%s.gltf", name, name);
        if (assay_scene_load(context, path, &options, &scene) != ASSAY_OK) {
            fail_msg("%s", assay_context_error(context));
        }
        const assay_scene_info info = assay_scene_describe(scene);
        own_gltf               own  = own_gltf_read(ROOT, name);
        own_mesh               soup = own_gltf_flatten(&own);
        assert_int_equal(info.triangles, soup.triangle_count);
        assert_int_equal(info.warnings, 0);
        assert_true(info.has_light);
        assert_true(info.cameras >= 1);
        own_mesh_release(&soup);
        own_gltf_release(&own);
        assay_scene_destroy(scene);
    }
    assay_context_destroy(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(files_are_written_again),
        cmocka_unit_test(unwritable_folder_is_reported),
        cmocka_unit_test(documents_hold_together),
        cmocka_unit_test(damaged_documents_are_noticed),
        cmocka_unit_test(triangles_are_sound),
        cmocka_unit_test(unsound_triangles_are_noticed),
        cmocka_unit_test(cornell_box_is_the_measured_one),
        cmocka_unit_test(furnaces_are_closed),
        cmocka_unit_test(solids_are_closed),
        cmocka_unit_test(library_loads_them_without_a_warning),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
