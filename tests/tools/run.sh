#!/bin/sh
# run.sh PROGRAM... - runs test programs (cmocka, or anything that prints TAP) and closes with the
# totals: `N passed, N failed, N skipped`.  A program that dies counts as one failure.
set -u
logs=$(mktemp -d) || exit 1
trap 'rm -rf "$logs"' EXIT
export CMOCKA_MESSAGE_OUTPUT=TAP
jobs=${TEST_JOBS:-$(nproc)}

one=$logs/one.sh
cat > "$one" <<'EOF'
log=$2/$(echo "$1" | tr / _).log
start=$(date +%s)
"$1" > "$log" 2>&1
code=$?
grep -q '^not ok' "$log" || [ $code -eq 0 ] || echo "not ok - died with exit code $code" >> "$log"
pass=$(grep -c '^ok' "$log")
skip=$(grep -c '^\(not \)\{0,1\}ok.*# SKIP' "$log")
fail=$(grep '^not ok' "$log" | grep -vc '# SKIP')
pass=$((pass - $(grep -c '^ok.*# SKIP' "$log")))
echo "$pass $fail $skip" > "$log.count"
printf '%-44s %4d passed %3d failed %3d skipped  %3d s\n' "${1##*/tests/}" $pass $fail $skip \
       $(($(date +%s) - start))
[ "$fail" -eq 0 ] || sed 's/^/    /' "$log"
grep -h '^#|' "$log" | sed 's/^#|/    /'
exit 0
EOF

printf '%s\n' "$@" | xargs -P "$jobs" -I{} sh "$one" {} "$logs"
cat "$logs"/*.count | awk '{ p += $1; f += $2; s += $3 }
    END { printf "%d passed, %d failed, %d skipped\n", p, f, s; exit f > 0 || p == 0 }'
