/* main.c - writes every scene of own_scenes.h into a folder.
 *
 *     make_scenes DIRECTORY
 *
 * The files are the same bytes on every machine; tests/scene/test_own_scenes.c compares them with
 * those that are kept in scenes/. */
#include <errno.h>
#include <stdio.h>
#include <string.h>

#include "own_scenes.h"

int main(int argc, char **argv)
{
    if (argc != 2) {
        fputs("usage: make_scenes DIRECTORY\n", stderr);
        return 2;
    }
    const own_scene *scenes = own_scene_list();
    for (int i = 0; i < OWN_SCENE_COUNT; i++) {
        gltf_document *document = scenes[i].make();
        const bool     written  = gltf_write(document, argv[1]);
        gltf_destroy(document);
        if (!written) {
            fprintf(stderr, "make_scenes: %s/%s: %s\n", argv[1], scenes[i].name, strerror(errno));
            return 1;
        }
    }
    return 0;
}
