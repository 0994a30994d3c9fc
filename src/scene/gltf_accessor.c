/* gltf_accessor.c - Invariant: no byte is read and no element is made room for before all ranges of
 * the accessor were checked, in 64 bits, against the bytes that are there.
 *
 * Values are copied byte by byte, so the file's alignment does not matter; the byte order is that
 * of glTF and of every machine that is supported, little-endian. */
#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/alloc.h"
#include "core/context.h"
#include "scene/gltf_loader.h"

static uint32_t component_bytes(assay_gltf_component component)
{
    switch (component) {
    case ASSAY_GLTF_BYTE:
    case ASSAY_GLTF_UNSIGNED_BYTE: return 1;
    case ASSAY_GLTF_SHORT:
    case ASSAY_GLTF_UNSIGNED_SHORT: return 2;
    case ASSAY_GLTF_UNSIGNED_INT:
    case ASSAY_GLTF_FLOAT: break;
    }
    return 4;
}

static uint32_t element_bytes(const assay_gltf_accessor *a)
{
    return component_bytes(a->component) * a->rows * a->columns;
}

/* Bytes between elements; only data of vertices may be interleaved. */
static uint32_t element_stride(const assay_gltf_loader *loader, const assay_gltf_accessor *a)
{
    const uint32_t stride = loader->document.views[a->view].stride;
    return stride ? stride : element_bytes(a);
}

static assay_status check_kind(const assay_gltf_loader *loader, const assay_gltf_accessor *a,
                               const assay_gltf_use *use)
{
    const bool unsigned_integer = a->component == ASSAY_GLTF_UNSIGNED_BYTE ||
                                  a->component == ASSAY_GLTF_UNSIGNED_SHORT ||
                                  a->component == ASSAY_GLTF_UNSIGNED_INT;
    if (a->rows != use->rows || a->columns != use->columns) {
        return assay_gltf_fail(loader, ASSAY_ERR_FORMAT, "%s: the type has %u components, not %u",
                               use->place, a->rows * a->columns, use->rows * use->columns);
    }
    if (use->whole && (!unsigned_integer || a->normalized)) {
        return assay_gltf_fail(loader, ASSAY_ERR_FORMAT,
                               "%s: the components must be unsigned integers", use->place);
    }
    if (!use->whole && a->component == ASSAY_GLTF_UNSIGNED_INT) {
        return assay_gltf_fail(loader, ASSAY_ERR_FORMAT,
                               "%s: the components must not be 32-bit integers", use->place);
    }
    if (use->needs_unit && a->component != ASSAY_GLTF_FLOAT && !a->normalized) {
        return assay_gltf_fail(loader, ASSAY_ERR_FORMAT,
                               "%s: the components must be float or normalized", use->place);
    }
    if (a->columns > 1 && a->component != ASSAY_GLTF_FLOAT) {
        return assay_gltf_fail(loader, ASSAY_ERR_FORMAT, "%s: the components must be float",
                               use->place);
    }
    if (a->count > ASSAY_GLTF_MAX_VERTICES) {
        return assay_gltf_fail(loader, ASSAY_ERR_LIMIT,
                               "%s: has %llu elements, at most %u are read", use->place,
                               (unsigned long long)a->count, ASSAY_GLTF_MAX_VERTICES);
    }
    return ASSAY_OK;
}

/* count <= 2^28, stride <= 252 and offset <= 1e14, so nothing overflows. */
static assay_status check_range(const assay_gltf_loader *loader, const assay_gltf_use *use,
                                uint32_t view, uint64_t offset, uint64_t count, uint32_t stride,
                                uint32_t size)
{
    const uint8_t *bytes  = NULL;
    uint64_t       length = 0;
    assay_status   status = assay_gltf_view_bytes(loader, view, &bytes, &length);
    const uint64_t end    = offset + (count - 1) * stride + size;
    if (status == ASSAY_OK && end > length) {
        status = assay_gltf_fail(loader, ASSAY_ERR_FORMAT,
                                 "%s: %llu elements end at byte %llu of bufferViews/%u, which has "
                                 "%llu",
                                 use->place, (unsigned long long)count, (unsigned long long)end,
                                 view, (unsigned long long)length);
    }
    return status;
}

