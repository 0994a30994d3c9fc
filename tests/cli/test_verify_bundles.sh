#!/bin/sh
# shellcheck disable=SC2086
# `assay verify` of bundles: what a pass says of itself, and what a build may insist on.  TAP.
. tests/support/tap.sh

"$assay" render "$box" -q -m splat --gbuffer centres --size 16x16 --spp 1 --a 0.6 --theta-strata 3 \
    --phi-strata 9 -o "$folder/a.exr" --dump "$folder/dump" || exit 1

ends() { # NAME CODE WORD ARGUMENT...
    name=$1 want=$2 word=$3
    shift 3
    run verify "$folder/dump" --reference "$folder/dump" "$@"
    if [ "$code" -ne "$want" ] || ! grep -qF -- "$word" "$folder/stdout" || [ -s "$folder/stderr" ]; then
        explain "exit code $want and '$word' were expected"
        result 1 "$name"
    else
        result 0 "$name"
    fi
}

ends "a pass says how many numbers were judged" 0 "numbers have a bound"
ends "and how wide bounds are" 0 "Bounds are widest in splat/batch."
ends "the list has both" 0 "judged %" --list
run verify "$folder/dump" --reference "$folder/dump" --list
[ "$(awk '/^PASS/ { exit } /^stage / { at = index($0, "verdict") }
    { print match(substr($0, at - 2), /^  [pv]/) }' "$folder/stdout" | sort -u)" = 1 ]
result $? "columns stand below their heads, whatever names are long"
ends "what was not judged is named" 0 "Not judged: "
ends "half precision passes" 0 "PASS: " --precision half
ends "but not where more is asked for" 2 "of itself unseen, more than was asked for" --precision half \
    --detect 1e-4
ends "what float sees is asked for" 0 "PASS: " --detect 0.9
ends "all numbers have a bound" 0 "PASS: " --judged 1
ends "a stage that is required" 0 "PASS: " --require combine-irradiance,combine,splat
ends "one that cannot be judged" 2 "visible, test required" --require combine,visible
ends "a scene makes it judged" 0 "PASS: " --require visible --scene "$box"
ends "in half no number of it has a bound" 0 "Without a bound on any number in this precision and with these parameters: stage visible." \
    --precision half --scene "$box"
ends "which is no pass where a part is asked for" 2 "visible, test judged" --precision half \
    --scene "$box" --judged 0.5
run verify "$folder/dump" --precision half --detect 1e-4 -q --junit "$out/v.xml" --json "$out/v.json"
[ "$code" -eq 2 ] && [ ! -s "$folder/stdout" ] && grep -q 'bounds of .* of a typical value' "$out/v.xml" &&
    grep -q '"width":' "$out/v.json" && grep -q '"detect":' "$out/v.json"
result $? "JUnit and JSON say it, too"
clear_out

# The last double of a table: its first byte, of sign and exponent, becomes that of a number near 1.
spoil() { # BUNDLE ARRAY
    chmod -R u+w "$1"
    printf '\100' | dd of="$1/$2.npy" bs=1 seek=$(($(wc -c < "$1/$2.npy") - 1)) conv=notrunc 2> /dev/null
    sed -i '/"sha256"/d; s/\("shape":.*\]\),$/\1/' "$1/manifest.json"
}
cp -r "$folder/dump" "$folder/wrong"
spoil "$folder/wrong" splat/result
run verify "$folder/wrong" --reference "$folder/dump"
[ "$code" -eq 1 ] && grep -q 'First stage that fails: normalise.*Its inputs pass: the error is made in this stage' \
    "$folder/stdout"
result $? "a stage of right inputs is to blame"
"$assay" verify "$folder/wrong" -q --json "$folder/wrong.json"
for bundle in wrong dump; do
    accepts "a report on $bundle" report "$folder/$bundle" --reference "$folder/a.exr" -q \
        --verdict "$folder/wrong.json" -o "$folder/$bundle.html"
done
! grep -q '"otherPixels":' "$folder/wrong.html" &&
    grep -q "\"otherPixels\":.*'splat/result' in row 255 is 0.*in dump and .* in the verdict" "$folder/dump.html"
result $? "which tells where the verdict is of another bundle"
cp -r "$folder/dump" "$folder/dumped"
spoil "$folder/dumped" splat/albedo
run verify "$folder/dumped" --reference "$folder/dump"
[ "$code" -eq 1 ] && grep -q 'splat/albedo (not the reference.s at row 255, column 2), but made what the reference has' \
    "$folder/stdout"
result $? "one that was right and dumped something else is not"
cp -r "$folder/dump" "$folder/moved"
sed -i 's/\("assay:camera.position":.*"\)-\{0,1\}[0-9.]* /\10.5 /' "$folder/moved/manifest.json"
run verify "$folder/moved" --scene "$box"
[ "$code" -eq 1 ] && ! cmp -s "$folder/moved/manifest.json" "$folder/dump/manifest.json" &&
    grep -q 'fails: visible.*no inputs but scene and camera: the error is made in this stage' "$folder/stdout"
result $? "a stage without inputs is to blame"

cp -r "$folder/dump" "$folder/said"
chmod u+w "$folder/said" "$folder/said/manifest.json"
sed -i 's/"assay:seed":\(.*\)"0"/"assay:seed":\10/' "$folder/said/manifest.json"
refuses "a text that is a number" 2 "'assay:seed' is no text, there it is '0'" \
    verify "$folder/said" --reference "$folder/dump"
sed -i '/"assay:seed"/d' "$folder/said/manifest.json"
refuses "a text that is missing" 2 "'assay:seed' is missing, there it is '0'" \
    verify "$folder/said" --reference "$folder/dump"

for bad in "--judged 0.4" "--judged 1.1" "--judged x" "--detect 0" "--detect nan"; do
    refuses "$bad" 2 "${bad%% *}" verify "$folder/dump" $bad
done
finish
