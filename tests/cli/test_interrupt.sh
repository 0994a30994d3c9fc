#!/bin/sh
# shellcheck disable=SC2012,SC2046,SC2059,SC2086
# Ctrl-C and its relatives: exit code 130, one line, nothing left behind.  And what a terminal gets
# to see.  No check depends on how long something takes, only on that it ends.  TAP.
#
# A shell without job control starts programs in the background with SIGINT ignored; assay listens
# all the same.
. tests/support/tap.sh
endless="--size 64x64 --spp 1000000000"

wait_for() { # WHAT COMMAND...
    what=$1
    shift
    i=0
    until "$@"; do
        i=$((i + 1))
        [ $i -lt 1200 ] || { echo "# $what did not come"; break; }
        sleep 0.1
    done
}

# Starts the program, which is killed after two minutes; leaves $pid.
start() {
    "$assay" "$@" > "$folder/stdout" 2> "$folder/stderr" < /dev/null &
    pid=$!
    { timeout 120 tail --pid=$pid -f /dev/null || kill -KILL $pid; } 2> /dev/null &
}
# It has come so far that it listens to signals.
listens() {
    [ "$(cat /proc/$pid/comm)" = "$(basename "$assay" | cut -c 1-15)" ] &&
        grep -q '^SigCgt:.*[1-9a-f]' /proc/$pid/status
}
bundle_is_begun() { ls "$out"/bundle.* > /dev/null 2>&1; }
second_frame_is_there() { [ -f "$out/f1.exr" ]; }
stopped() { # NAME
    wait $pid
    code=$?
    failed_well 130 "cancelled"
    result $? "$1"
    clear_out
}

for name in INT TERM HUP; do
    start render $box $endless -o "$out/a.exr" --png "$out/a.png" --stats "$out/a.json" \
        --dump "$out/bundle"
    wait_for "the bundle" bundle_is_begun
    kill -$name $pid
    stopped "SIG$name while rendering"
done

start render $box $endless -o "$out/a.exr" --dump "$out/bundle"
wait_for "the bundle" bundle_is_begun
kill -INT $pid
kill -TERM $pid
kill -INT $pid
stopped "signals that come together"

start render $box --size 8x8 --target-error 1e-9 --max-spp 1000000000 -o "$out/a.exr" \
    --dump "$out/bundle"
wait_for "the bundle" bundle_is_begun
sleep 0.5
kill -INT $pid
stopped "an error that is never reached"

write_npy "$folder/points.npy" "1, 6" 0 h 0 0 1 0
start render $box --spp 1000000000 --points "$folder/points.npy" -o "$out/a.npy"
wait_for "the program" listens
sleep 0.2
kill -INT $pid
stopped "SIGINT while probing one point"

start render $box --size 32x32 --spp 64 --frames 0:1000000 -o "$out/f#.exr"
wait_for "the second frame" second_frame_is_there
kill -INT $pid
wait $pid
code=$?
broken=$(for f in "$out"/* "$out"/.[!.]*; do
    [ ! -e "$f" ] || "$assay" diff "$f" "$f" > /dev/null || echo "$f"
done)
[ $code -eq 130 ] && [ -z "$broken" ] || explain "130 and whole frames were expected: $broken"
[ $code -eq 130 ] && [ -z "$broken" ]
result $? "SIGINT between frames: those that are there are whole"
clear_out

# nohup: SIGHUP is ignored when the program begins.
trap '' HUP
start render $box $endless -o "$out/a.exr" --dump "$out/bundle"
trap - HUP
wait_for "the bundle" bundle_is_begun
kill -HUP $pid
sleep 0.5
kill -0 $pid 2> /dev/null && bundle_is_begun
result $? "SIGHUP under nohup does nothing"
kill -INT $pid
stopped "SIGINT under nohup"

# A reader that goes away is an error, not the end.
"$assay" scene $box --json 2> "$folder/stderr" | true
[ "$(wc -l < "$folder/stderr")" -le 1 ]
result $? "a reader that goes away"

# ---- a terminal ----
if script -qec true /dev/null > /dev/null 2>&1; then
    on_terminal() { # ARGUMENT...
        script -qec "$assay render $box --size 16x16 --spp 2 -o $out/a.exr $*" /dev/null \
            < /dev/null > "$folder/screen"
    }
    on_terminal
    result $? "render on a terminal"
    grep -q '\[#*\.*\] *[0-9]* %' "$folder/screen"
    result $? "a terminal gets a progress bar"
    tail -n 1 "$folder/screen" | grep -q 'million rays in .* s on .* threads'
    result $? "a terminal gets told what was done"
    on_terminal -q
    [ ! -s "$folder/screen" ]
    result $? "-q: a terminal gets nothing"
    on_terminal --spp nonsense
    [ "$(wc -l < "$folder/screen")" -eq 1 ] && ! grep -q '%' "$folder/screen"
    result $? "an error on a terminal is one line"
else
    skip "a progress bar" "no script(1)"
fi
finish
