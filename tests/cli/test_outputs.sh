#!/bin/sh
# shellcheck disable=SC2012,SC2046,SC2059,SC2086
# Outputs that cannot be written: no half file is left, what was there stays, and it is said in one
# line with exit code 3 (or 2 where the option itself is wrong).  TAP.
. tests/support/tap.sh
write_npy "$folder/points.npy" "1, 6" 0 h 0 0 1 0
probe="render $box --quiet --spp 1 --points $folder/points.npy"
plain="render $box $small"
full="File too large"

# Every kind of output. $1: what it is, $2: exit code, $3: word, $4: name, $5: that of a map.
each_output() {
    refuses "image: $1" "$2" "$3" $plain -o "$4"
    refuses "preview: $1" "$2" "$3" $plain -o "$folder/whole.exr" --png "$4"
    refuses "statistics: $1" "$2" "$3" $plain -o "$folder/whole.exr" --stats "$4"
    refuses "table: $1" "$2" "$3" $probe -o "$4"
    refuses "heat map: $1" "$2" "$3" diff "$folder/a.exr" "$folder/a.exr" --heat-map "${5:-$4}"
}

accepts "an image to compare with" $plain -o "$folder/a.exr"
each_output "folder is missing" 3 "nowhere" "$folder/nowhere/x"
each_output "is a folder" 3 "is a folder" "$out"
each_output "is to be a folder" 3 "is a folder" "$folder/x/"
each_output "folder is a file" 3 "Not a directory" "$folder/a.exr/x"
each_output "empty name" 2 "name of an output is empty" ""
refuses "bundle: empty name" 2 "name of an output is empty" $plain -o "$folder/whole.exr" --dump ""
each_output "name is too long" 3 "File name too long" \
    "$folder/$(printf '%0300d' 0)" "$folder/$(printf '%0300d' 0).png"
if [ "$(id -u)" -eq 0 ]; then
    skip "a read-only folder" "root can write everywhere"
    skip "a read-only file" "root can write everywhere"
else
    mkdir "$folder/locked"
    : > "$folder/locked/old"
    chmod a-w "$folder/locked" "$folder/locked/old"
    each_output "a read-only folder" 3 "Permission denied" "$folder/locked/x"
    each_output "a read-only file" 3 "Permission denied" "$folder/locked/old"
fi
if [ -c /dev/full ]; then
    each_output "/dev/full" 3 "No space left" /dev/full
    refuses "bundle in place of /dev/full" 3 "there already" $plain -o "$folder/whole.exr" \
        --dump /dev/full
else
    skip "/dev/full" "there is none"
fi
for option in -o --png --stats; do
    accepts "$option /dev/null" $plain -o "$folder/b.exr" $option /dev/null
done
accepts "frames to /dev/null" $plain --frames 0:1 -o /dev/null
[ -c /dev/null ] && [ ! -e /dev/null.0000 ]
result $? "/dev/null stays what it is"

# ---- stdout and stderr ----
closed() { # NAME WORD ARGUMENT...: stdout closed or full
    name=$1 word=$2
    shift 2
    "$assay" "$@" 2> "$folder/stderr" >&-
    code=$?
    : > "$folder/stdout"
    failed_well 3 "$word"
    result $? "$name: stdout is closed"
    [ -c /dev/full ] || return
    "$assay" "$@" 2> "$folder/stderr" > /dev/full
    code=$?
    failed_well 3 "$word"
    result $? "$name: stdout is full"
}
closed "scene" "standard output" scene $box
closed "scene --json" "standard output" scene $box --json
closed "methods" "standard output" methods
closed "methods --json" "standard output" methods --json
closed "diff" "standard output" diff "$folder/a.exr" "$folder/a.exr"
closed "render --help" "standard output" render --help
closed "render --stats -" "standard output" $plain -o "$folder/b.exr" --stats -
"$assay" $plain -o "$folder/b.exr" --png "$folder/b.png" 0<&- >&- 2>&-
result $? "render with all streams closed"
"$assay" diff "$folder/a.exr" "$folder/b.exr" > /dev/null
result $? "render with all streams closed: the same image"
"$assay" render "$folder/none.gltf" -o "$out/b.exr" 0<&- >&- 2>&-
[ $? -eq 2 ] && is_empty "$out"
result $? "a message that nobody can read"

