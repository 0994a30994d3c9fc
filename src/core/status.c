/* status.c - the words and exit codes of statuses. */
#include "assay/status.h"

const char *assay_status_text(assay_status status)
{
    switch (status) {
    case ASSAY_OK: return "success";
    case ASSAY_ERR_ARGUMENT: return "bad argument";
    case ASSAY_ERR_NOT_FOUND: return "not found";
    case ASSAY_ERR_FORMAT: return "malformed file";
    case ASSAY_ERR_UNSUPPORTED: return "unsupported";
    case ASSAY_ERR_LIMIT: return "too large";
    case ASSAY_ERR_MEMORY: return "out of memory";
    case ASSAY_ERR_WRITE: return "cannot write";
    case ASSAY_ERR_DOMAIN: return "number outside the domain";
    case ASSAY_ERR_CANCELLED: return "cancelled";
    case ASSAY_ERR_INTERNAL: return "internal error";
    }
    return "unknown status";
}

int assay_status_exit_code(assay_status status)
{
    switch (status) {
    case ASSAY_OK: return 0;
    case ASSAY_ERR_ARGUMENT:
    case ASSAY_ERR_NOT_FOUND:
    case ASSAY_ERR_FORMAT:
    case ASSAY_ERR_UNSUPPORTED:
    case ASSAY_ERR_LIMIT:
    case ASSAY_ERR_DOMAIN: return 2;
    case ASSAY_ERR_MEMORY:
    case ASSAY_ERR_WRITE: return 3;
    case ASSAY_ERR_CANCELLED: return 130;
    case ASSAY_ERR_INTERNAL: break;
    }
    return 4;
}
