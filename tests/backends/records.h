/* records.h - irradiance records: what they weigh at a point, and what they say there. */
#ifndef BACKEND_RECORDS_H
#define BACKEND_RECORDS_H

#include "bundle.h"
#include "vector.h"

typedef struct {
    vec   position, normal;
    float radius;
    float irradiance[3];
    vec   rotation[3], translation[3]; /* R, G, B */
} record;

typedef struct {
    float   a;
    bool    in_front, by_rotation, by_translation, clamped;
    size_t  count;
    record *list;
} records;

/* Takes the records of a bundle and passes them on. */
records records_take(const bundle *from, bundle *to);
void    records_release(records *r);

/* 0 where the record does not count. */
float record_weight(const records *rules, const record *k, vec position, vec normal);
void  record_say(const records *rules, const record *k, vec position, vec normal, float out[3]);

/* Stages `weights` and `interpolate`: asks at points that lie about the records. */
void records_ask(const records *r, bundle *to);

#endif
