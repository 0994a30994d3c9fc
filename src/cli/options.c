/* options.c - one pass over argv. */
#include "options.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "console.h"

static int find_name(const cli_option *table, const char *name, size_t length)
{
    for (int i = 0; table[i].name; i++) {
        if (strlen(table[i].name) == length && memcmp(table[i].name, name, length) == 0) {
            return i;
        }
    }
    return -1;
}

_Static_assert(ASSAY_IMAGE_MAX_SIDE == 65536 && ASSAY_RENDER_MAX_PIXELS == 67108864,
               "the words of cli_read_size say so");

static int find_letter(const cli_option *table, char letter)
{
    for (int i = 0; table[i].name; i++) {
        if (table[i].letter && table[i].letter == letter) {
            return i;
        }
    }
    return -1;
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

/* True where there is no problem; else says what is wrong with an option, or with its value. */
static bool accept(const parser *p, const char *option, const char *value, const char *problem)
{
    if (!problem) {
        return true;
    }
    const int length = option[0] == '-' ? (int)strcspn(option, "=") : (int)strlen(option);
    return value ? cli_complain(p->command, "%.*s '%s': %s", length, option, value, problem)
                 : cli_complain(p->command, "%.*s: %s (assay %s --help lists the options)", length,
                                option, problem, p->command);
}

/* The value of an option: behind '=', or the next word, unless that is an option itself. */
static const char *take_value(parser *p, const char *behind)
{
    if (behind) {
        return behind;
    }
    const char *next = p->at + 1 < p->count ? p->argv[p->at + 1] : NULL;
    if (!next || strncmp(next, "--", 2) == 0) {
        return NULL;
    }
    p->at++;
    return next;
}

static bool parse_unknown(parser *p, const char *word, const char *name, size_t length,
                          const char *behind)
{
    char copy[64];
    if (!p->unknown || length >= sizeof copy) {
        return accept(p, word, NULL, "unknown option");
    }
    memcpy(copy, name, length);
    copy[length]      = '\0';
    const char *value = take_value(p, behind);
    return accept(p, word, NULL, p->unknown(p->user, copy, value));
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
            return accept(p, word, NULL, "unknown option");
        }
    }
    const char *value = NULL;
    if (p->table[index].argument) {
        value = take_value(p, behind);
        if (!value) {
            return accept(p, word, NULL, "a value is missing");
        }
    } else if (behind) {
        return accept(p, word, NULL, "this option takes no value");
    }
    return accept(p, word, value, p->handler(p->user, index, value));
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
            if (!accept(&p, word, NULL, handler(user, -1, word))) {
                return false;
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
    if (!*text || *end || !isfinite(number) || strspn(text, "+-.0123456789eE") != strlen(text)) {
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
    if (!*text || *end || errno || number < minimum || number > maximum ||
        strspn(text, "-0123456789") != strlen(text)) {
        return "takes a whole number";
    }
    *value = number;
    return NULL;
}

const char *cli_read_bytes(const char *text, uint64_t *value)
{
    static const char UNITS[] = "KMGT";
    if (strcmp(text, "none") == 0) {
        *value = UINT64_MAX;
        return NULL;
    }
    char *end                       = NULL;
    errno                           = 0;
    const unsigned long long number = strtoull(text, &end, 10);
    const char              *unit   = *end ? strchr(UNITS, *end) : NULL;
    const int                shift  = unit ? 10 * (int)(unit - UNITS + 1) : 0;
    if (*text < '0' || *text > '9' || errno || number == 0 || (*end && !unit) || (unit && end[1]) ||
        number > UINT64_MAX >> shift) {
        return "takes bytes, with K, M, G or T behind them, as in 4G, or none";
    }
    *value = (uint64_t)number << shift;
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

/* The words of a text between separators, copied; false unless there are just `count`. */
static bool split(const char *text, char separator, int count, char words[][64])
{
    for (int i = 0; i < count; i++) {
        const char  *end    = i + 1 < count ? strchr(text, separator) : text + strlen(text);
        const size_t length = end ? (size_t)(end - text) : 0;
        if (!end || length >= 64) {
            return false;
        }
        memcpy(words[i], text, length);
        words[i][length] = '\0';
        text             = *end ? end + 1 : end;
    }
    return true;
}

const char *cli_read_size(const char *text, int *width, int *height)
{
    char words[2][64];
    long w, h;
    if (!split(text, 'x', 2, words) || cli_read_count(words[0], 1, ASSAY_IMAGE_MAX_SIDE, &w) ||
        cli_read_count(words[1], 1, ASSAY_IMAGE_MAX_SIDE, &h) || w * h > ASSAY_RENDER_MAX_PIXELS) {
        return "takes WxH, each from 1 to 65536 and at most 67108864 pixels in all, as in 640x480";
    }
    *width  = (int)w;
    *height = (int)h;
    return NULL;
}

const char *cli_read_triple(const char *text, double value[3])
{
    char   words[3][64];
    double read[3];
    if (!split(text, ',', 3, words) || cli_read_real(words[0], &read[0]) ||
        cli_read_real(words[1], &read[1]) || cli_read_real(words[2], &read[2])) {
        return "takes three numbers, as in 1,0.5,0";
    }
    memcpy(value, read, sizeof read);
    return NULL;
}

const char *cli_read_range(const char *text, long *first, long *last)
{
    enum { MOST = 1000000 };
    char       words[2][64];
    const bool pair = strchr(text, ':') != NULL;
    long       a, b;
    if (!split(text, ':', pair ? 2 : 1, words) || cli_read_count(words[0], -MOST, MOST, &a) ||
        cli_read_count(words[pair], -MOST, MOST, &b)) {
        return "takes frames A:B, whole numbers from -1000000 to 1000000";
    }
    if (b < a) {
        return "takes frames A:B with B not before A";
    }
    *first = a;
    *last  = b;
    return NULL;
}
