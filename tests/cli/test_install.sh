#!/bin/sh
# What `make install` puts in place is enough to build and run a program with, shared and static.
# Prints TAP.  BUILD comes from the Makefile.
set -u
folder=$(mktemp -d) || exit 1
trap 'rm -rf "$folder"' EXIT
number=0
result() { # STATUS NAME
    number=$((number + 1))
    if [ "$1" -eq 0 ]; then echo "ok $number - $2"; else echo "not ok $number - $2"; fi
}

make -s BUILD="${BUILD:-build/release}" install DESTDIR="$folder" PREFIX=/opt/assay > "$folder/log" 2>&1
result $? "make install DESTDIR= PREFIX="
root=$folder/opt/assay
for file in bin/assay lib/libassay.a lib/libassay.so lib/libassay.so.0 lib/pkgconfig/assay.pc \
            include/assay/assay.h share/man/man1/assay.1; do
    [ -s "$root/$file" ]
    result $? "$file is there"
done
"$root/bin/assay" --version > "$folder/version"
grep -q '^assay [0-9]' "$folder/version"
result $? "the installed command runs"

cat > "$folder/program.c" <<'EOF'
#include <assay/assay.h>
#include <stdio.h>

int main(void)
{
    assay_context *context = NULL;
    assay_scene   *scene   = NULL;
    assay_params  *params  = NULL;
    assay_image   *image   = NULL;
    assay_render_options options = assay_render_options_default();
    options.width = options.height = 4;
    if (assay_context_create(NULL, &context) != ASSAY_OK ||
        assay_scene_load(context, "scenes/furnace/furnace.gltf", NULL, &scene) != ASSAY_OK ||
        assay_method_params(context, "path", &params) != ASSAY_OK ||
        assay_params_set(params, "bounces", "0") != ASSAY_OK ||
        assay_render(scene, "path", params, &options, &image, NULL) != ASSAY_OK) {
        return 1;
    }
    assay_channel red;
    const int ok = assay_image_find_channel(image, "R", &red) && red.data.f32[0] == 1.0F;
    assay_image_destroy(image);
    assay_params_destroy(params);
    assay_scene_destroy(scene);
    assay_context_destroy(context);
    return !ok;
}
EOF
field() { sed -n "s/^$1: //p" "$root/lib/pkgconfig/assay.pc" | sed "s|\${includedir}|$root/include|; s|\${libdir}|$root/lib|"; }
# shellcheck disable=SC2046
cc "$folder/program.c" -o "$folder/shared" $(field Cflags) $(field Libs) &&
    LD_LIBRARY_PATH=$root/lib "$folder/shared"
result $? "a program with the shared library: emission of the furnace is 1"
# shellcheck disable=SC2046
cc "$folder/program.c" -o "$folder/static" $(field Cflags) "$root/lib/libassay.a" $(field Libs.private) &&
    "$folder/static"
result $? "a program with the static library"

make -s BUILD="${BUILD:-build/release}" uninstall DESTDIR="$folder" PREFIX=/opt/assay
[ -z "$(find "$root" -type f -o -type l)" ]
result $? "make uninstall leaves no file"
echo "1..$number"
