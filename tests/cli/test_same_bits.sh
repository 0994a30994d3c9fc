#!/bin/sh
# The same command gives the same pixels for any number of threads, any vector width, gcc and clang,
# -O0 and -O3, and when run again.  Prints TAP.
set -u
assay=${ASSAY_BIN:-build/release/assay}
folder=$(mktemp -d) || exit 1
trap 'rm -rf "$folder"' EXIT
number=0
scenes="cornell-box cornell-box-glossy spheres"

result() { # STATUS NAME
    number=$((number + 1))
    if [ "$1" -eq 0 ]; then echo "ok $number - $2"; else echo "not ok $number - $2"; fi
}

render() { # PROGRAM SCENE OUT OPTIONS...
    program=$1 scene=$2 out=$3
    shift 3
    "$program" render "scenes/$scene/$scene.gltf" --size 24x24 --spp 3 --seed 5 -q -o "$out" "$@"
}

compare() { # NAME PROGRAM OPTIONS...
    name=$1 program=$2
    shift 2
    for scene in $scenes; do
        rm -f "$folder/b.exr"
        render "$program" "$scene" "$folder/b.exr" "$@" &&
            "$assay" diff "$folder/$scene.exr" "$folder/b.exr" > "$folder/diff.txt"
        code=$?
        [ $code -eq 0 ] || grep -v ' 0  *[-0-9.]' "$folder/diff.txt"
        result $code "$scene: $name"
    done
}

for scene in $scenes; do
    render "$assay" "$scene" "$folder/$scene.exr" --threads 1 || echo "not ok - cannot render $scene"
done

compare "run again" "$assay" --threads 1
compare "2 threads" "$assay" --threads 2
compare "3 threads" "$assay" --threads 3
for isa in sse2 avx2 avx512; do
    ASSAY_ISA=$isa compare "vector width $isa" "$assay" --threads 2
done

# A different seed must differ, or the comparison proves nothing.
render "$assay" cornell-box "$folder/b.exr" --seed 6
"$assay" diff "$folder/cornell-box.exr" "$folder/b.exr" > /dev/null
[ $? -eq 1 ]
result $? "mutant: another seed is seen as different"

[ -n "${ASSAY_SAME_BITS_QUICK:-}" ] && { echo "1..$number"; exit 0; }
for variant in gcc-O0 clang-O0 clang-O3; do
    cc=${variant%-*}
    cxx=g++
    [ "$cc" = clang ] && cxx=clang++
    make -s -j"$(nproc)" BUILD="build/$variant" CC="$cc" CXX="$cxx" OPT="-${variant#*-}" all \
        > "$folder/make.txt" 2>&1 || cat "$folder/make.txt"
    compare "$variant" "build/$variant/assay" --threads 2
done
echo "1..$number"
