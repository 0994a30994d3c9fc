#!/bin/sh
# shellcheck disable=SC2012,SC2046,SC2059,SC2086
# Every option of every command, with good and bad values: exit codes, stdout and stderr.  TAP.
. tests/support/tap.sh

# ---- the checks themselves: what they must refuse ----
mutant() { # NAME CODE STDOUT STDERR FILE
    code=$2
    printf "$3" > "$folder/stdout"
    printf "$4" > "$folder/stderr"
    [ -z "$5" ] || : > "$out/$5"
    ! failed_well 2 "word" > /dev/null
    result $? "mutant: $1"
    clear_out
}
mutant "another exit code" 3 "" "assay x: word\n" ""
mutant "success" 0 "" "assay x: word\n" ""
mutant "something on stdout" 2 "x" "assay x: word\n" ""
mutant "no message" 2 "" "" ""
mutant "two lines" 2 "" "assay x: word\nassay x: word\n" ""
mutant "a message of someone else" 2 "" "word\n" ""
mutant "a message about something else" 2 "" "assay x: other\n" ""
mutant "a file left behind" 2 "" "assay x: word\n" a.exr
mutant "a hidden file left behind" 2 "" "assay x: word\n" .assay-1-0.tmp

# ---- help and the commands ----
run
{ [ "$code" -eq 2 ] && [ ! -s "$folder/stdout" ] && grep -q usage "$folder/stderr"; }
result $? "no command: usage on stderr, exit code 2"
for words in --help -h help --version "render --help" "render -h" "scene --help" "scene -h" \
    "methods --help" "methods -h" "diff --help" "diff -h" "verify --help" "verify -h" "report --help" "report -h"; do
    run $words
    went_well && [ -s "$folder/stdout" ]
    result $? "$words: stdout, exit code 0"
done
for command in render scene methods diff verify replay report; do
    run $command --help
    missing=$(sed -n 's/^.*{"\([a-z-]*\)", \(0\|.[a-z].\), .*/\1/p' src/cli/cmd_$command.c |
        while read -r name; do grep -q -- "--$name" "$folder/stdout" || echo "$name"; done)
    [ -z "$missing" ]
    result $? "$command --help names every option of its table $missing"
done
# The man page has a section a command, and in it every option of the help with its argument, and no
# other.
man_options() { # COMMAND
    sed 's/\\f[A-Z]//g; s/\\//g' "$man" | awk -v command="assay $1" '
        /^\.S[SH]/ { in_section = index($0, "\"" command "\"") > 0 }
        in_section && after && sub(/^(-., )?--/, "--") { print }
        { after = /^\.TP/ }' | sort
}
help_options() { # COMMAND
    "$assay" $1 --help | sed -n '/^Parameters of/q; s/^  \(-., \|    \)\(--[a-z-]*\) \([^ ]*\).*/\2 \3/p' |
        sed 's/ $//' | sort
}
same_options() { # COMMAND
    man_options $1 > "$folder/man"
    help_options $1 > "$folder/help"
    [ -s "$folder/help" ] && diff "$folder/man" "$folder/help" > "$folder/difference"
}
man=docs/assay.1
for command in render scene methods diff verify replay report; do
    same_options $command || sed 's/^/# /' "$folder/difference"
    same_options $command
    result $? "the man page has the options of $command"
done
grep -v 'heat.-map' docs/assay.1 > "$folder/cut.1"
man=$folder/cut.1
! same_options diff
result $? "mutant: an option that the man page lacks is seen"

refuses "unknown command" 2 "frobnicate" frobnicate
refuses "unknown command that looks like an option" 2 "--frobnicate" --frobnicate
for command in scene methods diff; do
    refuses "$command: unknown option" 2 "--frobnicate" $command --frobnicate x
    refuses "$command: unknown letter" 2 "-z" $command -z
    refuses "$command: value for a switch" 2 "takes no value" $command --json=yes x
done

# ---- render: what is refused; WORD | ARGUMENTS ----
while IFS='|' read -r word arguments; do
    case $arguments in *--points*) size= ;; *) size=$small ;; esac
    refuses "render $arguments" 2 "$word" render $box -o "$out/a.exr" $size $arguments
