/* radiance_cache_method.h - the method `radiance-cache`: docs/methods/radiance-cache.md. */
#ifndef ASSAY_METHODS_RADIANCE_CACHE_METHOD_H
#define ASSAY_METHODS_RADIANCE_CACHE_METHOD_H

#include "methods/method.h"

extern const assay_method assay_method_radiance_cache;

#endif
