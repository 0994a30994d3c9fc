/* splat_method.h - the method `splat`: docs/methods/splatting.md. */
#ifndef ASSAY_METHODS_SPLAT_METHOD_H
#define ASSAY_METHODS_SPLAT_METHOD_H

#include "methods/method.h"

extern const assay_method assay_method_splat;

#endif