done <<'TABLE'
--frobnicate|--frobnicate
--frobnicate|--frobnicate 3
--frobnicate|--frobnicate=3
-x|-x 3
a value is missing|--size
a value is missing|--size --quiet
takes no value|--quiet=1
--size 'x'|--size x
--size '8'|--size 8
--size '8x'|--size 8x
--size 'x8'|--size x8
--size '0x8'|--size 0x8
--size '8x0'|--size 8x0
--size '-8x8'|--size -8x8
--size '8x8x8'|--size 8x8x8
--size '8.5x8'|--size 8.5x8
--size '+8x8'|--size +8x8
--size '65537x1'|--size 65537x1
--size '8x99999999999999999999'|--size 8x99999999999999999999
67108864 pixels|--size 65536x65536
67108864 pixels|--size 8192x8193
--seed '-1'|--seed -1
--seed '1.5'|--seed 1.5
--seed '18446744073709551616'|--seed 18446744073709551616
--seed 'one'|--seed one
--threads '-1'|--threads -1
--threads '1025'|--threads 1025
--threads '1e3'|--threads 1e3
--threads '99999999999999999999'|--threads 99999999999999999999
--time 'nan'|--time nan
--time 'inf'|--time inf
--time '1e999'|--time 1e999
--time '0x10'|--time 0x10
--time '1s'|--time 1s
--frames 'a'|--frames a
--frames '1:'|--frames 1:
--frames ':1'|--frames :1
--frames '3:1'|--frames 3:1
--frames '1:2:3'|--frames 1:2:3
--frames '0:10000001'|--frames 0:10000001
--fps '0'|--frames 0:1 --fps 0
--fps '-24'|--frames 0:1 --fps -24
--fps 'nan'|--frames 0:1 --fps nan
--exposure 'x'|--exposure x
--exposure '1001'|--exposure 1001
unknown layers 'colour'|--layers colour
unknown layers ''|--layers color,
unknown layers ''|--layers=
color|--layers gbuffer --png a.png
no camera 'nobody'|--camera nobody
no camera '7'|--camera 7
no camera '-1'|--camera -1
unknown method 'radiosity'|-m radiosity
NAME=VALUE|-p spp
unknown parameter 'samples'|-p samples=3
unknown parameter ''|-p =3
'spp'|--spp 0
'spp'|--spp -1
'spp'|--spp 1.5
'spp'|--spp many
'spp'|--spp=
'spp'|-p spp=
'spp'|--spp 1e10
'spp'|--spp inf
'bounces'|--bounces -1
'bounces'|--bounces 2147483648
'bounces'|--bounces infinity
'estimator'|--estimator both
'estimator'|--estimator=
'roulette_depth'|--roulette-depth 0
'target_error'|--target-error -0.1
'target_error'|--target-error 2
'target_error'|--target-error nan
'target_error'|--target-error 0.5 --layers gbuffer
'max_spp'|--target-error 0.5 --spp 9 --max-spp 8
'max_spp'|--max-spp 0
'gradients'|--gradients maybe
'gradient_step'|--gradient-step -1
'gradient_angle'|--gradient-angle 0
--scene-index '-1'|--scene-index -1
--scene-index 'x'|--scene-index x
scene|--scene-index 7
--env-scale '-1'|--env-scale -1
--env-scale 'nan'|--env-scale nan
--env-rotation-deg 'x'|--env-rotation-deg x
--background '1,2'|--background 1,2
--background '1,2,3,4'|--background 1,2,3,4
--background '1,,3'|--background 1,,3
--background '1,2,-3'|--background 1,2,-3
--background '1,2,inf'|--background 1,2,inf
one scene at a time|another.gltf
table alone|--points p.npy --png a.png
table alone|--points p.npy --dump d
no --camera|--points p.npy --camera 0
no --size|--points p.npy --size 4x4
no --layers|--points p.npy --layers all
--frames and --time|--frames 0:1 --time 0
--fps without --frames|--fps 24
--exposure without --png|--exposure 0
--env and --background|--env e.exr --background 0,0,0
--env-scale without --env|--env-scale 1
--env-rotation-deg without --env|--env-rotation-deg 0
--env '': takes the name|--env=
--points '': takes the name|--points=
--memory-limit '0'|--memory-limit 0
--memory-limit '-1'|--memory-limit -1
--memory-limit '4GB'|--memory-limit 4GB
--memory-limit 'G'|--memory-limit G
--memory-limit '16777216T'|--memory-limit 16777216T
--memory-limit 'lots'|--memory-limit lots
TABLE
refuses "render: a scene without a name" 2 "no scene" render "" -o "$out/a.exr"
refuses "scene: --env and --background" 2 "--env and --background" scene $box --env e.exr \
    --background 0,0,0
