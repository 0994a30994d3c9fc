/* options.h - command lines from tables: parsing, and the help that the same table gives. */
#ifndef ASSAY_CLI_OPTIONS_H
#define ASSAY_CLI_OPTIONS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct {
    const char *name;     /* "size": --size VALUE or --size=VALUE; NULL ends a table */
    char        letter;   /* 'o': -o VALUE; 0 without                                */
    const char *argument; /* "WxH"; NULL: a switch                                   */
    const char *help;
} cli_option;

/* Called for every option in the order given: an index into the table with its value (NULL for a
 * switch), or index -1 for an operand.  Answers NULL, or what is wrong with it. */
typedef const char *(*cli_option_handler)(void *user, int index, const char *value);

/* Called for a long option that is not in the table; answers as above.  value is NULL where there
 * is none.  The handler may be NULL. */
typedef const char *(*cli_unknown_handler)(void *user, const char *name, const char *value);

/* Goes through argv[0..count).  False after printing `command: what is wrong` to stderr. */
bool cli_parse(const char *command, int count, char **argv, const cli_option *table,
               cli_option_handler handler, cli_unknown_handler unknown, void *user);

void cli_print_options(const cli_option *table);

/* To be put into the table of a command that needs much memory. */
#define CLI_MEMORY_OPTION                                                                          \
    {                                                                                              \
        "memory-limit", 0, "SIZE", "refuse what needs more: 4G, none (default: what is free)"      \
    }

/* ---- values; each answers NULL or what is wrong ---- */

const char *cli_read_size(const char *text, int *width, int *height);   /* "640x480", of a render */
const char *cli_read_real(const char *text, double *value);             /* finite       */
const char *cli_read_triple(const char *text, double value[3]);         /* "1,0.5,0"    */
const char *cli_read_range(const char *text, long *first, long *last);  /* "0:23", "7"  */
const char *cli_read_seed(const char *text, unsigned long long *value); /* 0 ... 2^64-1 */
/* "4G", "512M", "none": bytes, with K, M, G, T as powers of 1024; none is UINT64_MAX. */
const char *cli_read_bytes(const char *text, uint64_t *value);
/* A whole number in the range; the caller knows better words for it. */
const char *cli_read_count(const char *text, long minimum, long maximum, long *value);

#endif
