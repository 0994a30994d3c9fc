/* report_records.h - where the records of a bundle lie in its image. */
#ifndef ASSAY_ORACLE_REPORT_RECORDS_H
#define ASSAY_ORACLE_REPORT_RECORDS_H

#include "oracle/report/report_source.h"
#include "oracle/report/report_text.h"

/* Writes the member "records": the records of a bundle as its camera sees them, four numbers each
 * (x, y of the centre and the radius R in eighths of a pixel; 1 where something hides it), how many
 * there are, and how many of them are looked at (evenly chosen where there are very many).  Writes
 * nothing where there are none, or no camera that they could be seen through.  Errors: FORMAT
 * (columns, or rows of positions and radii, that records do not have), those of
 * assay_bundle_read_array. */
assay_status assay_report_records_put(const assay_report_source *source, assay_report_text *text);

#endif
