/* irradiance_cache_method.h - the method `irradiance-cache`. */
#ifndef ASSAY_METHODS_IRRADIANCE_CACHE_IRRADIANCE_CACHE_METHOD_H
#define ASSAY_METHODS_IRRADIANCE_CACHE_IRRADIANCE_CACHE_METHOD_H

#include "methods/method.h"

extern const assay_method assay_method_irradiance_cache;

#endif
