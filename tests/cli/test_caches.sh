#!/bin/sh
# shellcheck disable=SC2046,SC2086
# Saved caches and the parameters of caching methods: what fits gives an image, what does not is
# refused in one line, and nothing is left behind.  TAP.
. tests/support/tap.sh

few="--method irradiance-cache --spp 1 --theta-strata 3 --phi-strata 9 --a 0.6 --size 12x12"
cache=$folder/cache

# ---- a cache goes out and comes in ----
run render $box $few -o "$folder/made.exr" --cache-out "$cache"
went_well && [ -f "$cache/manifest.json" ] && [ -f "$cache/records/irradiance.npy" ]
result $? "a cache is saved"
run render $box $few -o "$folder/loaded.exr" --cache-in "$cache"
went_well && "$assay" diff "$folder/made.exr" "$folder/loaded.exr" > /dev/null
result $? "and gives the same image again"
run render $box $few -o "$folder/other.exr" --cache-in "$cache" --a 0.5 --gradients none
went_well && ! "$assay" diff "$folder/made.exr" "$folder/other.exr" > /dev/null
result $? "and another with other rules"
run render $box $few -o "$folder/view.exr" --size 12x16 --cache-in "$cache" --stats "$folder/s.json"
went_well && grep -q '"records"' "$folder/s.json"
result $? "and serves another view"
for kind in records weights; do
    run render $box $few -o "$folder/$kind.exr" --debug $kind
    went_well && ! "$assay" diff "$folder/made.exr" "$folder/$kind.exr" > /dev/null
    result $? "debug=$kind is another picture"
done
run render $box $few -o "$folder/error.exr" --debug error --reference "$folder/made.exr"
went_well
result $? "debug=error against itself"
run render $box $few -o "$folder/b.exr" --dump "$folder/stages"
went_well && [ -f "$folder/stages/records/position.npy" ] && [ -f "$folder/stages/gbuffer/depth.exr" ]
result $? "records are among the dumped stages"

# ---- what does not fit ----
refuses "a cache over another" 3 "cache" render $box $few -o "$out/a.exr" --cache-out "$cache"
refuses "a cache for other bounces" 2 "bounces" render $box $few -o "$out/a.exr" --bounces 3 \
    --cache-in "$cache"
refuses "a cache for another secondary" 2 "secondary" render $box $few -o "$out/a.exr" \
    --secondary cache --cache-in "$cache"
refuses "a cache by rays for the raster" 2 "gather" render $box $few -o "$out/a.exr" \
    --gather raster --cache-in "$cache"
refuses "a cache of another scene" 2 "scene.digest" render scenes/furnace/furnace.gltf $few \
    -o "$out/a.exr" --cache-in "$cache"
refuses "a cache of other options" 2 "scene.digest" render $box $few -o "$out/a.exr" \
    --force-diffuse --cache-in "$cache"
refuses "a missing cache" 2 "nowhere" render $box $few -o "$out/a.exr" --cache-in "$folder/nowhere"
refuses "a place for it that is not there" 3 "nowhere" render $box $few -o "$out/a.exr" \
    --cache-out "$folder/nowhere/cache"
refuses "debug=error without a reference" 2 "reference" render $box $few -o "$out/a.exr" \
    --debug error
refuses "a reference of another size" 2 "view.exr" render $box $few -o "$out/a.exr" --debug error \
    --reference "$folder/view.exr"
refuses "a reference that is no image" 2 "manifest" render $box $few -o "$out/a.exr" --debug error \
    --reference "$cache/manifest.json"
refuses "r_min above r_max" 2 "r_min" render $box $few -o "$out/a.exr" --r-min 2 --r-max 1
refuses "r_min_pixels above r_max_pixels" 2 "r_min_pixels" render $box $few -o "$out/a.exr" \
    --r-min-pixels 2 --r-max-pixels 1
run render $box $few -o "$folder/raster.exr" --gather raster --raster-size 12 --missing ratio \
    --shadow map --shadow-size 64 --shadow-taps 4 --secondary direct --cache-out "$folder/raster"
went_well && ! "$assay" diff "$folder/made.exr" "$folder/raster.exr" > /dev/null
result $? "a rasterised cache is another one"
refuses "a cache of another raster" 2 "gather" render $box $few -o "$out/a.exr" --gather raster \
    --missing border --shadow map --secondary direct --cache-in "$folder/raster"
refuses "maps of shadow for paths" 2 "secondary" render $box $few -o "$out/a.exr" --shadow map
refuses "taps that are no square" 2 "taps" render $box $few -o "$out/a.exr" --shadow map \
    --secondary direct --shadow-taps 15
for bad in "--raster-size 1" "--raster-fov 3.2" "--raster-fov 0" "--missing all" "--gather both" \
    "--shadow-size 8" "--a 0" "--a -1" "--a nan" "--theta-strata 1" "--phi-strata 1" "--theta-strata 5000" \
    "--levels 0" "--levels 9" "--max-records 0" "--passes 3" "--secondary all"; do
    set -- $bad
    refuses "$bad" 2 "$(echo "${1#--}" | tr - _)" render $box $few -o "$out/a.exr" $bad
done

# ---- spoiled caches ----
spoiled() { # NAME WORD COMMAND: runs in a copy of the cache
    rm -rf "$folder/spoiled"
    cp -r "$cache" "$folder/spoiled"
    (cd "$folder/spoiled" && eval "$3")
    refuses "$1" 2 "$2" render $box $few -o "$out/a.exr" --cache-in "$folder/spoiled"
}
spoiled "no manifest" "manifest.json" "rm manifest.json"
spoiled "a manifest that is no JSON" "manifest.json" "echo '{' > manifest.json"
spoiled "a manifest of something else" "bundle" "echo '{}' > manifest.json"
spoiled "another version" "version" "sed -i 's/\"version\":.*1,/\"version\": 2,/' manifest.json"
spoiled "another content" "content" "sed -i 's/irradiance records/other/' manifest.json"
spoiled "a missing array" "radius" "rm records/radius.npy"
spoiled "an array that is not listed" "records/normal" "sed -i 's|records/normal\"|x\"|' manifest.json"
spoiled "an array of another cache" "records/irradiance" \
    "cp records/position.npy records/irradiance.npy"
spoiled "a cut array" "records/position" "head -c 300 records/position.npy > x; mv x records/position.npy"
# With its digest put right: zero is no radius.
spoiled "a record that cannot be" "record 0" 'old=$(sha256sum < records/radius.npy | cut -c1-64)
    size=$(wc -c < records/radius.npy)
    { head -c 128 records/radius.npy; head -c $((size - 128)) /dev/zero; } > x
    mv x records/radius.npy
    new=$(sha256sum < records/radius.npy | cut -c1-64)
    awk -v old="$old" -v new="$new" "/records\\/radius/ { hit = 1 } hit && index(\$0, old) { sub(old, new); hit = 0 } { print }" manifest.json > x
    mv x manifest.json'
finish
