/* cornell_spectra.h - the measured spectra of the Cornell box as linear Rec. 709 colours. */
#ifndef ASSAY_SCENES_CORNELL_SPECTRA_H
#define ASSAY_SCENES_CORNELL_SPECTRA_H

typedef enum { CORNELL_WHITE, CORNELL_GREEN, CORNELL_RED } cornell_paint;

/* Reflectance under D65, scaled so that a perfect diffuser is (1, 1, 1); rounded to 1e-4. */
void cornell_reflectance(cornell_paint paint, double rgb_out[3]);

/* Radiance of the lamp, W/(m2 sr), scaled so that a spectrum of constant radiance L has the
 * relative luminance L (0.2126 R + 0.7152 G + 0.0722 B); rounded to 1e-4. */
void cornell_radiance(double rgb_out[3]);

#endif
