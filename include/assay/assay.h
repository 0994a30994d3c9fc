/* assay.h - everything. */
#ifndef ASSAY_ASSAY_H
#define ASSAY_ASSAY_H

#include "assay/array.h"
#include "assay/basis.h"
#include "assay/compare.h"
#include "assay/context.h"
#include "assay/image.h"
#include "assay/metrics.h"
#include "assay/params.h"
#include "assay/plot.h"
#include "assay/precision.h"
#include "assay/render.h"
#include "assay/replay.h"
#include "assay/report.h"
#include "assay/scene.h"
#include "assay/status.h"
#include "assay/types.h"
#include "assay/verdict.h"
#include "assay/verify.h"

#endif