refuses "scene: --env-scale alone" 2 "--env-scale without --env" scene $box --env-scale 2
refuses "render without a scene" 2 "no scene" render -o "$out/a.exr"
refuses "render without an output" 2 "-o OUT.exr" render $box
refuses "render: nothing at all" 2 "no scene" render
refuses "render: image to stdout" 2 "standard output" render $box -o -
refuses "render: 65 parameters" 2 "too many" render $box -o "$out/a.exr" \
    $(i=0; while [ $i -lt 65 ]; do echo "-p spp=1"; i=$((i + 1)); done)
refuses "render: a name of two lines" 2 "no?such" render "no
such.gltf" -o "$out/a.exr"

# ---- render: what is accepted ----
render() { # NAME ARGUMENT...
    what=$1
    shift
    accepts "$what" render $box $small "$@"
}
same() { # NAME A B
    "$assay" diff "$2" "$3" > /dev/null 2>&1
    result $? "$1"
}
differs() { # NAME A B
    "$assay" diff "$2" "$3" > /dev/null 2>&1
    [ $? -eq 1 ]
    result $? "$1"
}
a=$folder/a.exr b=$folder/b.exr
render "-o F" -o "$a"
render "-oF" "-o$b"
same "-oF is -o F" "$a" "$b"
render "--output F" --output "$folder/c.exr"
render "--output=F" "--output=$folder/c.exr"
same "--output=F is -o F" "$a" "$folder/c.exr"
run render -o "$b" $small -- "$box"
went_well
result $? "-- ends the options"
render "-m path" -m path -o "$b"
render "--method=path" --method=path -o "$b"
same "path is the default" "$a" "$b"
render "-p spp=2" -p spp=2 -o "$b"
render "--spp=2" --spp=2 -o "$folder/c.exr"
same "-p spp=2 is --spp=2" "$b" "$folder/c.exr"
differs "mutant: another spp is another image" "$a" "$b"
render "the last value counts" --spp 7 --spp 1 -o "$b"
same "the last value counts, same image" "$a" "$b"
render "spp=1e0 is 1" -p spp=1e0 -o "$b"
same "spp=1e0 is 1, same image" "$a" "$b"
for option in --roulette-depth=2 --roulette_depth=2 --max-spp=9 --bounces=inf --bounces=0 \
    --estimator=nee --estimator=bsdf --target-error=0 --gradients=off --gradient-step=0.1 \
    --gradient-angle=0.1; do
    render "$option" $option -o "$b"
done
render "--seed 0" --seed 0 -o "$b"
same "the default seed is 0" "$a" "$b"
render "--seed 2^64-1" --seed 18446744073709551615 -o "$b"
differs "another seed is another image" "$a" "$b"
for threads in 0 1 2 3 4 5 64; do
    render "--threads $threads" --threads $threads -o "$b"
    same "--threads $threads: same image" "$a" "$b"
done
render "--camera by number" --camera 0 -o "$b"
same "camera 0 is the default" "$a" "$b"
name=$("$assay" scene "$box" | sed -n 's/^  camera 0 *//p')
render "--camera by name" --camera "$name" -o "$b"
same "a camera by its name" "$a" "$b"
render "-q" -q -o "$b"
render "--quiet" --quiet -o "$b"
render "--size 1x1" --size 1x1 -o "$b"
render "--size 3x70" --size 3x70 -o "$b"
render "--png" --png "$folder/a.png" -o "$b"
render "--exposure" --png "$folder/b.png" --exposure -3 -o "$b"
{ [ "$(head -c 4 "$folder/a.png" | tail -c 3)" = PNG ] && ! cmp -s "$folder/a.png" "$folder/b.png"; }
result $? "--exposure changes the preview"
same "--exposure does not change the image" "$a" "$b"
render "an output without extension" -o "$folder/plain"
same "an output without extension is an image" "$a" "$folder/plain"

