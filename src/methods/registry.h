/* registry.h - all methods. */
#ifndef ASSAY_METHODS_REGISTRY_H
#define ASSAY_METHODS_REGISTRY_H

#include "methods/method.h"

/* NULL where there is none of that name. */
const assay_method *assay_method_find(const char *name);

#endif
