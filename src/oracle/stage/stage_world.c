/* stage_world.c - a scene is believed to be the bundle's where the digests say so; a manifest
 * without one leaves that to who gave the scene. */
#include "oracle/stage/stage_world.h"

#include <string.h>

#include "core/context.h"
#include "scene/scene_data.h"

assay_status stage_world_create(const stage_run *run, assay_world **world_out)
{
    const char *digest = assay_bundle_text(run->bundle, "assay:scene.digest");
    if (digest && strcmp(digest, run->scene->digest) != 0) {
        return assay_fail(run->context, ASSAY_ERR_ARGUMENT,
                          "%s: bundle: of another scene than %s, or of one with other options: its "
                          "'assay:scene.digest' is %.16s..., not %.16s...",
                          assay_bundle_path(run->bundle), run->scene->path, digest,
                          run->scene->digest);
    }
    return assay_world_create(run->scene, world_out);
}