static assay_status check_sparse(const assay_gltf_loader *loader, const assay_gltf_accessor *a,
                                 const assay_gltf_use *use)
{
    const uint32_t size = element_bytes(a), index_size = component_bytes(a->sparse_index_component);
    if (a->sparse_count > a->count) {
        return assay_gltf_fail(
            loader, ASSAY_ERR_FORMAT, "%s: %llu sparse elements are more than its %llu elements",
            use->place, (unsigned long long)a->sparse_count, (unsigned long long)a->count);
    }
    const assay_status status =
        check_range(loader, use, a->sparse_index_view, a->sparse_index_offset, a->sparse_count,
                    index_size, index_size);
    return status == ASSAY_OK ? check_range(loader, use, a->sparse_value_view,
                                            a->sparse_value_offset, a->sparse_count, size, size)
                              : status;
}

assay_status assay_gltf_check_accessor(assay_gltf_loader *loader, uint32_t accessor,
                                       const assay_gltf_use *use)
{
    const assay_gltf_accessor *a      = &loader->document.accessors[accessor];
    const uint32_t             size   = element_bytes(a);
    assay_status               status = check_kind(loader, a, use);
    if (status == ASSAY_OK && a->view != ASSAY_NONE) {
        const uint32_t stride = element_stride(loader, a);
        if (stride != size && (!use->vertex || stride < size)) {
            return assay_gltf_fail(loader, ASSAY_ERR_FORMAT,
                                   "%s: byteStride %u of bufferViews/%u does not fit its elements "
                                   "of %u bytes",
                                   use->place, stride, a->view, size);
        }
        status = check_range(loader, use, a->view, a->offset, a->count, stride, size);
    }
    if (status == ASSAY_OK && a->sparse_count) {
        status = check_sparse(loader, a, use);
    }
    return status;
}

/* ---- reading ---- */

static uint32_t read_unsigned(const uint8_t *from, assay_gltf_component component)
{
    uint32_t value = 0;
    memcpy(&value, from, component_bytes(component));
    return value;
}

static float read_float(const uint8_t *from, const assay_gltf_accessor *a)
{
    float   f;
    int8_t  s8;
    int16_t s16;
    switch (a->component) {
    case ASSAY_GLTF_FLOAT: memcpy(&f, from, sizeof f); return f;
    case ASSAY_GLTF_BYTE:
        memcpy(&s8, from, sizeof s8);
        return a->normalized ? (float)fmax(s8 / 127.0, -1.0) : (float)s8;
    case ASSAY_GLTF_SHORT:
        memcpy(&s16, from, sizeof s16);
        return a->normalized ? (float)fmax(s16 / 32767.0, -1.0) : (float)s16;
    case ASSAY_GLTF_UNSIGNED_BYTE:
    case ASSAY_GLTF_UNSIGNED_SHORT:
    case ASSAY_GLTF_UNSIGNED_INT: break;
    }
    const double largest = a->component == ASSAY_GLTF_UNSIGNED_BYTE ? 255.0 : 65535.0;
    const double value   = read_unsigned(from, a->component);
    return (float)(a->normalized ? value / largest : value);
}

/* Where elements go: floats or unsigned integers, `stride` of them apart. */
typedef struct {
    float    *floats;
    uint32_t *whole;
    uint32_t  stride;
} target;

static assay_status read_element(const assay_gltf_loader *loader, const assay_gltf_accessor *a,
                                 const assay_gltf_use *use, const uint8_t *from, uint64_t element,
                                 const target *to, uint32_t slot)
{
    const size_t size = component_bytes(a->component), count = (size_t)a->rows * a->columns;
    for (size_t c = 0; c < count; c++) {
        const size_t at = (size_t)slot * to->stride + c;
        if (to->whole) {
            to->whole[at] = read_unsigned(from + c * size, a->component);
            continue;
        }
        to->floats[at] = read_float(from + c * size, a);
        if (!isfinite(to->floats[at])) {
            return assay_gltf_fail(loader, ASSAY_ERR_FORMAT, "%s: element %llu is not finite",
                                   use->place, (unsigned long long)element);
        }
    }
    return ASSAY_OK;
}

