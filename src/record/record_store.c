/* record_store.c - an array of records, and an octree that only leaves out.
 *
 * Invariant: what a query finds is decided by assay_record_weight alone, and is sorted by number
 * before anything is summed.  So octree and list give the same bits, whatever shape the octree has
 * and in whatever order it is walked.
 *
 * New contributions are put behind those of the query before and moved to the front at the end: so
 * a query that is refused memory leaves the list as it was. */
#include "record/record_store.h"

#include <assert.h>
#include <string.h>

#include "core/alloc.h"
#include "math/octree.h"

struct assay_record_store {
    assay_context     *context;
    assay_record_rules rules;
    assay_octree      *octree; /* NULL: a list */
    assay_record      *records;
    size_t             count, capacity;
    uint64_t           version; /* of what neighbourhoods were drawn from */
};

/* ---- making ---- */

assay_status assay_record_store_create(assay_context *context, const assay_record_rules *rules,
                                       assay_vec3 bounds_min, assay_vec3 bounds_max,
                                       assay_record_index index, assay_record_store **store_out)
{
    if (!(rules->a >= 1.0 / ASSAY_WEIGHT_MAX) || isinf(rules->a)) {
        return assay_fail(context, ASSAY_ERR_ARGUMENT,
                          "the accuracy a of a cache is %g; it must be finite and at least %g",
                          rules->a, 1.0 / ASSAY_WEIGHT_MAX);
    }
    assay_record_store *store = assay_allocate(context, 1, sizeof *store);
    if (!store) {
        return assay_fail_memory(context, "a store of records");
    }
    store->context = context;
    store->rules   = *rules;
    if (index == ASSAY_INDEX_OCTREE) {
        const assay_status status =
            assay_octree_create(context, bounds_min, bounds_max, &store->octree);
        if (status != ASSAY_OK) {
            assay_record_store_destroy(store);
            return status;
        }
    }
    *store_out = store;
    return ASSAY_OK;
}

void assay_record_store_destroy(assay_record_store *store)
{
    if (store) {
        assay_octree_destroy(store->octree);
        assay_release(store->context, store->records);
        assay_release(store->context, store);
    }
}

static bool is_sound(const assay_record *r)
{
    bool sound = vec3_finite(r->position) && fabs(vec3_length(r->normal) - 1.0) <= 1e-6 &&
                 isfinite(r->radius) && r->radius > 0.0 && !isnan(r->mean) && !isnan(r->nearest) &&
                 rgb_finite(r->irradiance);
    for (int c = 0; c < 3; c++) {
        sound = sound && vec3_finite(r->rotation[c]) && vec3_finite(r->translation[c]);
    }
    return sound;
}

assay_status assay_record_store_add(assay_record_store *store, const assay_record *record)
{
    if (!is_sound(record)) {
        return assay_fail(store->context, ASSAY_ERR_DOMAIN,
                          "record %zu is not sound: radius %g m, at (%g, %g, %g) m", store->count,
                          record->radius, record->position.x, record->position.y,
                          record->position.z);
    }
    if (store->count >= UINT32_MAX) {
        return assay_fail(store->context, ASSAY_ERR_LIMIT, "a cache has at most 2^32 - 1 records");
    }
    assay_status status = assay_grow(store->context, (void **)&store->records, &store->capacity,
                                     store->count + 1, sizeof *store->records);
    if (status == ASSAY_OK && store->octree) {
        status = assay_octree_add(store->octree, record->position,
                                  assay_record_reach(record, &store->rules));
    }
    if (status == ASSAY_OK) {
        store->records[store->count++] = *record;
        store->version++;
    }
    return status;
}

void assay_record_store_shrink(assay_record_store *store, uint32_t number, double radius)
{
    assert(number < store->count && radius > 0.0 && radius <= store->records[number].radius);
    assay_record *record = &store->records[number];
    record->radius       = radius;
    store->version++;
    if (store->octree) {
        assay_octree_shrink(store->octree, number, assay_record_reach(record, &store->rules));
    }
}

uint32_t assay_record_store_count(const assay_record_store *store)
{
    return (uint32_t)store->count;
}

const assay_record *assay_record_store_at(const assay_record_store *store, uint32_t number)
{
    assert(number < store->count);
    return &store->records[number];
}

const assay_record_rules *assay_record_store_rules(const assay_record_store *store)
{
    return &store->rules;
}

uint64_t assay_record_store_bytes(const assay_record_store *store)
{
    return sizeof *store + store->capacity * sizeof *store->records +
           (store->octree ? assay_octree_bytes(store->octree) : 0);
}

/* ---- lists of contributions ---- */

void assay_contributions_release(assay_contributions *list)
{
    if (list->items) {
        assay_release(list->context, list->items);
    }
    if (list->around.items) {
        assay_release(list->context, list->around.items);
    }
    *list = (assay_contributions){0};
}