# ---- layers ----
channels() { # FILE: first parts of all channel names
    "$assay" diff "$1" "$1" | sed '1d; /^$/,$d; s/ .*//; s/^Variance\.//; s/\.[A-Z]$//' | sort -u | tr '\n' ' '
}
expect_channels() { # LAYERS CHANNELS
    render "--layers $1" --layers "$1" -o "$b"
    [ "$(channels "$b")" = "$2" ] || echo "# $(channels "$b")"
    [ "$(channels "$b")" = "$2" ]
    result $? "--layers $1: its channels"
}
LC_ALL=C
export LC_ALL
expect_channels color "B G R SampleCount "
expect_channels split "Direct Indirect "
expect_channels irradiance "Irradiance IrradianceDirect IrradianceIndirect SampleCount.Irradiance "
expect_channels gbuffer "Albedo MaterialId N Ns P PrimitiveId UV Z "
expect_channels color,color "B G R SampleCount "
expect_channels color,split "B Direct G Indirect R SampleCount "
render "--layers all" --layers all -o "$b"
same "all layers are the default" "$a" "$b"

# ---- scene options ----
{ "$assay" render $box --size 16x8 --spp 1 --layers color -o "$folder/env.exr"; } 2> /dev/null
sphere=scenes/furnace-sphere/furnace-sphere.gltf
sphere() { # NAME ARGUMENT...
    what=$1
    shift
    accepts "$what" render $sphere --size 8x8 --spp 8 -q "$@"
}
sphere "a scene with options of its own" -o "$folder/s.exr"
for option in "--background 0,0.5,1" "--background=0,0,0" "--env $folder/env.exr" \
    "--env $folder/env.exr --env-scale 2" "--env $folder/env.exr --env-rotation-deg -90"; do
    sphere "$option" $option -o "$folder/t.exr"
    differs "$option: another image" "$folder/s.exr" "$folder/t.exr"
    mv "$folder/t.exr" "$folder/s.exr"
done
accepts "--scene-index 0" render $box $small --scene-index 0 -o "$b"
same "scene 0 is the default" "$a" "$b"
accepts "--force-diffuse" render scenes/cornell-box-glossy/cornell-box-glossy.gltf $small \
    --force-diffuse -o "$b"
accepts "--solid-transmission" render $box $small --solid-transmission -o "$b"

# ---- frames ----
moving=scenes/animated/animated.gltf
frames() { # NAME ARGUMENT...
    what=$1
    shift
    clear_out
    accepts "$what" render $moving $small -q "$@"
}
expect_files() { # NAME FILES
    [ "$(ls -A "$out" | tr '\n' ' ')" = "$2" ] || echo "# there are: $(ls -A "$out" | tr '\n' ' ')"
    [ "$(ls -A "$out" | tr '\n' ' ')" = "$2" ]
    result $? "$1"
}
frames "--frames 0:2, ####" --frames 0:2 -o "$out/f-####.exr"
expect_files "names from ####" "f-0000.exr f-0001.exr f-0002.exr "
frames "--frames 9:10, #" --frames 9:10 -o "$out/f#.exr" --png "$out/p#.png" --stats "$out/s#.json"
expect_files "names from #" "f10.exr f9.exr p10.png p9.png s10.json s9.json "
frames "--frames 7, no #" --frames 7 -o "$out/f.exr"
expect_files "names without #" "f.0007.exr "
frames "--frames 7, no # and no extension" --frames 7 -o "$out/f"
expect_files "names without # and extension" "f.0007 "
frames "--frames -1:0" --frames -1:0 -o "$out/f##.exr"
expect_files "frames before 0" "f-1.exr f00.exr "
frames "two runs of #" --frames 3 -o "$out/a##b##.exr"
expect_files "the last run of # counts" "a##b03.exr "
mkdir "$out/x.y"
accepts "a dot in the folder alone" render $moving $small -q --frames 4 -o "$out/x.y/f"
[ -f "$out/x.y/f.0004" ]
result $? "a dot in the folder is no extension"
clear_out
frames "--dump of frames" --frames 0:1 -o "$out/f#.exr" --dump "$out/d#"
expect_files "bundles of frames" "d0 d1 f0.exr f1.exr "
frames "--stats - of frames" --frames 0:1 -o "$out/f#.exr" --stats -
[ "$(grep -c '"samples"' "$folder/stdout")" -eq 2 ]
result $? "--stats - of frames: on stdout"
frames "frame 12 at 24 frames a second" --frames 12 -o "$out/f.exr"
accepts "time 0.5" render $moving $small -q --time 0.5 -o "$out/t.exr"
same "frame 12 of 24 is time 0.5" "$out/f.0012.exr" "$out/t.exr"
accepts "frame 6 at 12 frames a second" render $moving $small -q --frames 6 --fps 12 -o "$out/g.exr"
same "--fps" "$out/g.0006.exr" "$out/t.exr"
accepts "time 0" render $moving $small -q --time 0 -o "$out/z.exr"
differs "mutant: another time is another image" "$out/z.exr" "$out/t.exr"
accepts "a time before the first and after the last key" render $moving $small -q --time -1e300 \
    -o "$out/z.exr"
