#!/bin/sh
# shellcheck disable=SC2015,SC2016,SC2181
# The quick golden images have the bits that the MANIFEST lists, and golden.sh sees what is wrong: in
# a folder of its own with two tiny entries, one of which reads the image of the other.  TAP.
set -u
script=tests/tools/golden.sh
tool=${BUILD:-build/release}/tests/golden/golden_arrays
folder=$(mktemp -d) || exit 1
trap 'rm -rf "$folder"' EXIT
number=0

result() { # STATUS NAME
    number=$((number + 1))
    if [ "$1" -eq 0 ]; then
        echo "ok $number - $2"
    else
        echo "not ok $number - $2"
        sed 's/^/# /' "$folder/said"
    fi
}

"$script" check quick > "$folder/said" 2>&1
code=$?
while IFS= read -r line; do
    case $line in
    "ok "*) result 0 "${line#* - }" ;;
    "not ok "*) : ;;
    esac
done < "$folder/said"
result $code "the quick golden images"

for method in $("${ASSAY_BIN:-build/release/assay}" methods | sed -n 's/^\([a-z-]*\) - .*/\1/p'); do
    grep -q -e "^command .* --method $method " refdata/golden/MANIFEST
    result $? "$method has golden images"
done

# ---- a folder to break ----
GOLDEN=$folder/golden
export GOLDEN
mkdir "$GOLDEN"
cat > "$GOLDEN/MANIFEST" << 'END'
# What stands here stays.

entry light quick
command assay render scenes/cornell-box/cornell-box.gltf --size 12x8 --spp 2 --seed 3 -o light.exr --dump light

entry lit
command assay render scenes/lobes/lobes.gltf --method hsh-environment --env light.exr --order 3 --sh-order 3 --grid 4 --nodes 8 --size 8x8 --spp 2 -o lit.exr --dump lit
END
renew() { REASON=${1-} "$script" renew > "$folder/said" 2>&1; }
check() { "$script" check "$@" > "$folder/said" 2>&1; }
says() { grep -qF -- "$1" "$folder/said"; }
whole() { rm -rf "$GOLDEN" && cp -r "$folder/whole" "$GOLDEN"; }
change() { # SED: changes the manifest, or fails the test
    sed "$1" "$GOLDEN/MANIFEST" > "$folder/changed"
    cmp -s "$folder/changed" "$GOLDEN/MANIFEST" && echo "not ok - nothing is changed by $1"
    cp "$folder/changed" "$GOLDEN/MANIFEST"
}
sees() { # NAME WORD: the check fails, and says so
    check && : > "$folder/passed"
    [ ! -e "$folder/passed" ] && says "$2"
    result $? "mutant: $1"
    rm -f "$folder/passed"
    whole
}

check
[ $? -eq 1 ] && says "light: was never rendered"
result $? "an entry without results fails"
before=$(cat "$GOLDEN/MANIFEST")
for reason in "" "  " "..." "two
lines"; do
    renew "$reason"
    [ $? -eq 2 ] && { says "say why" || says "must be one line"; }
    result $? "nothing is renewed for the reason '$(echo "$reason" | tr '\n' ' ')'"
done
[ "$before" = "$(cat "$GOLDEN/MANIFEST")" ] && [ "$(ls "$GOLDEN")" = MANIFEST ]
result $? "and nothing was written"
renew "First of all: it's \"new\" & 100% \$HOME"
[ $? -eq 0 ] && grep -qxF "reason First of all: it's \"new\" & 100% \$HOME" "$GOLDEN/MANIFEST"
result $? "two images are made, and the reason is kept as it was given"
check
result $? "and have the same bits when they are rendered again"
head -n 1 "$GOLDEN/MANIFEST" | grep -qx '# What stands here stays.'
result $? "the manifest's first lines stay"
cp -r "$GOLDEN" "$folder/whole"
renew "for nothing"
[ $? -eq 0 ] && diff -r "$GOLDEN" "$folder/whole" > "$folder/said"
result $? "what has not changed is not renewed"

# ---- what must be seen ----
"$tool" nudge "$folder/whole/light.exr" "$GOLDEN/light.exr" 5 6
sees "a pixel of a golden image, by one unit in the last place" "light.exr is not the image"

# The same, by one who also wrote its hash into the manifest.
"$tool" nudge "$folder/whole/light.exr" "$GOLDEN/light.exr" 5 6
change "s/^image $("$tool" digest "$folder/whole/light.exr")/image $("$tool" digest "$GOLDEN/light.exr")/"
sees "the same with its hash" "1 of 96 pixels differ; first x 5, y 6, R: 0x1."

