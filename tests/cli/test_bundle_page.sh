#!/bin/sh
# shellcheck disable=SC2086
# The programs of docs/bundle.md, taken out of the page, write what `assay verify` understands: right
# it passes, spoiled it does not.  TAP.
. tests/support/tap.sh

# The fenced block of this language.
take_out() { # LANGUAGE
    awk -v fence="\`\`\`" -v language="$1" '
        $0 == fence && inside { exit }
        inside { print }
        $0 == fence language { inside = 1 }' docs/bundle.md
}

"$assay" render "$box" -q -m splat --gbuffer centres --size 12x12 --spp 1 --a 0.6 --theta-strata 3 \
    --phi-strata 9 --splat-a 0.5 -o "$folder/a.exr" --dump "$folder/dump"
result $? "a dump is written"

judges() { # NAME CODE BUNDLE PRECISION
    run verify "$3" --reference "$folder/dump" --precision "$4"
    [ "$code" -eq "$2" ] || explain "exit code $2 was expected"
    [ "$code" -eq "$2" ]
    result $? "$1"
}

take_out c > "$folder/normalise.c"
${CC:-cc} -std=c11 -D_GNU_SOURCE -Wall -Wextra -Werror -o "$folder/normalise" "$folder/normalise.c" &&
    "$folder/normalise" "$folder/dump" "$folder/by-c"
result $? "C: the page's program builds and runs"
judges "C: what it wrote passes" 0 "$folder/by-c" float
judged="--reference $folder/dump --require normalise"
run verify "$folder/by-c" $judged,weights
[ "$code" -eq 2 ] && grep -q 'weights, test required' "$folder/stdout"
result $? "a stage that is required and not there cannot be told"
refuses "a stage that is none" 2 "unknown stage 'shine'" verify "$folder/by-c" $judged,shine
run verify "$folder/by-c" --reference "$folder/dump" --require normalise
went_well
result $? "one that is there is judged as ever"
sed 's/sum.values\[i\] \/ w : 0/sum.values[i] : 0/' "$folder/normalise.c" > "$folder/wrong.c"
${CC:-cc} -std=c11 -D_GNU_SOURCE -o "$folder/wrong" "$folder/wrong.c" &&
    "$folder/wrong" "$folder/dump" "$folder/wrong-c"
judges "C: without the division it fails" 1 "$folder/wrong-c" float
grep -q normalise "$folder/stdout"
result $? "C: at the stage normalise"

python=
for p in python3 /usr/bin/python3; do
    [ -n "$python" ] || ! "$p" -c 'import numpy' 2> /dev/null || python=$p
done
if [ -n "$python" ]; then
    take_out python > "$folder/normalise.py"
    for precision in float double; do
        "$python" "$folder/normalise.py" "$folder/dump" "$folder/by-$precision" "$precision"
        judges "Python: $precision passes" 0 "$folder/by-$precision" "$precision"
    done
    "$python" -W ignore "$folder/normalise.py" "$folder/dump" "$folder/by-half" half
    refuses "Python: what half floats cannot hold" 2 "not finite" verify "$folder/by-half" \
        --reference "$folder/dump" --precision half
else
    skip "Python" "there is no numpy"
fi

# ---- replay ----
accepts "replay: the sums again" replay splat --in "$folder/dump" -o "$folder/again" --bounds float
cmp "$folder/again/splat/batch.1/radiance.npy" "$folder/dump/splat/batch.1/radiance.npy"
result $? "replay: to the bit"
[ -f "$folder/again/splat/batch.1/radiance_bound.npy" ]
result $? "replay: with bounds"
run replay --help
went_well && for word in irradiance weights interpolate interpolate-radiance splat splat-light \
    splat-glossy splat-glossy-light normalise normalise-glossy combine project rotate convert \
    reflect records/position query/weight radiance_records/coefficients splat_glossy/lobe_grid; do
    grep -q "$word" "$folder/stdout" || exit 1
done
result $? "replay: help lists the stages and their arrays"
refuses "replay: a stage that is not there" 2 "unknown stage" replay nothing --in "$folder/dump" \
    -o "$out/a"
refuses "replay: what a stage needs" 2 "query/position" replay weights --in "$folder/dump" -o "$out/a"
refuses "replay: a parameter that is not there" 2 "weird" replay splat --in "$folder/dump" -o "$out/a" \
    -p weird=1
refuses "replay: no bundle" 2 "manifest.json" replay splat --in "$folder" -o "$out/a"
refuses "replay: an output that is there" 3 "there already" replay splat --in "$folder/dump" \
    -o "$folder/again"
refuses "replay: no output" 2 "-o BUNDLE" replay splat --in "$folder/dump"
refuses "replay: no input" 2 "--in BUNDLE" replay splat -o "$out/a"
refuses "replay: bounds of what" 2 "half, float or double" replay splat --bounds quad

# ---- with a scene ----
accepts "replay: the cells of all records" replay gather --in "$folder/dump" --scene "$box" -o "$folder/cells"
accepts "replay: what follows from them" replay irradiance --in "$folder/cells" -o "$folder/records" \
    --with-inputs
for array in irradiance rotation_gradient translation_gradient harmonic_mean nearest; do
    cmp "$folder/records/records/$array.npy" "$folder/dump/records/$array.npy"
    result $? "replay: records/$array to the bit"
done
run verify "$folder/records" --reference "$folder/records" --precision float --list
went_well && grep -q 'irradiance.*records/nearest.*pass' "$folder/stdout"
result $? "verify: records from their cells"
for precision in float double; do
    run verify "$folder/dump" --reference "$folder/dump" --scene "$box" --precision $precision --list
    went_well && grep -q 'visible.*gbuffer/position.*pass' "$folder/stdout"
    result $? "verify: a dump with its scene, $precision"
done
refuses "verify: another scene" 2 "assay:scene.digest" verify "$folder/dump" \
    --reference "$folder/dump" --scene scenes/furnace/furnace.gltf
refuses "replay: a scene is missing" 2 "needs a scene" replay visible --in "$folder/dump" -o "$out/a"
refuses "verify: a scene and an image" 2 "bundles" verify "$folder/a.exr" --reference "$folder/a.exr" \
    --scene "$box"
refuses "verify: two bundles" 2 "one bundle" verify "$folder/dump" "$folder/dump" \
    --reference "$folder/dump"
sed -i 's/"assay:splat.a":\t"0.6"/"assay:splat.a":\t"0.7"/' "$folder/by-c/manifest.json"
refuses "verify: other parameters" 2 "assay:splat.a" verify "$folder/by-c" --reference "$folder/dump"
finish
