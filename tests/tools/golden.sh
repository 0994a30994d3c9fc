#!/bin/sh
# shellcheck disable=SC2013,SC2046
# golden.sh check [quick | ENTRY...]    renders the golden images again and compares every bit
# golden.sh renew                       the same, and takes what changed, with $REASON
#
# refdata/golden/MANIFEST says what is rendered and what came out (refdata/README.md).  Commands run
# in a temporary folder that has `scenes`; an entry may read the image of another one.  Prints TAP.
# $ASSAY_BIN is the program, $BUILD where the helper is, $GOLDEN another folder than refdata/golden.
set -u
golden=${GOLDEN:-refdata/golden}
assay=${ASSAY_BIN:-build/release/assay}
tool=${BUILD:-build/release}/tests/golden/golden_arrays
case $assay in /*) ;; *) assay=$PWD/$assay ;; esac
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
mkdir "$work/run" "$work/old" "$work/new"
ln -s "$PWD/scenes" "$work/run/scenes"
number=0
failures=0

stop() { echo "golden: $1" >&2; exit 2; }

result() { # STATUS NAME
    number=$((number + 1))
    if [ "$1" -eq 0 ]; then
        echo "ok $number - golden: $2"
    else
        failures=$((failures + 1))
        echo "not ok $number - golden: $2"
    fi
}

# The manifest's entries as files of their own, their names in order, and what stands before them.
split_manifest() {
    [ -f "$golden/MANIFEST" ] || stop "$golden/MANIFEST is missing"
    : > "$work/names"
    : > "$work/head"
    awk -v work="$work" '
        $1 == "entry" {
            if ($2 !~ /^[a-z0-9][a-z0-9-]*$/ || $2 in seen || NF > 3 || (NF == 3 && $3 != "quick")) {
                print "line " NR ": a name in small letters, once, and maybe `quick`"
                exit
            }
            seen[$2] = 1; name = $2; print name > (work "/names")
        }
        name == "" { print > (work "/head"); next }
        NF { print > (work "/old/" name) }' "$golden/MANIFEST" > "$work/wrong"
    [ ! -s "$work/wrong" ] || stop "$golden/MANIFEST: $(cat "$work/wrong")"
    [ -s "$work/names" ] || stop "$golden/MANIFEST has no entries"
}

# What an entry says after a word.
says() { sed -n "s/^$2 //p" "$work/old/$1"; }

command_of() { # NAME: fails where it is none, or writes somewhere else
    command=$(says "$1" command)
    case "$command " in
    *'
'*) return 1 ;;
    "assay render "*" -o $1.exr --dump $1 ") ;;
    *) return 1 ;;
    esac
}

# Images of other entries that a command reads: as they are now, else as they are kept.
fetch_inputs() { # NAME ARGUMENT...
    own=$1.exr
    shift
    for word; do
        case $word in
        "$own" | */*) ;;
        *.exr) [ -e "$work/run/$word" ] || cp "$golden/$word" "$work/run" 2> /dev/null ;;
        esac
    done
    return 0
}

# Renders an entry into $work/run and says what came out in $work/new/NAME and NAME.exr.
render() { # NAME
    set -f
    # shellcheck disable=SC2086
    set -- "$1" $command
    set +f
    name=$1
    shift 2
    fetch_inputs "$name" "$@"
    (cd "$work/run" && "$assay" "$@" --quiet) > "$work/said" 2>&1 &&
        "$tool" keep "$work/run/$name.exr" "$work/new/$name.exr" > "$work/said" 2>&1 &&
        "$tool" digest "$work/new/$name.exr" > "$work/digest" 2> "$work/said" &&
        "$tool" list "$work/run/$name" > "$work/list" 2> "$work/said" || return 1
    rm -rf "${work:?}/run/$name"
    { grep -v '^array' "$work/list"
      echo "image $(cat "$work/digest")"
      grep '^array' "$work/list"; } > "$work/new/$name"
}

# What must be the same bits: everything that was rendered, but for the version.
bits() { grep -E '^(seed|samples|image|array) ' "$1"; }

# The first array that is not what it was; nothing where all are.
first_array() { # NAME
    awk '
        $1 != "array" { next }
        NR == FNR { if (!($2 in type)) order[++count] = $2; type[$2] = $3 " " $4; hash[$2] = $5; next }
        { now_type[$2] = $3 " " $4; now[$2] = $5; if (!($2 in hash) && extra == "") extra = $2 }
        END {
            for (i = 1; i <= count; i++) {
                a = order[i]
                if (!(a in now)) { print a " is no more"; exit }
                if (type[a] != now_type[a]) { print a ": " now_type[a] ", golden " type[a]; exit }
                if (hash[a] != now[a]) { print a ": other values"; exit }
            }
            if (extra != "") print extra " is new"
        }' "$work/old/$1" "$work/new/$1"
}

