/* scene_text.h - text from files, made fit for one line of a message or a report. */
#ifndef ASSAY_SCENE_SCENE_TEXT_H
#define ASSAY_SCENE_SCENE_TEXT_H

#include <stddef.h>

/* Writes `text` to clean_out (size bytes, its NUL included): control characters and bytes that are
 * not UTF-8 become '?', what does not fit is cut between characters.  text and clean_out are
 * different. */
void assay_text_clean(const char *text, char *clean_out, size_t size);

#endif
