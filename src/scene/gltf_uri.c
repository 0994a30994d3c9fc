/* gltf_uri.c - Invariant: decoding never makes a text longer, so it happens in place. */
#include <string.h>

#include "scene/gltf_loader.h"

static int hex_value(char c)
{
    if (c >= '0' && c <= '9') {
        return c - '0';
    }
    const char lower = (char)(c | 0x20);
    return lower >= 'a' && lower <= 'f' ? lower - 'a' + 10 : -1;
}

bool assay_gltf_uri_has_scheme(const char *uri)
{
    const char *p = uri;
    while ((*p >= 'a' && *p <= 'z') || (*p >= 'A' && *p <= 'Z') ||
           (p > uri && ((*p >= '0' && *p <= '9') || *p == '+' || *p == '-' || *p == '.'))) {
        p++;
    }
    return p > uri && *p == ':';
}

bool assay_gltf_uri_decode(char *text, size_t *length_out)
{
    bool  has_nul = false;
    char *to      = text;
    for (const char *from = text; *from; from++) {
        const int high = from[0] == '%' ? hex_value(from[1]) : -1;
        const int low  = high >= 0 ? hex_value(from[2]) : -1;
        if (low < 0) {
            *to++ = *from;
            continue;
        }
        has_nul |= high == 0 && low == 0;
        *to++ = (char)(high << 4 | low);
        from += 2;
    }
    *to         = 0;
    *length_out = (size_t)(to - text);
    return !has_nul;
}

static int base64_value(char c)
{
    if (c >= 'A' && c <= 'Z') {
        return c - 'A';
    }
    if (c >= 'a' && c <= 'z') {
        return c - 'a' + 26;
    }
    if (c >= '0' && c <= '9') {
        return c - '0' + 52;
    }
    return c == '+' ? 62 : c == '/' ? 63 : -1;
}

bool assay_gltf_base64_decode(char *text, size_t length, size_t *length_out)
{
    size_t   used    = 0;
    uint32_t bits    = 0;
    int      pending = 0; /* bits that wait, 0, 6, 4 or 2 between characters */
    size_t   padding = 0;
    while (padding < 2 && length > 0 && text[length - 1] == '=') {
        length--;
        padding++;
    }
    if ((padding && (length + padding) % 4 != 0) || length % 4 == 1) {
        return false;
    }
    for (size_t i = 0; i < length; i++) {
        const int value = base64_value(text[i]);
        if (value < 0) {
            return false;
        }
        bits = bits << 6 | (uint32_t)value;
        pending += 6;
        if (pending >= 8) {
            pending -= 8;
            text[used++] = (char)(bits >> pending & 0xFF);
        }
    }
    *length_out = used;
    return true;
}
