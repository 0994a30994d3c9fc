#!/bin/sh
# The same command gives the same pixels for any number of threads, any vector width, gcc and clang,
# -O0 and -O3, and when run again.  Prints TAP.
set -u
assay=${ASSAY_BIN:-build/release/assay}
folder=$(mktemp -d) || exit 1
trap 'rm -rf "$folder"' EXIT
number=0
scenes="cornell-box cornell-box-glossy spheres textured cached rasterised glossy-cached splatted"

result() { # STATUS NAME
    number=$((number + 1))
    if [ "$1" -eq 0 ]; then echo "ok $number - $2"; else echo "not ok $number - $2"; fi
}

skip() { # NAME REASON
    number=$((number + 1))
    echo "ok $number - $1 # SKIP $2"
}

# A square over a floor, half way through a quarter turn, under a map of the sky.  Its textures
# (colour, roughness, normals: tiled, turned, bilinear) and the sky are pictures of the Cornell box.
"$assay" render scenes/cornell-box/cornell-box.gltf --size 32x16 --spp 2 --layers color --exposure 2 \
    -q -o "$folder/sky.exr" --png "$folder/picture.png" || echo "not ok - cannot render the sky"
# The buffer: 4 positions, 4 texture coordinates, 6 indices, 2 key times, 2 quaternions.
cat > "$folder/textured.gltf" << 'EOF'
{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1, 2]}],
 "extensionsUsed": ["KHR_texture_transform"],
 "nodes": [{"mesh": 0, "translation": [0, 0, 0.5]},
  {"mesh": 0, "translation": [0, -1, 0], "rotation": [-0.7071067811865476, 0, 0, 0.7071067811865476],
   "scale": [2, 2, 2]}, {"camera": 0, "translation": [0, 0.5, 4]}],
 "cameras": [{"type": "perspective", "perspective": {"yfov": 0.9, "znear": 0.1}}],
 "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "indices": 2, "material": 0}]}],
 "materials": [{"doubleSided": true, "pbrMetallicRoughness": {"baseColorTexture": {"index": 0,
   "extensions": {"KHR_texture_transform": {"scale": [2.5, 1.5], "rotation": 0.4, "offset": [0.1, 0.2]}}},
   "metallicRoughnessTexture": {"index": 0}}, "normalTexture": {"index": 0, "scale": 0.5}}],
 "textures": [{"source": 0, "sampler": 0}], "images": [{"uri": "picture.png"}],
 "samplers": [{"magFilter": 9729, "wrapS": 10497, "wrapT": 33648}],
 "animations": [{"samplers": [{"input": 3, "output": 4, "interpolation": "LINEAR"}],
  "channels": [{"sampler": 0, "target": {"node": 0, "path": "rotation"}}]}],
 "accessors": [
  {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [-1, -1, 0], "max": [1, 1, 0]},
  {"bufferView": 0, "byteOffset": 48, "componentType": 5126, "count": 4, "type": "VEC2"},
  {"bufferView": 0, "byteOffset": 80, "componentType": 5123, "count": 6, "type": "SCALAR"},
  {"bufferView": 0, "byteOffset": 92, "componentType": 5126, "count": 2, "type": "SCALAR", "min": [0], "max": [1]},
  {"bufferView": 0, "byteOffset": 100, "componentType": 5126, "count": 2, "type": "VEC4"}],
 "bufferViews": [{"buffer": 0, "byteLength": 132}],
 "buffers": [{"byteLength": 132, "uri": "data:application/octet-stream;base64,AACAvwAAgL8AAAAAAACAPwAAgL8AAAAAAACAPwAAgD8AAAAAAACAvwAAgD8AAAAAAAAAAAAAgD8AAIA/AACAPwAAgD8AAAAAAAAAAAAAAAAAAAEAAgAAAAIAAwAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA8wQ1PwAAAADzBDU/"}]}
EOF

render() { # PROGRAM SCENE OUT OPTIONS...
    program=$1 scene=$2 out=$3
    shift 3
    case $scene in
    textured) set -- "$folder/textured.gltf" --env "$folder/sky.exr" --env-scale 1.5 \
        --env-rotation-deg 40 --time 0.5 "$@" ;;
    cached) set -- scenes/cornell-box-glossy/cornell-box-glossy.gltf --method irradiance-cache \
        --theta-strata 6 --phi-strata 19 --a 0.4 --secondary cache "$@" ;;
    rasterised) set -- scenes/colonnade/colonnade.gltf --method irradiance-cache --gather raster \
        --raster-size 16 --secondary direct --shadow map --shadow-size 64 --a 0.9 "$@" ;;
    glossy-cached) set -- scenes/spheres/spheres.gltf --method radiance-cache --a 0.3 --order 5 \
        --grid 6 --nodes 12 --theta-strata 4 --phi-strata 10 --glossy-accuracy 0.8 "$@" ;;
    splatted) set -- scenes/cornell-box-glossy/cornell-box-glossy.gltf --method splat --a 0.4 \
        --order 8 --grid 6 --nodes 12 --theta-strata 4 --phi-strata 10 --glossy-accuracy 0.8 \
        --bounds published "$@" ;;
    *) set -- "scenes/$scene/$scene.gltf" "$@" ;;
    esac
    "$program" render --size 24x24 --spp 3 --seed 5 -q -o "$out" "$@"
}

# Whether the processor can do what a vector width needs; where it cannot, the program drops the wish
# and nothing would be tested.
has_isa() { # ISA
    case $1 in
    sse2) flags="sse2" ;;
    avx2) flags="avx2 fma" ;;
    avx512) flags="avx512f avx512dq avx512cd avx512bw avx512vl" ;;
    esac
    for flag in $flags; do
        grep -qw "$flag" /proc/cpuinfo 2> /dev/null || return 1
    done
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
    if has_isa $isa; then
        ASSAY_ISA=$isa compare "vector width $isa" "$assay" --threads 2
    else
        for scene in $scenes; do skip "$scene: vector width $isa" "this processor lacks it"; done
    fi
done

# Another command must give another image, or the comparison proves nothing.
differs() { # NAME SCENE OPTIONS...
    name=$1 other=$2
    shift 2
    render "$assay" "$other" "$folder/b.exr" "$@"
    "$assay" diff "$folder/$other.exr" "$folder/b.exr" > /dev/null
    [ $? -eq 1 ]
    result $? "mutant: $name is seen as different"
}
differs "another seed" cornell-box --seed 6
differs "another time" textured --time 0.25
differs "another turn of the sky" textured --env-rotation-deg 41

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
