/* stage_meaning.h - what a wrong array looks like: a factor, a sign, channels in another order. */
#ifndef ASSAY_ORACLE_STAGE_MEANING_H
#define ASSAY_ORACLE_STAGE_MEANING_H

#include <stddef.h>

/* A sentence, with a blank before it, on values (count of them, rows of columns) that should have
 * been `right`; "" where they look like nothing that is known. */
void stage_meaning(size_t columns, size_t count, const double *values, const double *right,
                   char *words, size_t size);

#endif