# ---- names that contradict ----
refuses "-o in another format" 2 "will be .exr" $plain -o "$out/a.png"
refuses "-o with --points in another format" 2 ".npy" $probe -o "$out/a.exr"
refuses "--png in another format" 2 ".png" $plain -o "$out/a.exr" --png "$out/b.exr"
refuses "--stats in another format" 2 ".json" $plain -o "$out/a.exr" --stats "$out/b.png"
refuses "two outputs of the same name" 2 "same name" $plain -o "$out/a" --png "$out/a"
cp "$folder/points.npy" "$folder/scene" && cp $box "$folder/scene.gltf"
cp "${box%gltf}bin" "$folder"
ln "$folder/scene.gltf" "$folder/link"
refuses "the scene as output" 2 "is an input" render "$folder/scene.gltf" $small -o "$folder/link"
cmp -s $box "$folder/scene.gltf"
result $? "the scene is as it was"
refuses "the points as output" 2 "is an input" $probe -o "$folder/points.npy"
refuses "an image as heat map" 2 "is an input" diff "$folder/a.exr" "$folder/a.exr" \
    --heat-map "$folder/./a.exr"

# ---- bundles ----
mkdir "$folder/there"
refuses "bundle is there already" 3 "there already" $plain -o "$out/a.exr" --dump "$folder/there"
is_empty "$folder/there"
result $? "what is there stays"
refuses "bundle without a parent" 3 "nowhere" $plain -o "$out/a.exr" --dump "$folder/nowhere/x"
accepts "bundle" $plain -o "$out/a.exr" --dump "$out/bundle"
[ "$(ls -A "$out")" = "a.exr
bundle" ] && [ -f "$out/bundle/manifest.json" ] && ! find "$out" -name '.*' -type f | grep -q .
result $? "the bundle is whole, and nothing is beside it"
clear_out

# ---- a full disk, as a limit on the size of files ----
limited() { # NAME BLOCKS WORD ARGUMENT...
    name=$1 blocks=$2 word=$3
    shift 3
    (
        ulimit -f "$blocks"
        exec timeout -k 5 120 "$assay" "$@"
    ) > "$folder/stdout" 2> "$folder/stderr" < /dev/null
    code=$?
    failed_well 3 "$word"
    result $? "$name"
    clear_out
}
big="render $box --size 64x64 --spp 1"
limited "image is larger than the disk" 8 "$full" $big -o "$out/a.exr"
limited "preview is larger than the disk" 8 "$full" $big --layers color -o /dev/null \
    --png "$out/a.png"
limited "bundle is larger than the disk" 64 "$full" $big -o "$out/a.exr" --dump "$out/bundle"
write_npy "$folder/many.npy" "100, 6" $(yes 0 h 0 0 1 0 | head -n 100)
limited "table is larger than the disk" 8 "$full" render $box --quiet --spp 1 --points "$folder/many.npy" \
    -o "$out/a.npy"
cp "$folder/a.exr" "$folder/old.exr"
limited "an image in place of another" 8 "$full" $big -o "$folder/old.exr"
cmp -s "$folder/a.exr" "$folder/old.exr"
result $? "the old image stays"
for seed in 1 2; do
    "$assay" render $box --size 160x160 --spp 2 --layers color --seed $seed -o "$folder/$seed.exr"
done
limited "heat map is larger than the disk" 8 "$full" diff "$folder/1.exr" "$folder/2.exr" \
    --scale 20 --heat-map "$out/h.png"

# ---- too little memory ----
starved() { # ARGUMENT...
    (
        ulimit -v 1500000
        exec timeout -k 5 120 "$assay" "$@"
    ) > "$folder/stdout" 2> "$folder/stderr" < /dev/null
    code=$?
}
starved $plain -o "$folder/b.exr"
if [ $code -eq 0 ]; then
    starved render $box --size 8000x8000 --spp 1 -o "$out/a.exr" --dump "$out/bundle"
    failed_well 3 "out of memory"
    result $? "an image that does not fit the memory"
else
    skip "an image that does not fit the memory" "the program itself does not fit"
fi

# ---- a full disk that is one ----
mkdir "$folder/disk"
if mount -t tmpfs -o size=64k none "$folder/disk" 2> /dev/null; then
    trap 'umount "$folder/disk"; rm -rf "$folder"' EXIT
    keep=$out
    out=$folder/disk
    clear_out() { :; }
    refuses "full disk: image" 3 "No space left" $big -o "$out/a.exr"
    refuses "full disk: bundle" 3 "No space left" $big -o /dev/null --dump "$out/bundle"
    accepts "what fits the disk" $plain -o "$out/a.exr"
    rm "$out/a.exr"
    out=$keep
else
    skip "a full disk" "mounting is not permitted"
fi
finish