/* Not assay_grow: its message would be written by several workers at once. */
static bool make_room(assay_context *context, assay_contribution **items, size_t *capacity,
                      size_t needed)
{
    if (needed <= *capacity) {
        return true;
    }
    const size_t        wanted = needed < 32 ? 64 : 2 * needed;
    assay_contribution *grown  = assay_allocate(context, wanted, sizeof *grown);
    if (!grown) {
        return false;
    }
    if (*items) {
        memcpy(grown, *items, *capacity * sizeof *grown);
        assay_release(context, *items);
    }
    *items    = grown;
    *capacity = wanted;
    return true;
}

/* Shell's sort: no memory, quick for the ten or so of a query, and not slow for a crowd. */
static void sort_by_number(assay_contribution *items, size_t count)
{
    size_t gap = 1;
    while (gap < count / 3) {
        gap = 3 * gap + 1;
    }
    for (; gap > 0; gap /= 3) {
        for (size_t i = gap; i < count; i++) {
            const assay_contribution item = items[i];
            size_t                   at   = i;
            for (; at >= gap && items[at - gap].number > item.number; at -= gap) {
                items[at] = items[at - gap];
            }
            items[at] = item;
        }
    }
}

/* ---- queries ---- */

/* What is asked of every record that an index offers; 0 leaves it out. */
typedef struct {
    const assay_record_store *store;
    assay_vec3                position, normal;
    double                    distance; /* > 0: nearer than this; else the weight */
} question;

static double ask(const question *q, size_t number)
{
    const assay_record *record = &q->store->records[number];
    if (q->distance > 0.0) {
        return vec3_length(vec3_sub(record->position, q->position)) < q->distance;
    }
    return assay_record_weight(record, &q->store->rules, q->position, q->normal);
}

/* Puts a record that has an answer behind the list. */
static assay_status consider(const question *q, size_t number, assay_contributions *list,
                             size_t *found)
{
    const double weight = ask(q, number);
    if (!(weight > 0.0)) {
        return ASSAY_OK;
    }
    if (!make_room(list->context, &list->items, &list->capacity, list->count + *found + 1)) {
        return ASSAY_ERR_MEMORY;
    }
    list->items[list->count + (*found)++] = (assay_contribution){(uint32_t)number, weight};
    return ASSAY_OK;
}

static assay_status consider_each(const question *q, size_t end, assay_contributions *list,
                                  size_t *found)
{
    assay_status status = ASSAY_OK;
    for (size_t number = 0; number < end && status == ASSAY_OK; number++) {
        status = consider(q, number, list, found);
    }
    return status;
}

static assay_status consider_near(const question *q, size_t end, assay_contributions *list,
                                  size_t *found)
{
    assay_octree_walk walk;
    if (q->distance > 0.0) {
        assay_octree_walk_near(&walk, q->store->octree, q->position, q->distance);
    } else {
        assay_octree_walk_about(&walk, q->store->octree, q->position);
    }
    assay_status status = ASSAY_OK;
    uint32_t     number = assay_octree_walk_next(&walk);
    while (number != ASSAY_OCTREE_END && status == ASSAY_OK) {
        status = number < end ? consider(q, number, list, found) : ASSAY_OK;
        number = assay_octree_walk_next(&walk);
    }
    return status;
}

/* HEURISTIC: a fourth of the smallest reach of what was found.  Such a ball offers half as many
 * again as reach its middle, and serves some ten pixels. */
static double follow_distance(const assay_contributions *list)
{
    double least = INFINITY;
    for (size_t i = 0; i < list->count; i++) {
        const assay_record *record = &list->store->records[list->items[i].number];
        least                      = fmin(least, assay_record_reach(record, &list->store->rules));
    }
    return isfinite(least) ? 0.25 * least : 0.0;
}

/* Draws the neighbourhood anew. */
static assay_status look_around(const question *q, double radius, assay_contributions *list)
{
    assay_neighbourhood *around = &list->around;
    assay_octree_walk    walk;
    assay_octree_walk_around(&walk, q->store->octree, q->position, (1.0 + 1e-12) * radius);
    *around         = (assay_neighbourhood){.version  = q->store->version,
                                            .centre   = q->position,
                                            .radius   = -1.0,
                                            .items    = around->items,
                                            .capacity = around->capacity};
    uint32_t number = assay_octree_walk_next(&walk);
    while (number != ASSAY_OCTREE_END) {
        if (!make_room(list->context, &around->items, &around->capacity, around->count + 1)) {
            return ASSAY_ERR_MEMORY;
        }
        around->items[around->count++] = (assay_contribution){.number = number};
        number                         = assay_octree_walk_next(&walk);
    }
    sort_by_number(around->items, around->count);
    around->radius = radius;
    return ASSAY_OK;
}

static bool is_around(const question *q, const assay_contributions *list)
{
    const assay_neighbourhood *around = &list->around;
    const assay_vec3           off    = vec3_sub(q->position, around->centre);
    return list->store == q->store && around->version == q->store->version &&
           around->radius > 0.0 && vec3_dot(off, off) <= around->radius * around->radius;
}

