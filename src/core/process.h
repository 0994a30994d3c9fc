/* process.h - wall clock and memory of the process, for statistics only: no result depends on them.
 */
#ifndef ASSAY_CORE_PROCESS_H
#define ASSAY_CORE_PROCESS_H

#include <stdint.h>

/* Seconds of a clock that only goes forward. */
double assay_process_seconds(void);

/* Largest resident size so far, bytes. */
uint64_t assay_process_peak_memory(void);

#endif
