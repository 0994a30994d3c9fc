#!/bin/sh
# shellcheck disable=SC1091,SC2015,SC2016,SC2086,SC2154
# `assay report`: what it refuses, what it writes, and whether the page works, in headless Chromium
# (tests/support/report_selftest.js).  TAP.
. tests/support/tap.sh

work=$folder/work
mkdir "$work" "$work/dir" "$work/empty"
tiny="--size 40x28 -q"

# ---- images and bundles to look at ----
hostile='<img src=x onerror=hacked=1>"&'"'"' ü'
"$assay" render $box $tiny --layers color -m path --spp 16 --seed 5 -o "$work/dir/truth.exr" &&
    "$assay" render $box $tiny --layers color -m path --spp 2 -o "$work/dir/$hostile.exr" \
        --stats "$work/dir/$hostile.json" &&
    "$assay" render $box $tiny --layers color -m path --spp 4 -o "$work/dir/four.exr" \
        --stats "$work/dir/four.json" &&
    "$assay" render $box $tiny -m irradiance-cache --spp 1 --a 0.5 --theta-strata 4 --phi-strata 8 \
        -o "$work/cache.exr" --dump "$work/dir/cache"
result $? "images to report on"
"$assay" render $box --size 8x8 --spp 1 --layers color -q -o "$work/small.exr"
"$assay" render $box --size 40x28 --spp 1 --layers gbuffer -q -o "$work/gbuffer.exr"
truth=$work/dir/truth.exr

# ---- what is refused ----
while IFS='|' read -r word arguments; do
    refuses "report $arguments" 2 "$word" report $arguments
