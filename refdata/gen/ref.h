/* ref.h - from proven enclosures to the text of refdata/basis.
 *
 * A table is a file of '#' header lines and rows of numbers (refdata/README.md).  A generator gives
 * a function that encloses a row's numbers at some precision; what is written are the doubles that
 * are nearest to them.  Every failure ends the program: a table is right or not there. */
#ifndef REF_H
#define REF_H

#include <arb.h>

/* First precision tried, in bits, and the last one before a generator gives up. */
#define REF_FIRST_PRECISION 128
#define REF_LAST_PRECISION 16384

/* Every enclosure that is written is at least this many bits sharp. */
#define REF_ACCURACY_BITS 70

/* A number's nearest double. */
typedef struct {
    double high;
    double low;        /* the double nearest to (number - high), where asked for */
    int    exact_zero; /* the number itself is 0, not only its double            */
} ref_number;

/* Encloses count numbers at a working precision. */
typedef void (*ref_enclosure)(void *user, arb_ptr out, slong count, slong precision);

/* Nearest doubles of all numbers, at as much precision as that takes.  with_low: also low. */
void ref_round_all(ref_enclosure enclose, void *user, slong count, int with_low,
                   ref_number *numbers);

/* Header of a table, all strings of one line. */
typedef struct {
    const char *name;      /* file NAME.txt                                */
    const char *generator; /* refdata/gen/GENERATOR.c                      */
    const char *content;   /* what the numbers are                         */
    const char *method;    /* how they are enclosed                        */
    const char *notes;     /* conventions                                  */
    const char *keys;      /* names of the leading columns, blanks between */
    const char *values;    /* what the columns after them are              */
    slong       rows;
    slong       columns; /* values of a row                                */
} ref_header;

typedef struct ref_table ref_table;

ref_table *ref_create(const char *directory, const ref_header *header);
void       ref_key(ref_table *table, double key);
void       ref_value(ref_table *table, const ref_number *number);
void       ref_low(ref_table *table, const ref_number *number);
void       ref_end_row(ref_table *table);
/* Closes the file; fails if rows or columns are not as many as the header says. */
void ref_finish(ref_table *table);

/* Ends the program. */
void ref_fail(const char *format, ...) __attribute__((format(printf, 1, 2), noreturn));
/* Ends the program unless two enclosures of one number, had in two ways, overlap. */
void ref_check_same(const arb_t a, const arb_t b, const char *what);

/* The double nearest to a whole number of degrees, rad. */
double ref_radians(slong degrees);

void *ref_allocate(size_t count, size_t size);

#endif
