#!/bin/sh
# embed.sh - the page of a report as C: report.html with the style sheet and the scripts in place, cut
# where title and data go (src/oracle/report/report_page.h).
set -eu
cd "$(dirname "$0")"
page=$(mktemp)
trap 'rm -f "$page"' EXIT
awk '/^@STYLE@$/ { while ((getline line < "report.css") > 0) print line; next }
     /^@SCRIPT@$/ { print "\"use strict\";"; print "(() => {"
                    n = split("data colour stage viewer charts tables report", names, " ")
                    for (i = 1; i <= n; i++) while ((getline line < (names[i] ".js")) > 0) print line
                    print "})();"; next }
     { print }' report.html > "$page"

part() { # NAME FROM TO: the lines behind the mark FROM and before the mark TO
    printf 'const char assay_report_page_%s[] = {' "$1"
    awk -v from="$2" -v to="$3" '$0 == to { exit } on || from == "" { print } $0 == from { on = 1 }' "$page" |
        od -An -v -t d1 | sed 's/-*[0-9]\{1,\}/&,/g'
    echo '0};'
}
echo '#include "oracle/report/report_page.h"'
part before_title '' @TITLE@
part before_data @TITLE@ @DATA@
part after_data @DATA@ @END@
