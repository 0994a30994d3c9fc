#!/bin/sh
# shellcheck disable=SC2012,SC2046,SC2059,SC2086
# Inputs that are no inputs: folders, devices, pipes, empty and random files, tables that are no
# points.  Each is refused in one line that names it, at once, and nothing is written.  TAP.
. tests/support/tap.sh

mkfifo "$folder/pipe"
mkdir "$folder/directory"
: > "$folder/empty"
# 4096 bytes that are the same in every run, of every value.
awk 'BEGIN { srand(7); for (i = 0; i < 4096; i++) printf "\\%03o", int(rand() * 256) }' |
    while IFS= read -r text; do printf "$text"; done > "$folder/random"
printf '{"asset":{"version":"2.0"}' > "$folder/half.gltf"
"$assay" render $box $small --layers color -o "$folder/good.exr"
head -c 400 "$folder/good.exr" > "$folder/cut.exr"
write_npy "$folder/good.npy" "1, 6" 0 h 0 0 1 0
head -c 150 "$folder/good.npy" > "$folder/cut.npy"

# The file in every place where a file is read.  $1: what it is, $2: its name.
everywhere() {
    word=${2##*/}
    refuses "scene: $1" 2 "$word" scene "$2"
    refuses "scene --json: $1" 2 "$word" scene "$2" --json
    refuses "render: $1" 2 "$word" render "$2" -o "$out/a.exr" --png "$out/a.png" \
        --stats "$out/a.json" --dump "$out/bundle"
    refuses "environment: $1" 2 "$word" render $box -o "$out/a.exr" --env "$2"
    refuses "points: $1" 2 "$word" render $box -o "$out/a.npy" --points "$2"
    refuses "diff, first: $1" 2 "$word" diff "$2" "$folder/good.exr" --heat-map "$out/h.png"
    refuses "diff, second: $1" 2 "$word" diff "$folder/good.exr" "$2" --heat-map "$out/h.png"
}
everywhere "missing" "$folder/missing"
everywhere "in a missing folder" "$folder/nowhere/missing"
everywhere "a folder" "$folder/directory"
everywhere "a pipe" "$folder/pipe"
everywhere "an empty file" "$folder/empty"
everywhere "random bytes" "$folder/random"
everywhere "/dev/zero" /dev/zero
everywhere "/dev/null" /dev/null
everywhere "a link to nothing" "$(ln -s nothing "$folder/dangling" && echo "$folder/dangling")"
everywhere "a link to itself" "$(ln -s loop "$folder/loop" && echo "$folder/loop")"
if [ "$(id -u)" -eq 0 ]; then
    skip "a file that must not be read" "root can read everything"
else
    cp $box "$folder/secret"
    chmod a-r "$folder/secret"
    everywhere "a file that must not be read" "$folder/secret"
fi
refuses "scene: the empty name" 2 ":" scene ""
refuses "half a scene" 2 "half.gltf" scene "$folder/half.gltf"
refuses "half an image" 2 "cut.exr" diff "$folder/cut.exr" "$folder/good.exr"
refuses "half an environment" 2 "cut.exr" render $box -o "$out/a.exr" --env "$folder/cut.exr"
refuses "half a table" 2 "cut.npy" render $box -o "$out/a.npy" --points "$folder/cut.npy"
refuses "an image as a scene" 2 "good.exr" scene "$folder/good.exr"
refuses "a scene as an image" 2 "cornell-box.gltf" diff $box "$folder/good.exr"
refuses "a scene as points" 2 "cornell-box.gltf" render $box -o "$out/a.npy" --points $box

# ---- points ----
points() { # NAME WORD SHAPE VALUE...
    name=$1 word=$2
    shift 2
    write_npy "$folder/p.npy" "$@"
    refuses "points: $name" 2 "$word" render $box --spp 1 -o "$out/a.npy" --points "$folder/p.npy"
}
points "five columns" "6 columns" "1, 5" 0 0 0 0 1
points "seven columns" "6 columns" "1, 7" 0 0 0 0 1 0 0
points "one dimension" "6 columns" "6," 0 0 0 0 1 0
points "three dimensions" "p.npy" "1, 1, 6" 0 0 0 0 1 0
points "a shape that lies" "p.npy" "2, 6" 0 0 0 0 1 0
points "a shape that is too large" "p.npy" "99999999999, 6" 0 0 0 0 1 0
points "a position that is NaN" "row 1" "2, 6" 0 0 0 0 1 0 n 0 0 0 1 0
points "a position that is infinite" "row 0" "1, 6" 0 i 0 0 1 0
points "a normal that is NaN" "row 0" "1, 6" 0 0 0 0 n 0
points "a normal that is infinite" "row 0" "1, 6" 0 0 0 0 0 i
points "a normal that is zero" "row 1" "2, 6" 0 0 0 0 1 0 0 0 0 0 0 0
write_npy "$folder/p.npy" "0, 6"
accepts "points: none at all" render $box --spp 1000000000 -o "$folder/none.npy" --points "$folder/p.npy"
grep -qa "(0, 54)" "$folder/none.npy"
result $? "points: none at all gives no row of 54 columns"

# ---- numbers too large to compute with ----
printf '{"asset":{"version":"2.0"}}' > "$folder/nothing.gltf"
refuses "light that an image cannot hold" 2 "too bright" render $box $small --env-scale 1e30 \
    --env "$folder/good.exr" -o "$out/a.exr"
refuses "light that overflows" 2 "too bright" render "$folder/nothing.gltf" $small -q \
    --background 1e308,0,0 -o "$out/a.exr"
accepts "light that is very bright" render "$folder/nothing.gltf" $small -q --background 1e18,0,0 \
    -o "$folder/a.exr"
accepts "a scene without anything" render "$folder/nothing.gltf" $small -q -o "$folder/a.exr"
finish