done <<TABLE
no image, bundle or folder|-o $out/r.html
-o F.html|$truth
.html|$truth --reference $truth -o $out/r.png
too many|$(yes "$truth" | head -65 | tr '\n' ' ') -o $out/r.html
one image alone|$truth -o $out/r.html
the folder holds no|$work/empty -o $out/r.html
nowhere.exr|$work/nowhere.exr --reference $truth -o $out/r.html
nowhere.exr|$truth --reference $work/nowhere.exr -o $out/r.html
8 x 8 pixels|$work/small.exr --reference $truth -o $out/r.html
no channels R, G and B|$work/gbuffer.exr --reference $truth -o $out/r.html
not what \`assay verify|$truth --reference $truth --verdict $work/dir/four.json -o $out/r.html
nowhere.json|$truth --reference $truth --verdict $work/nowhere.json -o $out/r.html
method path|$work/dir/cache $work/dir/cache -o $out/r.html
TABLE
refuses "report: an image without a name" 2 "empty" report "" -o "$out/r.html"
refuses "report: a folder that is not there" 3 "$out/no/r.html" \
    report "$truth" --reference "$truth" -o "$out/no/r.html"
head -c 3000 "$truth" > "$work/cut.exr"
refuses "report: an image that is cut short" 2 "cut.exr" \
    report "$work/cut.exr" --reference "$truth" -o "$out/r.html"
cp -r "$work/dir/cache" "$work/changed"
printf x >> "$work/changed/records/position.npy"
refuses "report: a bundle that is not what its manifest lists" 2 "records/position" \
    report "$work/changed" --reference "$truth" -o "$out/r.html"
printf '{"format": "assay-bundle",' > "$work/changed/manifest.json"
refuses "report: a bundle whose manifest is cut short" 2 "is not JSON" \
    report "$work/changed" --reference "$truth" -o "$out/r.html"
cat > "$work/other.json" <<'VERDICT'
{"format":"assay-verdict","version":1,"candidate":"other.exr","verdict":"pass","findings":[]}
VERDICT
refuses "report: a verdict of somebody else" 2 "other.exr" \
    report "$work/cache.exr" "$work/dir/four.exr" --reference "$truth" \
    --verdict "$work/other.json" -o "$out/r.html"
echo before > "$out/kept.html"
"$assay" report "$work/small.exr" --reference "$truth" -o "$out/kept.html" 2> /dev/null
[ "$(cat "$out/kept.html")" = before ] && [ "$(ls -A "$out")" = kept.html ]
result $? "an error leaves the page of that name as it was"
clear_out

# ---- what is written ----
cat > "$work/verdict.json" <<'VERDICT'
{"format":"assay-verdict","version":1,"tool":"x","candidate":"c","reference":"r","verdict":"fail",
 "exit_code":1,"first":1,"summary":"</script><script>hacked=1</script>","settings":{
 "shared_seed":"as it is","not judged":"a/b, <img src=x onerror=hacked=1>","missing":"e/f"},"findings":[
 {"stage":"gbuffer","array":"P","channel":null,"test":"rounding","verdict":"pass","values":9,
  "place":{"row":1,"column":2},"candidate":1,"reference":1,"candidate_hex":null,"reference_hex":null,
  "effect":null,"bound":1,"in_bounds":0.5,"ulps":1,"p":null,"log_p":null,"visible":null,"meaning":null,
  "unjudged":3,"vacuous":0,"width":0.25,"width_90":0.5},
 {"stage":"image","array":"R","channel":null,"test":"tile","verdict":"fail","values":9,
  "place":{"x":3,"y":4,"width":8,"height":8},"candidate":1,"reference":2,
  "candidate_hex":"0x1p+9","reference_hex":null,"effect":1,"bound":1,"in_bounds":9,"ulps":1,"p":0.001,
  "log_p":-7,"visible":1,"meaning":"</td><img src=x onerror=hacked=1>"}]}
VERDICT
accepts "a folder: the path with the most samples is the reference" \
    report "$work/dir" -o "$work/all.html" -q --title '</title><script>hacked=1</script>"&'
accepts "a bundle against an image, with a verdict" report "$work/dir/cache" --reference "$truth" \
    --verdict "$work/verdict.json" -o "$work/pair.html" -q
sed 's/"fail"/"pass"/g; s/"0x1p+9"/null/; s/"first":1/"first":null/
     s/"candidate":"c","reference":"r"/"candidate":"elsewhere\/cache","reference":"truth.exr"/' "$work/verdict.json" > "$work/pass.json"
accepts "a verdict that passes" report "$work/dir/cache" --reference "$truth" --verdict "$work/pass.json" \
    -o "$work/pass.html" -q
sed -i '/class="reference"/s/"samples":16,/"samples":1,/' "$work/pass.html"
"$assay" render $box $tiny --layers color -m path --spp 1 --seed 6 -o "$work/once.exr"
accepts "images of one sample" report "$work/cache.exr" --reference "$work/once.exr" -o "$work/once.html" -q
mkdir "$work/one"
cp "$work/cache.exr" "$work/dir/four.exr" "$work/one"
cp -r "$work/dir/cache" "$work/one/cache"
"$assay" verify "$work/one/cache.exr" --reference "$truth" --allow 0.5 -q --json "$work/one/cache.verdict.json"
accepts "an image and a bundle of one name" report "$work/one" "$work/dir/four.exr" --reference "$truth" \
    -o "$work/named.html" -q
[ "$(grep 'class="candidate"' "$work/named.html" | sed 's/.*{"name":"\([^"]*\)","file":"\([^"]*\)".*/\1|\2/')" = \
    'cache (bundle)|cache
cache.exr|cache
four.exr|four
four.exr, 2|four' ]
result $? "candidates of one name are told apart"
grep -q '"verdict":{"format' "$work/named.html" && ! grep -q '"otherPixels":' "$work/named.html"
result $? "the verdict of an image is of its bundle's pixels, too"
"$assay" render $box $tiny -m irradiance-cache --spp 1 --a 0.5 --theta-strata 4 --phi-strata 8 --seed 7 \
    -o "$work/one/cache.exr"
"$assay" report "$work/one" --reference "$truth" -o "$work/named.html" -q
[ "$(grep 'class="candidate"' "$work/named.html" | grep -c '"name":"cache.exr".*"otherPixels":')" -eq 1 ] &&
    [ "$(grep -c '"otherPixels":' "$work/named.html")" -eq 1 ]
result $? "and no more those of an image that was rendered again"
accepts "an image against itself" report "$truth" --reference "$truth" -o "$work/same.html" -q
"$assay" report "$work/dir/cache" --reference "$truth" --verdict "$work/verdict.json" -o "$work/again.html" -q
cmp -s "$work/pair.html" "$work/again.html"
result $? "the same page twice"
cp -r "$work/dir/cache" "$work/cache"
sed -i '/"sha256"/d; s/\("shape":.*\]\),$/\1/' "$work/cache/manifest.json"
"$assay" report "$work/cache" --reference "$truth" --verdict "$work/verdict.json" -o "$work/bare.html" -q
cmp -s "$work/pair.html" "$work/bare.html"
result $? "a bundle without digests makes the same page"
[ "$(grep -c 'class="candidate"' "$work/all.html")" -eq 3 ] &&
    grep 'class="reference"' "$work/all.html" | grep -q '"name":"truth"'
result $? "three candidates, and the truth is the reference"
[ "$(wc -c < "$work/pair.html")" -lt 200000 ]
result $? "a small pair makes a small page"
! grep -qi 'https\?://[^w]' "$work/pair.html" && ! grep -qi '<link\|@import\|src=.http' "$work/pair.html"
result $? "the page names nothing outside of it"
! grep -qF "$work" "$work/pair.html"
result $? "and no path of this machine"

# ---- in a browser ----
inject() { # FROM TO SED...: the self-test behind the page's own scripts
    from=$1 to=$2
    shift 2
    sed "$@" "$from" | awk -v test=tests/support/report_selftest.js '
        /^<\/body>$/ { print "<script>"; while ((getline line < test) > 0) print line; print "</script>" }
        { print }' > "$to"
}

# All pages of the folder $folder/pages in frames of one browser; $folder/console is what they say.
browse() { # EXPECTED: pages
    { echo '<!DOCTYPE html><meta charset="utf-8">'
      echo '<style>iframe { position: absolute; left: 0; top: 0 }</style><body>'
      for page in "$folder"/pages/*.html; do
          case $page in *phone.html) width=375 ;; *) width=1200 ;; esac
          echo "<iframe src=\"pages/${page##*/}\" width=\"$width\" height=\"900\"></iframe>"
      done; } > "$folder/frames.html"
    : > "$folder/console"
    timeout -k 5 150 chromium --headless --no-sandbox --disable-gpu --no-first-run --enable-logging=stderr \
        --disable-extensions --disable-background-timer-throttling --disable-renderer-backgrounding \
        --disable-backgrounding-occluded-windows --window-size=1280,960 --remote-debugging-port=0 \
        --user-data-dir="$folder/profile" "file://$folder/frames.html" > "$folder/console" 2>&1 &
    browser=$!
    while kill -0 $browser 2> /dev/null &&
        [ "$(grep -c 'CONSOLE.*"SELFTEST' "$folder/console")" -lt "$1" ]; do
        sleep 0.2
    done
    kill $browser 2> /dev/null
    wait $browser 2> /dev/null
}

mkdir "$folder/pages"
cp "$work/pair.html" "$work/phone.html"
for page in all pair pass same phone once; do
    inject "$work/$page.html" "$folder/pages/$page.html" -e ''
done
browse 6
for page in all pair pass phone once; do
    grep -q "SELFTEST $page.html passes" "$folder/console"
    code=$?
    [ $code -eq 0 ] || grep "SELFTEST $page.html" "$folder/console" | sed 's/^/# /'
    result $code "$page.html works in a browser"
done
equal='every picture looks different; the scale changes the map'
grep -q "SELFTEST same.html fails: $equal\"" "$folder/console" ||
    ! grep 'SELFTEST same.html' "$folder/console" | sed 's/^/# /'
result $? "equal images look equal: the one check that must fail, fails"
! grep 'CONSOLE' "$folder/console" | grep -v 'SELFTEST' | sed 's/^/# /' | grep .
result $? "nothing else is said on the console"

# ---- mutants of the page: each must be seen ----
rm -rf "$folder/pages" "$folder/profile"
mkdir "$folder/pages"
count=0
while IFS='|' read -r page change; do
    count=$((count + 1))
    inject "$work/$page.html" "$folder/pages/$count.$page.html" -e "$change"
    inject "$work/$page.html" "$folder/unchanged.html" -e ''
    ! cmp -s "$folder/unchanged.html" "$folder/pages/$count.$page.html"
    result $? "mutant $count changes the page: $change"
    echo "$change" > "$folder/change.$count"
done <<'TABLE'
pair|s/^  moveDivider(to);$//
pair|s/^    if (drag?.divider) dragDivider(event);/    if (drag?.divider) return;/
pair|s/if (name === "picture") choosePicture(value);//
pair|s/guess + (word >> 1/guess - (word >> 1/
pair|s/^      red\[i\] += green\[i\];$//
pair|s/gain = 2 \*\* exposure/gain = 1/
pair|s/^  root.dataset.theme = next;$//
pair|s/aria-label="Divider[^"]*"//
all|s/\$("title").textContent = /$("title").innerHTML = /
pair|s/\$("help").showModal()/0/
pair|s/^    if (state.records) drawRecords.*//
all|s/chooseCandidate(state.candidate + 1)/0/
pair|s/href: `#finding-\${verdict.first}`/href: "#finding-0"/
pair|s/^  \$("scale-value").textContent/  throw 1; &/
phone|s/^  #stage { width: 100%;/  #stage {/
pair|s/^    settings?.missing && .*//
pair|s/^ *settings?.*not judged.*//
pair|s/^    settings?.shared_seed && .*//
pair|s/return isThis ?/return true ?/
pass|s/return isThis ?/return false ?/
pass|s/: null\].filter(Boolean));/: null]);/
all|s/^  drawConvergence();$//
pair|s/=> f.unjudged > 0 ? .* : count/=> count/
pair|s/Number.isFinite(f.width)/false/
pair|s/^    numeric(format(f.p, 2)),$//
pair|s/, \.\.\.(shown().otherPixels ?? \[\])//
pass|s/reference.samples === 1 ? "sample"/false ? "sample"/
all|s/<body>/<body><img src="https:\/\/example.org\/x.png" alt="">/
TABLE
browse $count
for number_of in $(seq $count); do
    grep 'CONSOLE' "$folder/console" | grep -q "SELFTEST $number_of\.[a-z]*\.html fails"
    seen=$?
    # What asks for something outside is stopped by the page's policy, which says so.
    if [ $seen -ne 0 ] && grep -q example.org "$folder/change.$number_of"; then
        grep CONSOLE "$folder/console" | grep -q 'example.org'
        seen=$?
    fi
    result $seen "the page's mutant is seen: $(cat "$folder/change.$number_of")"
done
finish
