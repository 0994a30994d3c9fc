/* exr_files.h - OpenEXR files of every kind, made in memory by OpenEXRCore's encoder. */
#ifndef ASSAY_TESTS_EXR_FILES_H
#define ASSAY_TESTS_EXR_FILES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <OpenEXR/openexr.h>

enum { EXR_FILE_CHANNELS = 6 };

/* samples: width * height of the type (HALF: uint16_t), row by row; names ascending. */
typedef struct {
    const char      *name;
    exr_pixel_type_t type;
    const void      *samples;
    int              sampling; /* 0 stands for 1 */
} exr_file_channel;

typedef struct {
    int                              width, height; /* of the data window                        */
    int                              x, y;          /* its corner                                */
    exr_attr_box2i_t                 display;       /* all 0: the data window                    */
    exr_compression_t                compression;
    int                              tile_width, tile_height; /* 0: scan lines                   */
    bool                             mipmap; /* with all its levels               */
    bool                             deep;   /* header alone                    */
    int                              parts;  /* 0 stands for 1; equal contents  */
    exr_file_channel                 channels[EXR_FILE_CHANNELS];
    int                              channel_count;
    const exr_attr_chromaticities_t *chromaticities; /* NULL: none                */
    int                              aces;           /* acesImageContainerFlag; 0: none */
} exr_file_spec;

/* Fails the test on any error.  Release with free. */
uint8_t *exr_file_bytes(const exr_file_spec *spec, size_t *count_out);

#endif
