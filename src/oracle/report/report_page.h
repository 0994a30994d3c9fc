/* report_page.h - the page without its data: src/oracle/report/page/, made C by embed.sh.  Each
 * part is a text that ends with a NUL. */
#ifndef ASSAY_ORACLE_REPORT_PAGE_H
#define ASSAY_ORACLE_REPORT_PAGE_H

extern const char assay_report_page_before_title[];
extern const char assay_report_page_before_data[];
extern const char assay_report_page_after_data[];

#endif