explain() { # NAME: why what came out is not golden
    first=$(first_array "$1")
    [ -z "$first" ] || echo "# first array that differs: $first"
    for word in seed samples; do
        now=$(sed -n "s/^$word //p" "$work/new/$1")
        [ "$now" = "$(says "$1" $word)" ] || echo "# $word: $now, golden $(says "$1" $word)"
    done
    echo "# $("$tool" compare "$golden/$1.exr" "$work/new/$1.exr" 2>&1)"
}

check_entry() { # NAME
    if ! command_of "$1"; then
        result 1 "$1: its command must be 'assay render ... -o $1.exr --dump $1'"
    elif [ -z "$(says "$1" image)" ] || [ -z "$(says "$1" array)" ] || [ -z "$(says "$1" reason)" ]; then
        result 1 "$1: was never rendered, or lines are missing"
    elif [ ! -f "$golden/$1.exr" ]; then
        result 1 "$1: $golden/$1.exr is missing"
    elif [ "$("$tool" digest "$golden/$1.exr" 2>&1)" != "$(says "$1" image)" ]; then
        result 1 "$1: $golden/$1.exr is not the image that the MANIFEST lists"
    elif ! render "$1"; then
        result 1 "$1: cannot be rendered"
        sed 's/^/# /' "$work/said"
    elif ! bits "$work/old/$1" > "$work/a" || ! bits "$work/new/$1" > "$work/b" ||
         ! cmp -s "$work/a" "$work/b" || ! "$tool" compare "$golden/$1.exr" "$work/new/$1.exr" > /dev/null
    then
        result 1 "$1: other bits"
        explain "$1"
    else
        result 0 "$1: $(grep -c '^array' "$work/new/$1") arrays and the image, the same bits"
    fi
}

# Files that no entry lists.
strays() {
    for file in "$golden"/*; do
        name=${file##*/}
        [ "$name" = MANIFEST ] || { [ "${name%.exr}" != "$name" ] && grep -qx "${name%.exr}" "$work/names"; } ||
            echo "$file"
    done
}

check() {
    if [ $# -eq 0 ]; then
        set -- $(cat "$work/names")
    elif [ "$*" = quick ]; then
        set -- $(cat "$work"/old/* | sed -n 's/^entry \(.*\) quick$/\1/p')
        [ $# -gt 0 ] || stop "no entry is quick"
    fi
    for name; do
        grep -qx -- "$name" "$work/names" || stop "$golden/MANIFEST has no entry $name"
    done
    for name in $(cat "$work/names"); do
        case " $* " in *" $name "*) check_entry "$name" ;; esac
    done
    stray=$(strays)
    [ -z "$stray" ]
    result $? "no file that the MANIFEST does not list${stray:+: $stray}"
    echo "1..$number"
    [ $failures -eq 0 ]
}

# ---- renewing ----
same_as_before() { # NAME
    bits "$work/old/$1" > "$work/a"
    bits "$work/new/$1" > "$work/b"
    cmp -s "$work/a" "$work/b" &&
        "$tool" compare "$golden/$1.exr" "$work/new/$1.exr" > /dev/null 2>&1
}

renew() {
    case ${REASON:-} in
    *[[:alnum:]]*) ;;
    *) stop "say why: make golden REASON=\"...\"" ;;
    esac
    [ "$(printf '%s\n' "$REASON" | wc -l)" -eq 1 ] || stop "the reason must be one line"
    renewed=
    cat "$work/head" > "$work/MANIFEST"
    for name in $(cat "$work/names"); do
        command_of "$name" ||
            stop "$name: its command must be 'assay render ... -o $name.exr --dump $name'"
        render "$name" || stop "$name: cannot be rendered: $(cat "$work/said")"
        if same_as_before "$name"; then
            cat "$work/old/$name" >> "$work/MANIFEST"
        else
            echo "golden: $name is renewed"
            renewed="$renewed $name"
            { grep -E '^(entry|command) ' "$work/old/$name"
              sed -n '/^version /p; /^seed /p; /^samples /p' "$work/new/$name"
              echo "renewed $(date -u +%Y-%m-%d)"
              printf 'reason %s\n' "$REASON"
              grep -E '^(image|array) ' "$work/new/$name"; } >> "$work/MANIFEST"
        fi
        echo >> "$work/MANIFEST"
    done
    for name in $renewed; do
        cp "$work/new/$name.exr" "$golden/$name.exr" || exit 1
    done
    for file in $(strays); do
        echo "golden: $file is removed"
        rm "$file"
    done
    sed '$d' "$work/MANIFEST" > "$golden/MANIFEST.tmp" && mv "$golden/MANIFEST.tmp" "$golden/MANIFEST" ||
        exit 1
    echo "golden: $(echo "$renewed" | wc -w) of $(grep -c . "$work/names") entries renewed"
}

[ -x "$tool" ] || stop "$tool is missing: make golden-check builds it"
split_manifest
mode=${1:-}
[ $# -eq 0 ] || shift
case $mode in
check) check "$@" ;;
renew) renew ;;
*) stop "check [quick | ENTRY...], or renew" ;;
esac
