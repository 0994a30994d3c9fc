/* machine_memory.h - how much memory the machine has to give. */
#ifndef ASSAY_CORE_MACHINE_MEMORY_H
#define ASSAY_CORE_MACHINE_MEMORY_H

#include <stdint.h>

/* Where it cannot be told. */
#define ASSAY_MEMORY_UNKNOWN UINT64_MAX

/* Bytes that can be taken now without swapping and without being killed: the lowest of MemAvailable
 * of /proc/meminfo and what the limits of the process's memory control groups (v1 or v2, its own
 * and those above) leave.  root is put before all paths, "" but in tests. */
uint64_t assay_machine_memory(const char *root);

/* What a context may take of that: less a sixteenth, at least 64 MiB (but never more than half),
 * which is left to the libraries and to others. */
uint64_t assay_machine_memory_budget(uint64_t available);

#endif
