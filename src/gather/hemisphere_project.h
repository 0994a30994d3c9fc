/* hemisphere_project.h - what coefficients and their gradients share. */
#ifndef ASSAY_GATHER_HEMISPHERE_PROJECT_H
#define ASSAY_GATHER_HEMISPHERE_PROJECT_H

#include "gather/hemisphere.h"

/* ARGUMENT with a message for a basis whose coefficients are no integrals over solid angle. */
assay_status hemisphere_project_check(assay_context *context, const assay_basis *basis);

#endif