/* How far the neighbourhood of the query's place is worth drawing, m: not at all where it is far
 * from that of the query before. */
static double worth_drawing(const question *q, const assay_contributions *list)
{
    if (list->store != q->store) {
        return 0.0;
    }
    const assay_vec3 moved = vec3_sub(q->position, list->position);
    const double     near  = follow_distance(list);
    return vec3_dot(moved, moved) <= near * near ? near : 0.0;
}

static assay_status consider_neighbours(const question *q, size_t end, assay_contributions *list,
                                        size_t *found)
{
    assay_status status = ASSAY_OK;
    for (size_t i = 0; i < list->around.count && status == ASSAY_OK; i++) {
        const uint32_t number = list->around.items[i].number;
        status                = number < end ? consider(q, number, list, found) : ASSAY_OK;
    }
    return status;
}

static assay_status know_around(const question *q, assay_contributions *list, bool *known_out)
{
    *known_out = is_around(q, list);
    if (*known_out || !q->store->octree) {
        return ASSAY_OK;
    }
    const double       radius = worth_drawing(q, list);
    const assay_status status = radius > 0.0 ? look_around(q, radius, list) : ASSAY_OK;
    *known_out                = status == ASSAY_OK && radius > 0.0;
    return status;
}

static assay_status answer(const question *q, size_t limit, assay_contributions *list)
{
    const size_t end    = limit < q->store->count ? limit : q->store->count;
    size_t       found  = 0;
    list->context       = q->store->context;
    bool         known  = false;
    assay_status status = q->distance > 0.0 ? ASSAY_OK : know_around(q, list, &known);
    if (status != ASSAY_OK) {
        return status;
    }
    if (known) {
        status = consider_neighbours(q, end, list, &found);
    } else {
        status = (q->store->octree ? consider_near : consider_each)(q, end, list, &found);
    }
    if (status != ASSAY_OK) {
        return status;
    }
    if (found > 0) {
        if (!known) {
            sort_by_number(list->items + list->count, found);
        }
        memmove(list->items, list->items + list->count, found * sizeof *list->items);
    }
    list->count    = found;
    list->weight   = 0.0;
    list->store    = q->store;
    list->position = q->position;
    for (size_t i = 0; i < found; i++) {
        list->weight += list->items[i].weight;
    }
    return ASSAY_OK;
}

assay_status assay_record_store_find(const assay_record_store *store, assay_vec3 position,
                                     assay_vec3 normal, uint32_t limit, assay_contributions *list)
{
    const question q = {.store = store, .position = position, .normal = normal};
    return answer(&q, limit, list);
}

bool assay_record_store_reaches(const assay_record_store *store, assay_vec3 position,
                                assay_vec3 normal, uint32_t *hint)
{
    const question q = {.store = store, .position = position, .normal = normal};
    if (*hint < store->count && ask(&q, *hint) > 0.0) {
        return true;
    }
    if (!store->octree) {
        for (uint32_t i = 0; i < store->count; i++) {
            if (ask(&q, i) > 0.0) {
                *hint = i;
                return true;
            }
        }
        return false;
    }
    assay_octree_walk walk;
    assay_octree_walk_about(&walk, store->octree, position);
    uint32_t number = assay_octree_walk_next(&walk);
    while (number != ASSAY_OCTREE_END) {
        if (ask(&q, number) > 0.0) {
            *hint = number;
            return true;
        }
        number = assay_octree_walk_next(&walk);
    }
    return false;
}

assay_status assay_record_store_near(const assay_record_store *store, assay_vec3 position,
                                     double distance, void (*visit)(void *user, uint32_t number),
                                     void  *user)
{
    if (!(distance > 0.0)) {
        return ASSAY_OK;
    }
    const question      q      = {.store = store, .position = position, .distance = distance};
    assay_contributions list   = {0};
    const assay_status  status = answer(&q, SIZE_MAX, &list);
    for (size_t i = 0; status == ASSAY_OK && i < list.count; i++) {
        visit(user, list.items[i].number);
    }
    assay_contributions_release(&list);
    return status;
}

/* A running mean: it says exactly what the records say where they say the same, and no product of a
 * weight can overflow. */
assay_rgb assay_record_store_interpolate(const assay_record_store  *store,
                                         const assay_contributions *list, assay_vec3 position,
                                         assay_vec3 normal)
{
    assert(list->count > 0);
    assay_rgb mean = rgb_grey(0.0);
    double    sum  = 0.0;
    for (size_t i = 0; i < list->count; i++) {
        const assay_contribution *item = &list->items[i];
        const assay_rgb           said = assay_record_extrapolate(&store->records[item->number],
                                                                  &store->rules, position, normal);
        sum += item->weight;
        const double share = item->weight / sum;
        mean.r += share * (said.r - mean.r);
        mean.g += share * (said.g - mean.g);
        mean.b += share * (said.b - mean.b);
    }
    return mean;
}
