/* stroke_font.h - letters as lines. */
#ifndef ASSAY_IO_STROKE_FONT_H
#define ASSAY_IO_STROKE_FONT_H

/* Heights in the font's units: the baseline, the top of capitals, of small letters. */
enum { STROKE_BASELINE = 3, STROKE_CAPITAL = 11, STROKE_GAP = 3, STROKE_BLANK = 3 };

/* Strokes of a character: pairs of hexadecimal digits x, y (y upwards), strokes apart by blanks.
 * "" for a blank and for what the font does not have. */
const char *assay_stroke_glyph(char character);

/* Units from a character's left end to the next one's. */
int assay_stroke_advance(char character);

#endif
