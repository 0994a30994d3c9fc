#!/bin/sh
# shellcheck disable=SC2086
# `assay verify`: exit codes, outputs, and what must never pass.  TAP.
. tests/support/tap.sh

draw() { # OUT ARGUMENT...
    target=$folder/$1
    shift
    "$assay" render $box -q --size 32x32 --layers color "$@" -o "$target" || exit 1
}
draw truth.exr --spp 64 --seed 1
draw same.exr --spp 16 --seed 2
draw other.exr --spp 16 --seed 3
draw dark.exr --spp 16 --seed 2 --bounces 1
draw small.exr --spp 4 --size 16x16
draw one.exr --spp 1 --seed 4
"$assay" render $box -q --size 32x32 --layers gbuffer --spp 1 -o "$folder/nolight.exr"
truth="--reference $folder/truth.exr"

ends() { # NAME CODE WORD ARGUMENT...
    name=$1 want=$2 word=$3
    shift 3
    run "$@"
    if [ "$code" -ne "$want" ] || ! grep -qF -- "$word" "$folder/stdout" || [ -s "$folder/stderr" ]; then
        explain "exit code $want and '$word' were expected"
        result 1 "$name"
    else
        result 0 "$name"
    fi
}

ends "the same light passes" 0 "PASS: " verify "$folder/same.exr" $truth
ends "one bounce fails" 1 "First stage that fails: image" \
    verify "$folder/dark.exr" $truth --ignore-metadata
ends "runs pass" 0 "PASS: " verify "$folder/same.exr" "$folder/other.exr" $truth
ends "runs, said in another way" 0 "PASS: " verify --candidate "$folder/same.exr" \
    --candidate "$folder/other.exr" $truth
ends "a bias that would not have been seen" 2 "CANNOT TELL" \
    verify "$folder/same.exr" $truth --detect 1e-6
ends "a reference of one sample a pixel" 2 "variance is not known" \
    verify "$folder/same.exr" --reference "$folder/one.exr"
ends "a small allowance" 1 "FAIL: " \
    verify "$folder/dark.exr" $truth --ignore-metadata --allow 0.01
ends "an allowance that is large" 0 "every region is within the allowance in" \
    verify "$folder/dark.exr" $truth --ignore-metadata --allow-absolute 100
ends "a channel that is missing" 2 "does not have this channel" \
    verify "$folder/same.exr" $truth --channels R,Direct.R
ends "a seed that both have" 0 "The same seed in both: " \
    verify "$folder/truth.exr" $truth
! "$assay" verify "$folder/same.exr" $truth | grep -q "seed"
result $? "other seeds are not spoken of"
ends "the list" 0 "tile-16" verify "$folder/same.exr" $truth --list
ends "annotations" 1 "::error file=" verify "$folder/dark.exr" $truth --ignore-metadata -q \
    --annotations

run verify "$folder/same.exr" $truth -q --json - --threads 1
cp "$folder/stdout" "$folder/one.json"
run verify "$folder/same.exr" $truth -q --json - --threads 3
cmp -s "$folder/stdout" "$folder/one.json" && grep -q '"format":.*"assay-verdict"' "$folder/one.json"
result $? "the same JSON for any number of threads, and nothing else on stdout"
run verify "$folder/dark.exr" $truth --ignore-metadata -q --junit "$out/v.xml" --json "$out/v.json"
[ "$code" -eq 1 ] && [ ! -s "$folder/stdout" ] && grep -q '<failure' "$out/v.xml" &&
    grep -q '"verdict":.*"fail"' "$out/v.json"
result $? "JUnit and JSON files of a failure"
clear_out

refuses "another size" 2 "16 x 16" verify "$folder/small.exr" $truth --ignore-metadata
refuses "other bounces" 2 "bounces" verify "$folder/dark.exr" $truth
refuses "nothing in common" 2 "in common" verify "$folder/nolight.exr" $truth
refuses "a candidate that is not there" 2 "none.exr" verify "$folder/none.exr" $truth
refuses "a reference that is not there" 2 "none.exr" verify "$folder/same.exr" \
    --reference "$folder/none.exr"
head -c 3000 "$folder/same.exr" > "$folder/cut.exr"
refuses "a candidate that is cut short" 2 "cut.exr" verify "$folder/cut.exr" $truth
sed 's/compression/compressiox/' "$folder/same.exr" > "$folder/broken.exr"
refuses "a candidate with a broken header" 2 "broken.exr" verify "$folder/broken.exr" $truth
refuses "no reference" 2 "--reference is missing" verify "$folder/same.exr"
refuses "no candidate" 2 "a candidate is missing" verify $truth
refuses "detect with allow" 2 "--detect goes with" verify "$folder/same.exr" $truth --allow 0.1 \
    --detect 0.1
for bad in "--level 0" "--level 0.5" "--level x" "--correction bonferroni" "--tile 3" "--tile 257" \
    "--allow 0" "--allow-absolute -1" "--detect 0" "--detect-tile nan" "--samples 0" \
    "--reference-samples 0" "--precision quad" "--threads -1"; do
    refuses "$bad" 2 "${bad%% *}" verify "$folder/same.exr" $truth $bad
done
mkdir "$folder/bundle"
for option in "--allow 0.1" "--detect-tile 0.1" "--channels R" "--reference-exact" "--ignore-metadata" \
    "--level 0.01" "--tile 16" "--correction holm" "--samples 4"; do
    refuses "${option%% *} of a bundle" 2 "go with images" verify "$folder/bundle" $option
done
refuses "a stage of images" 2 "--require goes with" verify "$folder/same.exr" $truth --require splat
refuses "a part of images" 2 "--judged goes with" verify "$folder/same.exr" $truth --judged 0.9
refuses "an image against a bundle" 2 "the reference is a bundle" verify "$folder/same.exr" \
    --reference "$folder/bundle"
refuses "a bundle against an image" 2 "the candidate is a bundle, the reference is an image" \
    verify "$folder/bundle" $truth
refuses "a bundle against nothing" 2 "manifest.json" verify "$folder/bundle" --reference "$folder/none"
refuses "a run twice" 2 "runs 1 and 2" verify "$folder/same.exr" "$folder/same.exr" $truth
refuses "a channel twice" 2 "R is named twice" verify "$folder/same.exr" $truth --channels R,R
refuses "an output in a folder that is not there" 3 "nowhere" verify "$folder/same.exr" $truth -q \
    --json "$folder/nowhere/v.json"
refuses "two outputs in one file" 2 "the same file" verify "$folder/same.exr" $truth \
    --json "$out/v" --junit "$out/v"
for option in "--json - --list" "--junit - --list" "--json - --annotations"; do
    refuses "$option" 2 "standard output" verify "$folder/same.exr" $truth $option
done
refuses "two outputs on standard output" 2 "the same file" verify "$folder/same.exr" $truth \
    --json - --junit -
refuses "an output over the reference" 2 "truth.exr" verify "$folder/same.exr" $truth \
    --json "$folder/truth.exr"
finish
