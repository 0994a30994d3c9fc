/* encoded_image.h - PNG and JPEG files of every kind, made in memory by libpng and libjpeg. */
#ifndef ASSAY_TESTS_ENCODED_IMAGE_H
#define ASSAY_TESTS_ENCODED_IMAGE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct {
    uint32_t width, height;
    int      color_type; /* PNG_COLOR_TYPE_...                                         */
    int      bits;       /* 1, 2, 4, 8, 16                                             */
    bool     interlaced;
    bool     with_gamma; /* gAMA, cHRM and text chunks that must not change a texel    */
    int      palette_count;
    uint8_t  palette[256][4]; /* the fourth, alpha, is written where transparent          */
    bool     transparent;     /* tRNS: the palette's alpha, or the colour below           */
    uint16_t transparent_color[3];
} png_spec;

/* samples: channels * width a row, one sample each whatever the bits.  Release with free. */
uint8_t *png_bytes(const png_spec *spec, const uint16_t *samples, size_t *count_out);

typedef struct {
    uint32_t width, height;
    int      channels; /* 1 grey, 3 YCbCr from RGB, 4 CMYK      */
    int      quality;  /* 1 to 100                              */
    bool     progressive, arithmetic, subsampled;
} jpeg_spec;

/* samples: channels * width a row.  Release with free. */
uint8_t *jpeg_bytes(const jpeg_spec *spec, const uint8_t *samples, size_t *count_out);

#endif
