#!/bin/sh
# shellcheck disable=SC2086
# A backend that shares nothing with assay passes `assay verify`, however its compiler rounds, and each
# mistake of mutations.txt is found at the stage where it was planted.  Prints TAP and a table.
#
# BACKEND_COMPILE, BACKEND_LIBS, BACKEND_OBJECTS (its folder of objects) come from the Makefile.
. tests/support/tap.sh
: "${BACKEND_COMPILE:?run this through make test}" "${BACKEND_LIBS:?}" "${BACKEND_OBJECTS:?}"
sources=tests/backends

# ---- nothing shared ----
! grep -n '#include' $sources/*.[ch] | grep -E '"(assay|core|math|basis|io|scene|trace|gather|photon|record|methods|oracle|cli|support)/|<assay'
result $? "the backend includes nothing of assay"

# ---- the reference ----
few="--size 32x32 --spp 1 --a 0.4 --in-front on --theta-strata 4 --phi-strata 12 --bounces 2
    --secondary direct --gbuffer centres --dump-batch 40"
run render $box -q -m splat $few -o "$folder/box.exr" --dump "$folder/box"
went_well
result $? "a reference is rendered"
scene=$box
glossy_box=scenes/cornell-box-glossy/cornell-box-glossy.gltf
shiny="--size 16x16 --spp 1 --a 0.5 --theta-strata 3 --phi-strata 9 --bounces 2 --secondary direct
    --gbuffer centres --order 4 --glossy-accuracy 0 --grid 6 --nodes 12"
run render $glossy_box -q -m splat $shiny \
    -o "$folder/shiny.exr" --dump "$folder/shiny"
went_well
result $? "a glossy one, too"

# Runs backend PROGRAM for KIND and verifies what it made, an image also against $scene; leaves $code
# and $failing (stages that do not pass).
verify() { # PROGRAM KIND REFERENCE
    case $2 in
    image) given=$3 against="--reference $3 --scene $scene" ;;
    questions) given=$3 against= ;;
    *) given='' against= ;;
    esac
    rm -rf "$folder/made"
    code=3 failing=
    "$1" "$2" $given "$folder/made" || return
    run verify "$folder/made" $against --precision float -q --json "$folder/verdict.json"
    failing=$(awk -F'"' '$2 == "stage" { stage = $4 }
        $2 == "verdict" && $4 != "pass" && stage && !(stage in seen) { seen[stage]; print stage }
        ' "$folder/verdict.json" | tr '\n' ' ')
}

# ---- it passes ----
passes() { # NAME PROGRAM
    for kind in image questions cells hemisphere sphere; do
        passes_at "$1" "$2" $kind "$folder/box"
    done
}
passes_at() { # NAME PROGRAM KIND REFERENCE
    verify "$2" "$3" "$4"
    [ "$code" -eq 0 ] || explain "$3: a pass was expected; stages that fail: $failing"
    [ "$code" -eq 0 ]
    result $? "$1: $3 passes"
}
passes "as it is" "$BACKEND_OBJECTS/backend"
scene=$glossy_box
passes_at "glossy walls" "$BACKEND_OBJECTS/backend" image "$folder/shiny"
scene=$box
passes_at "glossy walls" "$BACKEND_OBJECTS/backend" questions "$folder/shiny"

# Other roundings than ours: products and sums in one, and none kept in registers.
flavour() { # NAME FLAGS
    if $BACKEND_COMPILE $2 $sources/*.c -o "$folder/other" $BACKEND_LIBS 2> "$folder/log" &&
        "$folder/other" cells "$folder/cells.$number" 2> /dev/null; then
        passes "$1" "$folder/other"
    else
        skip "$1" "not of this compiler or machine"
    fi
}
flavour "fused products" "-O2 -mfma -ffp-contract=fast"
flavour "without optimisation" "-O0"

# ---- each mistake is found where it is ----
plant() { # NAME: builds $folder/mutant
    file=$(grep -l "IS_PLANTED($1)" $sources/*.[ch] | head -n 1)
    file=${file##*/}
    unit=$file
    [ "$file" != harmonics_body.h ] || unit=harmonics.c
    others=$(find "$BACKEND_OBJECTS" -name '*.o' ! -name "${unit%.c}.o")
    $BACKEND_COMPILE -O0 -DPLANTED="$1" -c "$sources/$unit" -o "$folder/mutant.o" &&
        $BACKEND_COMPILE "$folder/mutant.o" $others -o "$folder/mutant" $BACKEND_LIBS
}
printf '#| %-25s %-20s %s\n' mistake 'planted in' 'stages that fail'
while IFS='|' read -r name kind stage what; do
    case $name in "#"* | "") continue ;; esac
    name=$(echo $name) kind=$(echo $kind) stage=$(echo $stage)
    failing= code=3
    plant "$name" && verify "$folder/mutant" "$kind" "$folder/box"
    printf '#| %-25s %-20s %s\n' "$name" "$stage" "$failing"
    expected=1
    [ "$stage" != inputs ] || expected=2
    [ "$code" -eq $expected ] && [ "$failing" = "$stage " ]
    result $? "$stage:$what"
done < $sources/mutations.txt

# ---- the pages do what they say ----
root=$(pwd)
mkdir "$folder/bin"
ln -s "$(realpath "$assay")" "$folder/bin/assay"
ln -s "$(realpath "$BACKEND_OBJECTS/backend")" "$folder/bin/my-backend"

walk() { # NAME: runs $folder/commands, in a folder that has scenes and tests alone
    place=$folder/walk-$number
    mkdir "$place" "$place/tests"
    ln -s "$root/scenes" "$place/scenes"
    ln -s "$root/tests/backends" "$place/tests/backends"
    ln -s "$folder/bin/my-backend" "$place/my-backend"
    [ -s "$folder/commands" ] &&
        (cd "$place" && PATH=$folder/bin:$PATH timeout 120 sh -eu "$folder/commands") \
            > "$folder/log" 2>&1
    code=$?
    [ $code -eq 0 ] || sed 's/^/# /' "$folder/log"
    result $code "$1"
}
shell_of() { # PAGE
    awk '/^```sh$/ { inside = 1; next } /^```/ { inside = 0 } inside' "docs/$1.md"
}
# What a workflow runs, but for what installs and builds.
workflow_of() { # PAGE
    awk '/^```yaml$/ { yaml = 1 } /^```$/ { yaml = 0 }
        yaml && /run: \|$/ { run = 1; next }
        run && /^          / { print substr($0, 11); next }
        { run = 0 }' "docs/$1.md" |
        sed -e '/^apt-get/d' -e '/^git/d' -e '/^make/d' -e "s|/opt/assay|$root|"
}
shell_of backends > "$folder/commands"
walk "docs/backends.md: its commands"
grep -q 'normalise .*splat/result.* pass ' "$folder/log" &&
    grep -q 'First stage that fails: weights' "$folder/log"
result $? "docs/backends.md: and they print what it says"
shell_of ci > "$folder/commands"
walk "docs/ci.md: its commands"
workflow_of ci > "$folder/commands"
[ "$(grep -c '^assay \|^./my-backend' "$folder/commands")" -eq 3 ]
result $? "docs/ci.md: a workflow of three steps"
walk "docs/ci.md: its workflow"
finish
