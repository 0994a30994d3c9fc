#!/bin/sh
# shellcheck disable=SC2086
# Breaks the source on purpose, one line of a list at a time, and expects the named test to fail.  The
# list is $MUTANTS, or mutants.txt; `HEADER in FILE.c` breaks a header for the one that includes it;
# a test that is a script is run with a broken command.  Prints TAP.  MUTANT_COMPILE, MUTANT_LINK,
# MUTANT_LIBS, MUTANT_COMMAND (the command's objects) and BUILD come from the Makefile.
set -u
: "${MUTANT_COMPILE:?run this through make test}" "${MUTANT_LINK:?}" "${BUILD:?}"
folder=$(mktemp -d) || exit 1
trap 'rm -rf "$folder"' EXIT
# The command with a broken object for its own, or for one of the library's.
link_command() {
    rest=
    for object in $MUTANT_COMMAND; do
        [ "$object" = "$BUILD/${1%.c}.o" ] || rest="$rest $object"
    done
    $MUTANT_LINK "$folder/mutant.o" $rest -o "$folder/mutant.bin" $MUTANT_LIBS
}
link_mutant() { # FILE TEST
    case $2 in
    *.sh) link_command "$1" ;;
    *) $MUTANT_LINK "$folder/mutant.o" "$BUILD/tests/$2.o" -o "$folder/mutant.bin" $MUTANT_LIBS ;;
    esac
}
passes() { # TEST
    case $1 in
    *.sh) ! ASSAY_BIN=$folder/mutant.bin timeout 300 "tests/$1" 2> /dev/null | grep -q '^not ok' ;;
    *) timeout 300 "$folder/mutant.bin" > /dev/null 2>&1 ;;
    esac
}
number=0
while IFS= read -r line; do
    case $line in "#"* | "") continue ;; esac
    number=$((number + 1))
    file=$(printf '%s\n' "$line" | sed 's/ ; .*//')
    change=$(printf '%s\n' "$line" | sed 's/^[^;]* ; //; s/ ; [^;]*$//')
    test=$(printf '%s\n' "$line" | sed 's/.* ; //')
    unit=${file##* in }
    file=${file%% in *}
    rm -rf "$folder/src"
    mkdir -p "$folder/$(dirname "$file")"
    mutant=$folder/$file
    sed "$change" "$file" > "$mutant"
    [ "$unit" != "$file" ] || unit=$mutant
    if cmp -s "$file" "$mutant"; then
        printf '%s\n' "not ok $number - $file: the expression changes nothing: $change"
    elif ! $MUTANT_COMPILE -iquote "$folder/src" -I"$(dirname "$file")" -w -c "$unit" -o "$folder/mutant.o" ||
         ! link_mutant "$file" "$test"; then
        printf '%s\n' "not ok $number - $file: the mutant does not build: $change"
    elif passes "$test"; then
        printf '%s\n' "not ok $number - $file: $test does not see: $change"
    else
        printf '%s\n' "ok $number - $test sees $(basename "$file"): $change"
    fi
done < "${MUTANTS:-tests/mutants/mutants.txt}"
printf '%s\n' "1..$number"