clear_out
refuses "frames so slow that their time is no number" 2 "time" render $moving $small \
    --frames 1000000 --fps 1e-308 -o "$out/f.exr"

# ---- points ----
write_npy "$folder/points.npy" "2, 6" 0 h 0 0 1 0 0 h 0 0 0 1
accepts "--points" render $box --spp 2 --points "$folder/points.npy" -o "$folder/r.npy" \
    --gradient-step 0.5 --gradient-angle 0.5
[ "$(wc -c < "$folder/r.npy")" -ge $((2 * 54 * 8 + 64)) ]
result $? "--points: 2 rows of 54 columns"
run render $box --spp 2 --points "$folder/points.npy" -o "$folder/r.npy"
[ "$code" -eq 0 ] && grep -q 'warning: gradients: .*gradients=off' "$folder/stderr"
result $? "--points: steps too short for the samples are said"
run render $box --size 4x4 --spp 2 --target-error 1e-6 --max-spp 9 -o "$folder/t.exr"
[ "$code" -eq 0 ] && grep -q 'warning: target_error' "$folder/stderr"
result $? "--target-error: not reached is said"
accepts "--points, gradients off" render $box --spp 2 --points "$folder/points.npy" \
    --gradients off -o "$folder/r.npy" --stats "$folder/r.json"
[ "$(wc -c < "$folder/r.npy")" -lt $((2 * 54 * 8)) ]
result $? "--points, gradients off: fewer columns"

write_npy "$folder/bad.npy" "1, 6" 0 h 0 0 0 0
refuses "--points: the file with the bad row is named" 2 "bad.npy: row 0" render $box --spp 2 \
    --points "$folder/bad.npy" -o "$out/r.npy"
refuses "--points with --target-error" 2 "target_error" render $box --spp 2 --target-error 0.1 \
    --points "$folder/points.npy" -o "$out/r.npy"
accepts "--points with --frames" render $moving --spp 1 --gradients off --points "$folder/points.npy" \
    --frames 0:1 -o "$folder/r#.npy"
accepts "--stats" render $box $small -o "$b" --stats "$folder/s.json" --dump "$folder/ends"
[ "$(tail -c 1 "$folder/s.json" | wc -l)" -eq 1 ] && [ "$(tail -c 1 "$folder/ends/manifest.json" | wc -l)" -eq 1 ]
result $? "JSON files end with a newline"

# ---- memory ----
refuses "an image larger than --memory-limit" 3 \
    "2000 x 2000 pixels with its layers: it needs 2.67 GiB" render $box --size 2000x2000 \
    --memory-limit 300M -o "$out/a.exr" --dump "$out/d"
refuses "--memory-limit is named" 3 "of a limit of 300 MiB" render $box --size 2000x2000 \
    --memory-limit 300M -o "$out/a.exr"
accepts "--memory-limit that is enough" render $box $small --memory-limit 100M -o "$b"
same "--memory-limit does not change the image" "$a" "$b"
accepts "--memory-limit none" render $box $small --memory-limit none -o "$b"
refuses "scene: --memory-limit" 3 "out of memory" scene $box --memory-limit 40K
accepts "scene: --memory-limit that is enough" scene $box --memory-limit 1G
refuses "diff: --memory-limit" 3 "out of memory" diff "$a" "$a" --memory-limit 16K
accepts "diff: --memory-limit that is enough" diff "$a" "$a" --memory-limit 100M
cat > "$folder/zeros.gltf" << 'EOF'
{"asset": {"version": "2.0"}, "nodes": [{"mesh": 0}],
 "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
 "accessors": [{"componentType": 5126, "count": 25165824, "type": "VEC3", "min": [0, 0, 0], "max": [0, 0, 0]}]}
