#!/bin/sh
# shellcheck disable=SC2046,SC2086
# Saved caches and the parameters of caching methods: what fits gives an image, what does not is
# refused in one line, and nothing is left behind.  TAP.
. tests/support/tap.sh

few="--method irradiance-cache --spp 1 --theta-strata 3 --phi-strata 9 --a 0.6 --size 12x12"
glossy="-q --method radiance-cache --order 3 --glossy-accuracy 0 --grid 4 --nodes 8 --spp 1
    --theta-strata 3 --phi-strata 9 --a 0.6 --size 12x12"
shiny=scenes/cornell-box-glossy/cornell-box-glossy.gltf

# ---- a cache goes out and comes in ----
good_caches() { # METHOD SCENE SETTINGS ARRAY: the files are named after the method
    name=$1 scene=$2 settings=$3 array=$4
    cache=$folder/$name
    run render $scene $settings -o "$folder/$name-made.exr" --cache-out "$cache"
    went_well && [ -f "$cache/manifest.json" ] && [ -f "$cache/$array.npy" ]
    result $? "$name: a cache is saved"
    run render $scene $settings -o "$folder/$name-loaded.exr" --cache-in "$cache"
    went_well && "$assay" diff "$folder/$name-made.exr" "$folder/$name-loaded.exr" > /dev/null
    result $? "$name: and gives the same image again"
    run render $scene $settings -o "$folder/other.exr" --cache-in "$cache" --a 0.5 --gradients none
    went_well && ! "$assay" diff "$folder/$name-made.exr" "$folder/other.exr" > /dev/null
    result $? "$name: and another with other rules"
    run render $scene $settings -o "$folder/$name-view.exr" --size 12x16 --cache-in "$cache" \
        --stats "$folder/s.json"
    went_well && grep -q '"records"' "$folder/s.json"
    result $? "$name: and serves another view"
    for kind in records weights; do
        run render $scene $settings -o "$folder/$kind.exr" --debug $kind
        went_well && ! "$assay" diff "$folder/$name-made.exr" "$folder/$kind.exr" > /dev/null
        result $? "$name: debug=$kind is another picture"
    done
    run render $scene $settings -o "$folder/error.exr" --debug error \
        --reference "$folder/$name-made.exr"
    went_well
    result $? "$name: debug=error against itself"
    run render $scene $settings -o "$folder/b.exr" --dump "$folder/$name-stages"
    went_well && [ -f "$folder/$name-stages/gbuffer/depth.exr" ] &&
        cmp "$folder/$name-stages/$array.npy" "$cache/$array.npy"
    result $? "$name: records are among the dumped stages"
}
good_caches irradiance-cache $box "$few" records/irradiance
good_caches radiance-cache $shiny "$glossy" radiance_records/coefficient_gradient
good_caches splat $shiny "$glossy --method splat" radiance_records/coefficient_gradient
# ---- frames ----
run render $box $few -o "$folder/frame-#.exr" --frames 0:1 --cache-out "$folder/frames"
went_well && "$assay" diff "$folder/irradiance-cache-made.exr" "$folder/frame-0.exr" > /dev/null &&
    "$assay" diff "$folder/irradiance-cache-loaded.exr" "$folder/frame-1.exr" > /dev/null &&
    [ -f "$folder/frames/manifest.json" ]
result $? "a frame begins with the records of the one before"
moving="scenes/animated/animated.gltf $few --size 8x8"
run render $moving -o "$folder/moving-#.exr" --frames 0:1 --fps 1
went_well && "$assay" render $moving -o "$folder/alone.exr" --time 1 &&
    "$assay" diff "$folder/moving-1.exr" "$folder/alone.exr" > /dev/null
result $? "and with none where things move"
"$assay" render $moving -o "$folder/a.exr" --cache-out "$folder/moved"
refuses "a cache of another time, where things move" 2 "scene.moment" render $moving \
    -o "$out/a.exr" --time 1 --cache-in "$folder/moved"
accepts "where nothing moves, times are the same" render $box $few -o "$folder/a.exr" --time 1 \
    --cache-in "$folder/irradiance-cache"

cache=$folder/irradiance-cache
lights=$folder/radiance-cache

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
    --reference "$folder/irradiance-cache-view.exr"
"$assay" render $shiny --size 12x12 --spp 1 --layers irradiance -o "$folder/irradiance.exr"
refuses "a reference without the layer Indirect" 2 "Indirect" render $shiny $glossy -o "$out/a.exr" \
    --debug error --reference "$folder/irradiance.exr"
refuses "irradiance records for radiance records" 2 "content" render $box $glossy -o "$out/a.exr" \
    --cache-in "$cache"
refuses "radiance records for irradiance records" 2 "content" render $shiny $few -o "$out/a.exr" \
    --cache-in "$lights"
refuses "a cache of another order" 2 "order" render $shiny $glossy -o "$out/a.exr" --order 4 \
    --cache-in "$lights"
refuses "a cache of other gradients" 2 "coefficient_gradient" render $shiny $glossy -o "$out/a.exr" \
    --coefficient-gradient points --cache-in "$lights"
refuses "a reference that is no image" 2 "manifest" render $box $few -o "$out/a.exr" --debug error \
    --reference "$cache/manifest.json"
