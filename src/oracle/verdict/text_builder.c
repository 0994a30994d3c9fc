/* text_builder.c - printf at the end of a block that doubles.
 *
 * Invariant: text[length] is NUL, and capacity > length, once anything was added. */
#include "oracle/verdict/text_builder.h"

#include <stdarg.h>
#include <stdio.h>

#include "core/alloc.h"
#include "core/context.h"

assay_text_builder assay_text_start(assay_context *context)
{
    return (assay_text_builder){.context = context};
}

static bool make_room(assay_text_builder *builder, size_t more)
{
    if (!builder->failed) {
        builder->failed = assay_grow(builder->context, (void **)&builder->text, &builder->capacity,
                                     builder->length + more + 1, 1) != ASSAY_OK;
    }
    return !builder->failed;
}

void assay_text_add(assay_text_builder *builder, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    va_list again;
    va_copy(again, arguments);
    const int needed = vsnprintf(NULL, 0, format, arguments);
    va_end(arguments);
    if (needed < 0) {
        builder->failed = true;
    } else if (make_room(builder, (size_t)needed)) {
        vsnprintf(builder->text + builder->length, (size_t)needed + 1, format, again);
        builder->length += (size_t)needed;
    }
    va_end(again);
}

void assay_text_add_char(assay_text_builder *builder, char c)
{
    if (make_room(builder, 1)) {
        builder->text[builder->length++] = c;
        builder->text[builder->length]   = '\0';
    }
}

assay_status assay_text_finish(assay_text_builder *builder, const char *what, char **text_out)
{
    if (!make_room(builder, 0)) {
        assay_release(builder->context, builder->text);
        builder->text = NULL;
        return assay_fail_memory(builder->context, what);
    }
    *text_out     = builder->text;
    builder->text = NULL;
    return ASSAY_OK;
}
