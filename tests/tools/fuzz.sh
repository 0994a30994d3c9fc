#!/bin/sh
# fuzz.sh [SECONDS] - libFuzzer with ASan and UBSan on the loaders: scenes, then images and tables.
# The corpus starts from our own scenes and is kept under build/fuzz.  Fails on any finding, whose
# input is kept beside the corpus.
set -eu
seconds=${1:-3600}
build=build/fuzz
sanitizers="-fsanitize=address,undefined -fno-sanitize-recover=all"
make -s -j"$(nproc)" BUILD=$build CC=clang CXX=clang++ OPT="-O1 -g" \
    SAN="$sanitizers -fsanitize=fuzzer-no-link" $build/libassay.a $build/tests/fuzz/make_corpus
$build/tests/fuzz/make_corpus scenes $build/corpus
for target in gltf image; do
    make -s BUILD=$build CC=clang CXX=clang++ OPT="-O1 -g" \
        SAN="$sanitizers -fsanitize=fuzzer-no-link" FUZZ_LINK=-fsanitize=fuzzer \
        $build/tests/fuzz/fuzz_$target
done
status=0
for target in gltf image; do
    mkdir -p $build/found/$target
    options="-max_total_time=$seconds -max_len=65536 -rss_limit_mb=4096 -timeout=25
             -print_final_stats=1 -verbosity=1 -artifact_prefix=$build/found/$target/"
    [ $target = image ] || options="$options -dict=tests/fuzz/gltf.dict"
    # shellcheck disable=SC2086
    $build/tests/fuzz/fuzz_$target $options $build/corpus/$target > $build/$target.log 2>&1 &
    eval "pid_$target=$!"
done
for target in gltf image; do
    eval "wait \$pid_$target" && word="no finding" || { word="FOUND SOMETHING"; status=1; }
    echo "fuzz_$target: $word in $seconds s;" \
         "$(grep -E 'number_of_executed_units' $build/$target.log | tail -1)"
done
exit $status
