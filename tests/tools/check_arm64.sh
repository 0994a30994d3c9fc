#!/bin/sh
# check_arm64.sh - builds for aarch64 with Debian's cross compiler and arm64 packages unpacked under
# build/arm64, runs under qemu-user, and compares the pixels with those of this machine, and some whole
# bundles with the golden hashes.  The system's own architecture list and packages stay as they are,
# but for the cross compiler and qemu-user.
set -eu
base=$PWD/build/arm64
root=$base/root
packages="libembree-dev libopenexr-dev libtinygltf-dev libsleef-dev librandom123-dev libpng-dev zlib1g-dev
          libdeflate-dev libjpeg-dev libcjson-dev libmd-dev libc6-dev libstdc++-12-dev"

missing=
for p in gcc-aarch64-linux-gnu g++-aarch64-linux-gnu qemu-user; do
    dpkg-query -W -f '${Status}' $p 2> /dev/null | grep -q ' installed' || missing="$missing $p"
done
if [ -n "$missing" ]; then
    sudo=
    [ "$(id -u)" = 0 ] || sudo=sudo
    $sudo apt-get update -q
    # shellcheck disable=SC2086
    $sudo env DEBIAN_FRONTEND=noninteractive apt-get install -qy --no-install-recommends $missing
fi

if [ "$(cat "$base/unpacked" 2> /dev/null)" != "$packages" ]; then
    echo "arm64: fetching packages into build/arm64"
    mkdir -p "$base/state/lists/partial" "$base/cache/archives/partial" "$root"
    : > "$base/state/status"
    apt="apt-get -q -o APT::Architecture=arm64 -o APT::Architectures=arm64 -o Dir::State=$base/state
         -o Dir::State::status=$base/state/status -o Dir::Cache=$base/cache -o Debug::NoLocking=1
         -o APT::Sandbox::User=root"
    # shellcheck disable=SC2086
    $apt update > /dev/null
    # shellcheck disable=SC2086
    $apt install -y -d --no-install-recommends $packages > "$base/apt.txt"
    for deb in "$base"/cache/archives/*.deb; do
        dpkg-deb -x "$deb" "$root"
    done
    # What links to an absolute path would lead out of the unpacked root.
    find "$root" -type l -lname '/*' | while read -r link; do
        ln -sfn "$root$(readlink "$link")" "$link"
    done
    # libc is the cross compiler's own: what would be linked from here is taken away.
    for name in c m pthread dl rt util; do
        rm -f "$root/usr/lib/aarch64-linux-gnu/lib$name.so" "$root/usr/lib/aarch64-linux-gnu/lib$name.a"
    done
    printf '%s\n' "$packages" > "$base/unpacked"
fi

lib=$root/usr/lib/aarch64-linux-gnu
echo "arm64: building"
make -s -j"$(nproc)" BUILD=build/arm64/build CC=aarch64-linux-gnu-gcc CXX=aarch64-linux-gnu-g++ \
    AR=aarch64-linux-gnu-ar CPPFLAGS="-idirafter $root/usr/include -idirafter $root/usr/include/aarch64-linux-gnu" \
    LDFLAGS="-L$lib -Wl,-rpath-link,$lib:$root/lib/aarch64-linux-gnu:$lib/blas:$lib/lapack -pthread" all
[ -x build/release/assay ] || make -s -j"$(nproc)" all

echo "arm64: comparing"
cat > "$base/assay" <<EOF
#!/bin/sh
exec qemu-aarch64 -L $root -E LD_LIBRARY_PATH=$lib $PWD/build/arm64/build/assay "\$@"
EOF
chmod +x "$base/assay"
failed=0
compare() { # NAME SCENE OPTIONS...
    name=$1 scene=$2
    shift 2
    for program in build/release/assay "$base/assay"; do
        out=$base/$name-$(basename "$(dirname "$program")").exr
        rm -f "$out"
        "$program" render "scenes/$scene/$scene.gltf" --size 24x24 --spp 3 --seed 5 -q --threads 2 \
            -o "$out" "$@" || failed=1
    done
    if build/release/assay diff "$base/$name-release.exr" "$base/$name-arm64.exr" > "$base/diff.txt"
    then
        echo "ok - $name: the same pixels on aarch64"
    else
        cat "$base/diff.txt"
        echo "not ok - $name: other pixels on aarch64"
        failed=1
    fi
}
for scene in ${ARM64_SCENES:-cornell-box cornell-box-glossy spheres}; do
    compare "$scene" "$scene"
done
if [ -z "${ARM64_SCENES:-}" ]; then
    few="--theta-strata 4 --phi-strata 10 --grid 6 --nodes 12"
    # shellcheck disable=SC2086
    compare glossy-cached spheres --method radiance-cache --a 0.3 --order 5 $few \
        --glossy-accuracy 0.8
    # shellcheck disable=SC2086
    compare splatted cornell-box-glossy --method splat --a 0.4 --order 8 $few \
        --glossy-accuracy 0.8 --bounds published
    compare rasterised colonnade --method irradiance-cache --gather raster --raster-size 16 \
        --secondary direct --shadow map --shadow-size 64 --a 0.9
    make -s build/release/tests/golden/golden_arrays
    ASSAY_BIN=$base/assay BUILD=build/release tests/tools/golden.sh check sky path-animated \
        irradiance-cache-levels radiance-cache-digon splat-published-glossy || failed=1
fi
exit $failed