EOF
refuses "a small file that asks for much memory" 3 "it needs 288 MiB" scene "$folder/zeros.gltf" \
    --memory-limit 200M

# ---- scene and methods ----
accepts "scene" scene $box
grep -q '^  camera 0 ' "$folder/stdout" && grep -q '^  digest  *[0-9a-f]\{64\}$' "$folder/stdout"
result $? "scene names cameras and digest"
printf '{"asset":{"version":"2.0"},"extensionsUsed":["FOO_bar"]}' > "$folder/empty.gltf"
accepts "scene: warnings are on stdout alone" scene "$folder/empty.gltf"
grep -q 'warning.*FOO_bar' "$folder/stdout"
result $? "scene: the warning names the extension"
run render "$folder/empty.gltf" $small -o "$folder/e.exr"
[ "$code" -eq 0 ] && grep -q 'warning: .*FOO_bar' "$folder/stderr" && [ ! -s "$folder/stdout" ]
result $? "render warns on stderr"
accepts "-q: no warning" render "$folder/empty.gltf" $small -q -o "$folder/e.exr"
refuses "scene without a file" 2 "no scene" scene
refuses "two scenes" 2 "one scene" scene a b
accepts "methods" methods
accepts "methods path" methods path
grep -q '^  spp ' "$folder/stdout"
result $? "methods path names spp"
refuses "methods: unknown name" 2 "radiosity" methods radiosity
refuses "methods: two names" 2 "one method" methods path path

# ---- diff ----
accepts "diff: the same file" diff "$a" "$a"
[ "$(tail -n 1 "$folder/stdout")" = identical ]
result $? "diff says identical"
"$assay" render $box $small --seed 9 -o "$b"
run diff "$a" "$b" --heat-map "$folder/heat.png"
[ "$code" -eq 1 ] && [ ! -s "$folder/stderr" ] && [ "$(tail -n 1 "$folder/stdout")" = different ]
result $? "diff: other pixels: 1"
[ "$(head -c 4 "$folder/heat.png" | tail -c 3)" = PNG ]
result $? "diff --heat-map"
run diff "$a" "$b" --json
[ "$code" -eq 1 ] && [ ! -s "$folder/stderr" ]
result $? "diff --json: other pixels: 1"
"$assay" render $box $small --layers color -o "$folder/color.exr"
run diff "$a" "$folder/color.exr"
[ "$code" -eq 1 ] && [ ! -s "$folder/stderr" ]
result $? "diff: a channel is missing: 1"
grep -q '^only in A: Z$' "$folder/stdout"
result $? "diff names a channel that one image lacks"
"$assay" render $box $small --layers gbuffer -o "$folder/gbuffer.exr"
refuses "diff: no channel in common" 2 "channel" diff "$folder/color.exr" "$folder/gbuffer.exr"
"$assay" render $box --size 4x8 --spp 1 -o "$folder/other.exr"
refuses "diff: other size" 2 "8 x 8 and 4 x 8" diff "$a" "$folder/other.exr" \
    --heat-map "$out/h.png"
refuses "diff: an image without a name" 2 "name of an image" diff "" "$a"
refuses "diff: --scale without --heat-map" 2 "--scale without --heat-map" diff "$a" "$a" --scale 1
refuses "diff: one image" 2 "two images" diff "$a"
refuses "diff: none" 2 "two images" diff
refuses "diff: three images" 2 "two images" diff "$a" "$a" "$a"
for scale in 0 -1 nan x; do
    refuses "diff --scale $scale" 2 "--scale" diff "$a" "$a" --scale $scale --heat-map "$out/h.png"
