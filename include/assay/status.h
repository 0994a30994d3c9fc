/* status.h - what a call can answer, and the exit code that stands for it. */
#ifndef ASSAY_STATUS_H
#define ASSAY_STATUS_H

#ifdef __cplusplus
extern "C" {
#endif

#if defined(__GNUC__) && !defined(ASSAY_STATIC)
#define ASSAY_API __attribute__((visibility("default")))
#else
#define ASSAY_API
#endif

/* Every fallible call returns one of these; outputs are untouched unless it is ASSAY_OK.
 * The values are stable. */
typedef enum {
    ASSAY_OK              = 0,
    ASSAY_ERR_ARGUMENT    = 1, /* a parameter or option is unknown or out of its range         */
    ASSAY_ERR_NOT_FOUND   = 2, /* a file is missing or cannot be read                          */
    ASSAY_ERR_FORMAT      = 3, /* a file is malformed                                          */
    ASSAY_ERR_UNSUPPORTED = 4, /* a file is well-formed, but asks for what assay does not do   */
    ASSAY_ERR_LIMIT       = 5, /* a file or request is larger than a stated limit              */
    ASSAY_ERR_MEMORY      = 6, /* an allocation failed                                         */
    ASSAY_ERR_WRITE       = 7, /* an output cannot be written                                  */
    ASSAY_ERR_DOMAIN      = 8, /* a number is NaN, infinite, or outside a function's domain    */
    ASSAY_ERR_CANCELLED   = 9, /* the progress callback asked to stop                          */
    ASSAY_ERR_INTERNAL    = 10 /* a broken invariant: please report it                         */
} assay_status;

/* The status in a few words, never NULL; "unknown status" outside the enumeration. */
ASSAY_API const char *assay_status_text(assay_status status);

/* Exit code of a program that ends with this status: 0 success, 2 bad input (argument, not found,
 * format, unsupported, limit, domain), 3 the machine refused (memory, write), 4 internal error,
 * 130 cancelled.  1 is kept for verdicts ("the images differ"). */
ASSAY_API int assay_status_exit_code(assay_status status);

#ifdef __cplusplus
}
#endif
#endif