rm "$GOLDEN/lit.exr"
sees "a golden image is missing" "lit.exr is missing"
head -c 300 "$folder/whole/lit.exr" > "$GOLDEN/lit.exr"
sees "a golden image is cut short" "lit.exr is not the image"
cp "$folder/whole/lit.exr" "$GOLDEN/other.exr"
sees "an image that no entry lists" "does not list: $GOLDEN/other.exr"
rm "$GOLDEN/MANIFEST"
sees "no manifest" "MANIFEST is missing"
: > "$GOLDEN/MANIFEST"
sees "an empty manifest" "has no entries"

change 's/--seed 3/--seed 4/'
sees "another seed" "first array that differs: radiance/direct: other values"
change 's/--size 12x8/--size 8x12/'
sees "another size" "gbuffer/position: <f4 12x8x3, golden <f4 8x12x3"
change 's/--order 3/--order 4/'
sees "another parameter" "first array that differs: radiance/direct: other values"
change 's/--spp 2 --seed/--spp 2 --bounces 3 --seed/'
sees "another number of bounces" "first array that differs: radiance/indirect: other values"
change 's/--spp 2 --seed/--spp 3 --seed/'
sees "another number of samples" "# samples: 3, golden 2"
change 's/lobes.gltf/nowhere.gltf/'
sees "a scene that is not there" "lit: cannot be rendered"
change 's/--order 3/--order many/'
sees "a command that the program refuses" "lit: cannot be rendered"
change 's/^command assay render/command rm/'
sees "a command of another program" "its command must be"
change 's/-o light.exr/-o lit.exr/'
sees "a command that writes somewhere else" "its command must be"
change '/^command.*lobes/d'
sees "no command" "lit: its command must be"
change 's/^entry lit$/entry light/'
sees "two entries of a name" "once"
change '/^array gbuffer\/uv/s/ [0-9a-f]*$/ 00/'
sees "another hash" "first array that differs: gbuffer/uv: other values"
change '/^array gbuffer\/uv/d'
sees "an array that is not listed" "first array that differs: gbuffer/uv is new"
change 's,^array gbuffer/uv,array gbuffer/uvw,'
sees "an array that is no more" "first array that differs: gbuffer/uvw is no more"
change '/^image/d'
sees "no hash of the image" "lines are missing"
change '/^reason/d'
sees "no reason" "lines are missing"
change 's/^seed 3/seed 4/'
sees "another seed in its description" "# seed: 3, golden 4"
change 's/ quick$//'
check quick
[ $? -eq 2 ] && says "no entry is quick"
result $? "mutant: nothing is left to check quickly"
whole
check lit
[ $? -eq 0 ] && says "lit: 23 arrays" && ! says "light: "
result $? "an entry alone, with the image that it reads"
check nobody
[ $? -eq 2 ] && says "no entry nobody"
result $? "an entry that there is not"

# ---- renewing ----
change 's/--order 3/--order 2/'
renew "a shorter sum"
[ $? -eq 0 ] && [ "$(grep -c '^reason a shorter sum$' "$GOLDEN/MANIFEST")" -eq 1 ] &&
    [ "$(grep -c '^reason First of all' "$GOLDEN/MANIFEST")" -eq 1 ] &&
    cmp -s "$GOLDEN/light.exr" "$folder/whole/light.exr" &&
    ! cmp -s "$GOLDEN/lit.exr" "$folder/whole/lit.exr" && check
result $? "only what changed is renewed, with the new reason"
whole
change 's/--seed 3/--seed 4/'
renew "another light"
[ $? -eq 0 ] && [ "$(grep -c '^reason another light$' "$GOLDEN/MANIFEST")" -eq 2 ] && check
result $? "and what reads an image that changed, too"
whole
change 's/lobes.gltf/nowhere.gltf/; s/--seed 3/--seed 4/'
cp "$GOLDEN/MANIFEST" "$folder/broken"
renew "something that fails"
[ $? -eq 2 ] && says "lit: cannot be rendered" && cmp -s "$GOLDEN/MANIFEST" "$folder/broken" &&
    cmp -s "$GOLDEN/light.exr" "$folder/whole/light.exr"
result $? "where one cannot be rendered, nothing is renewed"
whole
change '/^entry lit$/,$d'
renew "one less"
[ $? -eq 0 ] && [ ! -e "$GOLDEN/lit.exr" ] && check
result $? "the image of an entry that is gone goes, too"
echo "1..$number"