refuses "r_min above r_max" 2 "r_min" render $box $few -o "$out/a.exr" --r-min 2 --r-max 1
refuses "r_min_pixels above r_max_pixels" 2 "r_min_pixels" render $box $few -o "$out/a.exr" \
    --r-min-pixels 2 --r-max-pixels 1
run render $box $few -o "$folder/raster.exr" --gather raster --raster-size 12 --missing ratio \
    --shadow map --shadow-size 64 --shadow-taps 4 --secondary direct --cache-out "$folder/raster"
went_well && ! "$assay" diff "$folder/irradiance-cache-made.exr" "$folder/raster.exr" > /dev/null
result $? "a rasterised cache is another one"
refuses "a cache of another raster" 2 "gather" render $box $few -o "$out/a.exr" --gather raster \
    --missing border --shadow map --secondary direct --cache-in "$folder/raster"
refuses "maps of shadow for paths" 2 "secondary" render $box $few -o "$out/a.exr" --shadow map
refuses "taps that are no square" 2 "taps" render $box $few -o "$out/a.exr" --shadow map \
    --secondary direct --shadow-taps 15
bad_values() { # SETTINGS OPTION VALUE...: refused by the parameter's name
    settings=$1 option=$2
    shift 2
    for value; do
        refuses "$option $value" 2 "$(echo "${option#--}" | tr - _)" render $box $settings \
            -o "$out/a.exr" $option "$value"
    done
}
for settings in "$few" "$glossy"; do
    bad_values "$settings" --a 0 -1 nan inf 1e999 1001 x ""
    bad_values "$settings" --theta-strata 1 0 -3 5000 inf nan 4.5
    bad_values "$settings" --phi-strata 1 nan
    bad_values "$settings" --r-min nan inf -1
    bad_values "$settings" --r-max nan inf -0.1
    bad_values "$settings" --r-min-pixels nan inf
    bad_values "$settings" --bounces -1 nan -inf
done
bad_values "$few" --levels 0 9 inf
bad_values "$few" --max-records 0 inf
bad_values "$few" --passes 0 3
bad_values "$few" --secondary all
bad_values "$few" --raster-size 1 nan
bad_values "$few" --raster-fov 3.2 0 nan
bad_values "$few" --missing all
bad_values "$few" --gather both
bad_values "$few" --shadow-size 8
bad_values "$glossy" --order 0 21 -1 inf nan
bad_values "$glossy" --sh-order 0 nan inf
bad_values "$glossy" --rotation-steps 0 nan
bad_values "$glossy" --glossy-accuracy -0.1 1.1 nan inf
bad_values "$glossy" --grid 1 513
bad_values "$glossy" --nodes 7 nan
bad_values "$glossy" --rotation slerp
refuses "an order of irradiance-cache" 2 "order" render $box $few -o "$out/a.exr" --order 4
refuses "a rotation that has no angle" 2 "90 degrees" render $shiny $glossy -o "$out/a.exr" --a 1.2 \
    --rotation digon

# ---- scenes of which a cache can make nothing ----
accepts "nothing gives light" render scenes/lobes/lobes.gltf $glossy -o "$folder/a.exr"
run render scenes/lobes/lobes.gltf $few -o "$folder/a.exr"
[ $code -eq 0 ] && grep -q 'nothing in the scene emits light' "$folder/stderr"
result $? "and that is said"
printf '{"asset":{"version":"2.0"}}' > "$folder/nothing.gltf"
accepts "nothing is there" render "$folder/nothing.gltf" -q $few -o "$folder/a.exr"
accepts "nothing is there, with harmonics" render "$folder/nothing.gltf" $glossy -o "$folder/a.exr"

# ---- spoiled caches ----
edited() { # FILE COMMAND: the command writes x, which becomes the file, with its digest put right
    old=$(sha256sum < "$1" | cut -c1-64)
    eval "$2"
    mv x "$1"
    new=$(sha256sum < "$1" | cut -c1-64)
    awk -v file="\"$1\"" -v old="$old" -v new="$new" \
        'index($0, file) { hit = 1 } hit && index($0, old) { sub(old, new); hit = 0 } { print }' \
        manifest.json > x
    mv x manifest.json
}
zeroed() { # FILE: all of its values 0
    head -c 128 "$1"
    head -c $(($(wc -c < "$1") - 128)) /dev/zero
}
spoiled() { # NAME WORD COMMAND: runs in a copy of the cache
    rm -rf "$folder/spoiled"
    cp -r "$from" "$folder/spoiled"
    (cd "$folder/spoiled" && eval "$3")
    refuses "$1" 2 "$2" render $scene $settings -o "$out/a.exr" --cache-in "$folder/spoiled"
}
from=$cache scene=$box settings=$few
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
spoiled "a record that cannot be" "record 0" \
    'edited records/radius.npy "zeroed records/radius.npy > x"'
from=$lights scene=$shiny settings=$glossy
coefficients=radiance_records/coefficients
spoiled "no coefficients" "$coefficients" "rm $coefficients.npy"
spoiled "coefficients of other records" "$coefficients" \
    "cp radiance_records/coefficient_gradient.npy $coefficients.npy"
spoiled "coefficients that are no numbers" "row 0" \
    "edited $coefficients.npy '(zeroed $coefficients.npy | head -c 128; head -c $((8 * 27 * 1)) /dev/zero | tr \"\\0\" \"\\377\"; tail -c +345 $coefficients.npy) > x'"
finish
