/* lobe.h - the inside of a lobe: what is wrong with one, and its value without checks. */
#ifndef ASSAY_BASIS_LOBE_H
#define ASSAY_BASIS_LOBE_H

#include "assay/basis.h"

/* NULL, or why assay_lobe_value gives DOMAIN. */
const char *assay_lobe_problem(const assay_lobe *lobe);

assay_vec3 assay_lobe_outgoing(const assay_lobe *lobe);

/* For a sound lobe, its outgoing direction wo and a unit wi. */
double assay_lobe_at(const assay_lobe *lobe, assay_vec3 wo, assay_vec3 wi);

#endif
