/* options.c - one pass over argv. */
#include "options.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int find_name(const cli_option *table, const char *name, size_t length)
{
    for (int i = 0; table[i].name; i++) {
        if (strlen(table[i].name) == length && memcmp(table[i].name, name, length) == 0) {
            return i;
        }
    }
    return -1;
}

static int find_letter(const cli_option *table, char letter)
{
    for (int i = 0; table[i].name; i++) {
        if (table[i].letter && table[i].letter == letter) {
            return i;
        }
    }
    return -1;
}

static bool complain(const char *command, const char *option, const char *problem)
{
    fprintf(stderr, "assay %s: %s: %s (assay %s --help lists the options)\n", command, option,
            problem, command);
    return false;
}

typedef struct {
    const char         *command;
    int                 count, at;
    char              **argv;
    const cli_option   *table;
    cli_option_handler  handler;
    cli_unknown_handler unknown;
    void               *user;
} parser;

/* The value of an option: behind '=', or the next word. */
static const char *take_value(parser *p, const char *behind)
{
    if (behind) {
        return behind;
    }
    return p->at + 1 < p->count ? p->argv[++p->at] : NULL;
}

static bool parse_unknown(parser *p, const char *word, const char *name, size_t length,
                          const char *behind)
{
    char        copy[64];
    const char *value;
    if (!p->unknown || length >= sizeof copy) {
        return complain(p->command, word, "unknown option");
    }
    memcpy(copy, name, length);
    copy[length] = '\0';
    value        = take_value(p, behind);
    if (!value) {
        return complain(p->command, word, "unknown option, or its value is missing");
    }
    const char *problem = p->unknown(p->user, copy, value);
    return problem ? complain(p->command, word, problem) : true;
}

static bool parse_option(parser *p, const char *word)
{
    int         index;
    const char *behind = NULL;
    if (word[1] == '-') {
        const char  *name   = word + 2;
        const size_t length = strcspn(name, "=");
        behind              = name[length] ? name + length + 1 : NULL;
        index               = find_name(p->table, name, length);
        if (index < 0) {
            return parse_unknown(p, word, name, length, behind);
        }
    } else {
        index  = find_letter(p->table, word[1]);
        behind = word[2] ? word + 2 : NULL;
        if (index < 0) {
            return complain(p->command, word, "unknown option");
        }
    }
    const char *value = NULL;
    if (p->table[index].argument) {
        value = take_value(p, behind);
        if (!value) {
            return complain(p->command, word, "a value is missing");
        }
    } else if (behind) {
        return complain(p->command, word, "this option takes no value");
    }
    const char *problem = p->handler(p->user, index, value);
    return problem ? complain(p->command, word, problem) : true;
}

bool cli_parse(const char *command, int count, char **argv, const cli_option *table,
               cli_option_handler handler, cli_unknown_handler unknown, void *user)
{
    parser p           = {command, count, 0, argv, table, handler, unknown, user};
    bool   options_end = false;
    for (; p.at < count; p.at++) {
        const char *word = argv[p.at];
        if (!options_end && strcmp(word, "--") == 0) {
            options_end = true;
        } else if (!options_end && word[0] == '-' && word[1]) {
            if (!parse_option(&p, word)) {
                return false;
            }
        } else {
            const char *problem = handler(user, -1, word);
            if (problem) {
                return complain(command, word, problem);
            }
        }
    }
    return true;
}

void cli_print_options(const cli_option *table)
{
    for (int i = 0; table[i].name; i++) {
        char left[48];
        snprintf(left, sizeof left, "%s%c%s--%s %s", table[i].letter ? "-" : " ",
                 table[i].letter ? table[i].letter : ' ', table[i].letter ? ", " : "  ",
                 table[i].name, table[i].argument ? table[i].argument : "");
        printf("  %-30s %s\n", left, table[i].help);
    }
}

/* ---- values ---- */

const char *cli_read_real(const char *text, double *value)
{
    char        *end    = NULL;
    const double number = strtod(text, &end);
    if (end == text || *end || !isfinite(number) || strpbrk(text, "xXnN \t")) {
        return "takes a number";
    }
    *value = number;
    return NULL;
}

const char *cli_read_count(const char *text, long minimum, long maximum, long *value)
{
    char *end         = NULL;
    errno             = 0;
    const long number = strtol(text, &end, 10);
    if (end == text || *end || errno || number < minimum || number > maximum ||
        strpbrk(text, " \t+")) {
        return "takes a whole number in its range";
    }
    *value = number;
    return NULL;
}

const char *cli_read_seed(const char *text, unsigned long long *value)
{
    char *end                       = NULL;
    errno                           = 0;
    const unsigned long long number = strtoull(text, &end, 10);
    if (*text < '0' || *text > '9' || *end || errno) {
        return "takes a whole number from 0 to 2^64 - 1";
    }
    *value = number;
    return NULL;
}

const char *cli_read_size(const char *text, int *width, int *height)
{
    int w = 0, h = 0, used = 0;
    if (sscanf(text, "%5dx%5d%n", &w, &h, &used) != 2 || text[used] || w < 1 || h < 1 ||
        w > 65536 || h > 65536) {
        return "takes WxH, each from 1 to 65536, as in 640x480";
    }
    *width  = w;
    *height = h;
    return NULL;
}

const char *cli_read_triple(const char *text, double value[3])
{
    char   copy[128];
    double read[3];
    if (strlen(text) >= sizeof copy) {
        return "takes R,G,B";
    }
    strcpy(copy, text);
    char *at = copy;
    for (int i = 0; i < 3; i++) {
        char *comma = strchr(at, ',');
        if ((i < 2) != (comma != NULL)) {
            return "takes three numbers, as in 1,0.5,0";
        }
        if (comma) {
            *comma = '\0';
        }
        if (cli_read_real(at, &read[i])) {
            return "takes three numbers, as in 1,0.5,0";
        }
        at = comma ? comma + 1 : at;
    }
    memcpy(value, read, sizeof read);
    return NULL;
}

const char *cli_read_range(const char *text, long *first, long *last)
{
    char        copy[64];
    const char *colon = strchr(text, ':');
    long        a, b;
    if (strlen(text) >= sizeof copy) {
        return "takes A:B";
    }
    strcpy(copy, text);
    if (colon) {
        copy[colon - text] = '\0';
    }
    if (cli_read_count(copy, -1000000, 1000000, &a) ||
        (colon && cli_read_count(colon + 1, -1000000, 1000000, &b))) {
        return "takes frames A:B, whole numbers from -1000000 to 1000000";
    }
    if (!colon) {
        b = a;
    }
    if (b < a) {
        return "takes frames A:B with B not before A";
    }
    *first = a;
    *last  = b;
    return NULL;
}
