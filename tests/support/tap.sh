# tap.sh - for tests of the command in POSIX sh: `. tests/support/tap.sh`, checks, then `finish`.
#
# $assay is the program, $folder a temporary folder, $out a folder in it that is empty when a check
# begins.  Every run of the program is stopped after 120 s, so that a hang is a failure and no wait.
set -u
assay=${ASSAY_BIN:-build/release/assay}
folder=$(mktemp -d) || exit 1
out=$folder/out
mkdir "$out"
trap 'chmod -R u+rwx "$folder"; rm -rf "$folder"' EXIT
number=0
box=scenes/cornell-box/cornell-box.gltf
small="--size 8x8 --spp 1"

result() { # STATUS NAME
    number=$((number + 1))
    if [ "$1" -eq 0 ]; then
        echo "ok $number - $2"
    else
        echo "not ok $number - $2"
    fi
}

skip() { # NAME REASON
    number=$((number + 1))
    echo "ok $number - $1 # SKIP $2"
}

finish() { echo "1..$number"; }

# Runs the program; leaves $code, $folder/stdout, $folder/stderr.
run() {
    timeout -k 5 120 "$assay" "$@" > "$folder/stdout" 2> "$folder/stderr" < /dev/null
    code=$?
}

# What the last run said, as comments of the test's output.
explain() { # WHY
    echo "# $1; exit code $code; stdout and stderr:"
    head -n 5 "$folder/stdout" "$folder/stderr" | cat -v | sed 's/^/#   /'
}

is_empty() { [ -z "$(ls -A "$1")" ]; }
clear_out() { rm -rf "$out"; mkdir "$out"; }

# Judges the last run: it must fail with this exit code, say just one line on stderr that starts with
# "assay " and holds WORD, nothing on stdout, and leave nothing behind in $out.
failed_well() { # CODE WORD
    if [ "$code" -ne "$1" ]; then explain "exit code $1 was expected"
    elif [ -s "$folder/stdout" ]; then explain "stdout must be empty"
    elif [ "$(wc -l < "$folder/stderr")" -ne 1 ]; then explain "one line was expected"
    elif ! grep -q '^assay ' "$folder/stderr"; then explain "'assay COMMAND:' was expected"
    elif ! grep -qF -- "$2" "$folder/stderr"; then explain "the message should hold '$2'"
    elif ! is_empty "$out"; then explain "left behind: $(ls -A "$out")"
    else return 0
    fi
    return 1
}

# It must succeed and say nothing on stderr.
went_well() {
    if [ "$code" -ne 0 ]; then explain "exit code 0 was expected"
    elif [ -s "$folder/stderr" ]; then explain "stderr must be empty"
    else return 0
    fi
    return 1
}

refuses() { # NAME CODE WORD ARGUMENT...
    name=$1 want=$2 word=$3
    shift 3
    run "$@"
    failed_well "$want" "$word"
    result $? "$name"
    clear_out
}

accepts() { # NAME ARGUMENT...
    name=$1
    shift
    run "$@"
    went_well
    result $? "$name"
}

# A table of doubles as .npy (version 1.0): each value one of 0, 1, h (1/2), n (NaN), i (infinity).
write_npy() { # FILE SHAPE VALUE...
    printf '\223NUMPY\001\000v\000%-117s\n' \
        "{'descr': '<f8', 'fortran_order': False, 'shape': ($2), }" > "$1"
    npy=$1
    shift 2
    for value; do
        case $value in
        0) printf '\000\000\000\000\000\000\000\000' ;;
        1) printf '\000\000\000\000\000\000\360\077' ;;
        h) printf '\000\000\000\000\000\000\340\077' ;;
        n) printf '\000\000\000\000\000\000\370\177' ;;
        i) printf '\000\000\000\000\000\000\360\177' ;;
        esac
    done >> "$npy"
}
