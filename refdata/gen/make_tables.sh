#!/bin/sh
# make_tables.sh compare|update GENERATOR...
# Runs the generators into build/ref/new and either compares the tables with refdata, byte by byte,
# or puts them in their place.  Called by `make ref` and `make ref-update`.
set -eu
mode=$1
shift
new=build/ref/new
rm -rf "$new"
mkdir -p "$new/basis"
for generator in "$@"; do
    echo "${generator##*/}"
    "$generator" "$new/basis"
done
(cd "$new" && LC_ALL=C sha256sum basis/*.txt > MANIFEST)
case $mode in
compare)
    if ! diff -rq "$new/basis" refdata/basis || ! diff -q "$new/MANIFEST" refdata/MANIFEST; then
        echo "refdata is not what its generators write; look at $new" >&2
        exit 1
    fi
    echo "refdata: no difference in $(grep -c . "$new/MANIFEST") tables"
    ;;
update)
    mkdir -p refdata/basis
    rm -f refdata/basis/*.txt
    cp "$new"/basis/*.txt refdata/basis/
    cp "$new/MANIFEST" refdata/MANIFEST
    echo "refdata: $(grep -c . "$new/MANIFEST") tables written"
    ;;
*)
    echo "make_tables.sh: compare or update" >&2
    exit 2
    ;;
esac
