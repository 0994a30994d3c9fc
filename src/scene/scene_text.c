/* scene_text.c - Invariant: what comes out is valid UTF-8 without control characters, so it can
 * neither break a line of a log nor a JSON report. */
#include "scene/scene_text.h"

#include <stdbool.h>

/* Length of the well-formed character at b (Unicode, table 3-7), 0 where there is none.  The NUL at
 * the end of the text is no continuation byte and stops the look ahead. */
static int character_length(const unsigned char *b)
{
    const bool c1 = (b[0] >= 0xC2) && (b[1] & 0xC0) == 0x80;
    if (b[0] < 0x80) {
        return 1;
    }
    if (!c1) {
        return 0;
    }
    if (b[0] <= 0xDF) {
        return 2;
    }
    const bool c2 = (b[2] & 0xC0) == 0x80;
    if (b[0] <= 0xEF) {
        const bool sound = !(b[0] == 0xE0 && b[1] < 0xA0) && !(b[0] == 0xED && b[1] > 0x9F);
        return c2 && sound ? 3 : 0;
    }
    const bool sound =
        b[0] <= 0xF4 && !(b[0] == 0xF0 && b[1] < 0x90) && !(b[0] == 0xF4 && b[1] > 0x8F);
    return sound && c2 && (b[3] & 0xC0) == 0x80 ? 4 : 0;
}

void assay_text_clean(const char *text, char *clean_out, size_t size)
{
    const unsigned char *b    = (const unsigned char *)text;
    size_t               used = 0;
    while (*b) {
        const int    length = character_length(b);
        const size_t needed = length ? (size_t)length : 1;
        if (used + needed >= size) {
            break;
        }
        if (length == 0 || (length == 1 && (b[0] < 0x20 || b[0] == 0x7F))) {
            clean_out[used++] = '?';
        } else {
            for (int i = 0; i < length; i++) {
                clean_out[used++] = (char)b[i];
            }
        }
        b += needed;
    }
    clean_out[used] = 0;
}
