/* registry.c - the list of methods: one line each. */
#include "methods/registry.h"

#include <string.h>

#include "methods/hsh_environment/hsh_environment.h"
#include "methods/irradiance_cache/irradiance_cache_method.h"
#include "methods/path/path.h"
#include "methods/radiance_cache/radiance_cache_method.h"
#include "methods/splat/splat_method.h"

/* clang-format off */
static const assay_method *const METHODS[] = {
    &assay_method_path,
    &assay_method_hsh_environment,
    &assay_method_irradiance_cache,
    &assay_method_radiance_cache,
    &assay_method_splat,
};
/* clang-format on */

enum { METHOD_COUNT = sizeof METHODS / sizeof METHODS[0] };

const assay_method *assay_method_find(const char *name)
{
    for (int i = 0; i < METHOD_COUNT; i++) {
        if (strcmp(METHODS[i]->name, name) == 0) {
            return METHODS[i];
        }
    }
    return NULL;
}

int assay_method_count(void) { return METHOD_COUNT; }

assay_method_info assay_method_at(int index)
{
    const assay_method *method = METHODS[index];
    return (assay_method_info){method->name, method->summary, method->params};
}