done
"$assay" render $box --size 16x12 --spp 1 -o "$folder/c.exr"
"$assay" render $box --size 16x12 --spp 1 --seed 5 -o "$folder/d.exr"
for map in png exr; do
    run diff "$folder/c.exr" "$folder/d.exr" --flip-map "$folder/flip.$map"
    [ "$code" -eq 1 ] && [ ! -s "$folder/stderr" ] && [ -s "$folder/flip.$map" ] &&
        grep -q '^SSIM  [-0-9.]*$' "$folder/stdout" && grep -q '^LDR-FLIP  mean 0\.[0-9]* ' "$folder/stdout" &&
        grep -q '^HDR-FLIP  mean 0\.[0-9]* .*aces' "$folder/stdout"
    result $? "diff --flip-map: $map"
done
[ "$("$assay" diff "$folder/flip.exr" "$folder/flip.exr" | sed '1d; /^$/,$d; s/ .*//' | tr '\n' ' ')" = "Exposure FLIP " ]
result $? "diff --flip-map F.exr: its channels"
run diff "$folder/c.exr" "$folder/d.exr" --flip ldr --layer Indirect --exposure 2 --ppd 20
[ "$code" -eq 1 ] && grep -q '^Indirect.RGB ' "$folder/stdout" && ! grep -q HDR "$folder/stdout"
result $? "diff --flip ldr --layer"
run diff "$folder/c.exr" "$folder/d.exr" --flip hdr --tone-mapper hable --start-exposure -2 \
    --stop-exposure 1 --exposures 3
[ "$code" -eq 1 ] && grep -q '^HDR-FLIP .*(hable, 3 exposures, -2.0000 to 1.0000)$' "$folder/stdout"
result $? "diff --tone-mapper and exposures"
run diff "$folder/c.exr" "$folder/d.exr" --flip none
[ "$code" -eq 1 ] && ! grep -q FLIP "$folder/stdout"
result $? "diff --flip none"
accepts "diff: no picture, a table" diff "$folder/gbuffer.exr" "$folder/gbuffer.exr"
! grep -q SSIM "$folder/stdout"
result $? "diff: no picture, no SSIM"
refuses "diff: the picture of one image is missing" 2 'channel "R"' diff "$a" "$folder/gbuffer.exr"
refuses "diff: a layer that is not there" 2 'channel "Nowhere.R"' diff "$a" "$a" --layer Nowhere
refuses "diff: a layer of numbers" 2 'channel "SampleCount.R"' diff "$a" "$a" --layer SampleCount
refuses "diff: start after stop" 2 "start at 3 stops" diff "$a" "$a" --start-exposure 3 \
    --stop-exposure 2 --flip-map "$out/f.png"
refuses "diff --flip x" 2 "--flip" diff "$a" "$a" --flip x
refuses "diff --ppd 0" 2 "--ppd" diff "$a" "$a" --ppd 0
refuses "diff --exposure 101" 2 "--exposure" diff "$a" "$a" --exposure 101
refuses "diff --exposures 0" 2 "--exposures" diff "$a" "$a" --exposures 0
refuses "diff --tone-mapper x" 2 "--tone-mapper" diff "$a" "$a" --tone-mapper x
refuses "diff: a tone mapper without HDR" 2 "without HDR-FLIP" diff "$a" "$a" --flip ldr --tone-mapper aces
refuses "diff: a map without FLIP" 2 "--flip-map" diff "$a" "$a" --flip none --flip-map "$out/f.png"
refuses "diff: both maps in one file" 2 "the same file" diff "$a" "$a" --heat-map "$out/f.png" \
    --flip-map "$out/f.png"
for name in f.jpg f.tga f png f.exr.gz; do
    refuses "diff: a FLIP map called $name" 2 "$name: a map is .png or .exr" diff "$a" "$a" --flip-map "$out/$name"
    refuses "diff: a heat map called $name" 2 "$name: a map is .png or .exr" diff "$a" "$a" --heat-map "$out/$name"
done
refuses "diff: missing file" 2 "missing.exr" diff "$a" "$folder/missing.exr"
refuses "diff: a scale of numbers" 2 "--scale" diff "$a" "$a" --scale 2 --heat-map "$out/h.exr"
run diff "$a" "$b" --heat-map "$folder/heat.exr" --flip none
"$assay" diff "$folder/heat.exr" "$folder/heat.exr" | grep -q '^RelativeError '
result $? "diff --heat-map F.exr"
finish