/* Puts the sparse elements over those that were read. */
static assay_status read_sparse(const assay_gltf_loader *loader, const assay_gltf_accessor *a,
                                const assay_gltf_use *use, const uint32_t *chosen, uint32_t count,
                                const target *to)
{
    const uint8_t *indices = NULL, *values = NULL;
    uint64_t       length = 0;
    assay_status   status = assay_gltf_view_bytes(loader, a->sparse_index_view, &indices, &length);
    if (status == ASSAY_OK) {
        status = assay_gltf_view_bytes(loader, a->sparse_value_view, &values, &length);
    }
    const uint32_t step = component_bytes(a->sparse_index_component);
    uint32_t       slot = 0;
    int64_t        last = -1;
    for (uint64_t k = 0; k < a->sparse_count && status == ASSAY_OK; k++) {
        const uint32_t index =
            read_unsigned(indices + a->sparse_index_offset + k * step, a->sparse_index_component);
        if ((int64_t)index <= last || index >= a->count) {
            return assay_gltf_fail(loader, ASSAY_ERR_FORMAT,
                                   "%s: sparse index %llu is %u, must rise and be below %llu",
                                   use->place, (unsigned long long)k, index,
                                   (unsigned long long)a->count);
        }
        last = index;
        while (slot < count && (chosen ? chosen[slot] : slot) < index) {
            slot++;
        }
        if (slot < count && (chosen ? chosen[slot] : slot) == index) {
            const uint8_t *from = values + a->sparse_value_offset + k * element_bytes(a);
            status              = read_element(loader, a, use, from, index, to, slot);
        }
    }
    return status;
}

static assay_status read_elements(assay_gltf_loader *loader, uint32_t accessor,
                                  const assay_gltf_use *use, const uint32_t *chosen, uint32_t count,
                                  const target *to)
{
    const assay_gltf_accessor *a      = &loader->document.accessors[accessor];
    const uint8_t             *bytes  = NULL;
    uint64_t                   length = 0;
    assay_status               status = ASSAY_OK;
    if (a->view != ASSAY_NONE) {
        status = assay_gltf_view_bytes(loader, a->view, &bytes, &length);
    }
    for (uint32_t i = 0; bytes && i < count && status == ASSAY_OK; i++) {
        const uint64_t element = chosen ? chosen[i] : i;
        const uint8_t *from    = bytes + a->offset + element * element_stride(loader, a);
        status                 = read_element(loader, a, use, from, element, to, i);
    }
    if (status == ASSAY_OK && a->sparse_count) {
        status = read_sparse(loader, a, use, chosen, count, to);
    }
    return status;
}

/* Room for `count` elements `stride` numbers of 4 bytes apart, where there is none yet. */
static assay_status make_room(assay_gltf_loader *loader, uint32_t accessor, uint32_t count,
                              uint32_t stride, void **values)
{
    const uint64_t     sparse = loader->document.accessors[accessor].sparse_count;
    const assay_status status =
        assay_gltf_count_decoded(loader, (uint64_t)count * stride + sparse, 4);
    if (status == ASSAY_OK && !*values) {
        *values = assay_allocate(loader->context, (size_t)count * stride, 4);
        return *values ? ASSAY_OK : assay_fail_memory(loader->context, "the values of an accessor");
    }
    return status;
}

assay_status assay_gltf_read_floats(assay_gltf_loader *loader, uint32_t accessor,
                                    const assay_gltf_use *use, const uint32_t *chosen,
                                    uint32_t count, uint32_t stride, uint32_t first, float **values)
{
    const assay_status status = make_room(loader, accessor, count, stride, (void **)values);
    if (status != ASSAY_OK) {
        return status;
    }
    assert(*values);
    const target to = {.floats = *values + first, .stride = stride};
    return read_elements(loader, accessor, use, chosen, count, &to);
}

assay_status assay_gltf_read_whole(assay_gltf_loader *loader, uint32_t accessor,
                                   const assay_gltf_use *use, const uint32_t *chosen,
                                   uint32_t count, uint32_t stride, uint32_t first,
                                   uint32_t **values)
{
    const assay_status status = make_room(loader, accessor, count, stride, (void **)values);
    if (status != ASSAY_OK) {
        return status;
    }
    assert(*values);
    const target to = {.whole = *values + first, .stride = stride};
    return read_elements(loader, accessor, use, chosen, count, &to);
}
