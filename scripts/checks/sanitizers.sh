#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 the petal authors
# SPDX-License-Identifier: BSD-3-Clause

# Builds with sanitizers into build/<sanitizers>/ and runs the test programs:
#     scripts/checks/sanitizers.sh address,undefined|thread [all]
# Those of the framework; with `all` those of the plugins too, and one pipeline on four threads.
set -euo pipefail
cd "$(dirname "$0")/../.."

sanitizers=$1
folder=build/${sanitizers//,/-}
targets=(framework_tests loader_tests rawlog_tests)
if [ "${2:-}" = all ]; then
    targets+=(petal_runtime)
    for kind in calibration sources filters detectors solvers metrics sinks; do targets+=("${kind}_tests"); done
fi
# Warnings are the release build's business: GCC warns of code that sanitizers insert.
CMAKE_OPTIONS="-DPETAL_SANITIZE=$sanitizers -DCMAKE_BUILD_TYPE=Debug -DPETAL_WERROR=OFF -DCMAKE_CXX_FLAGS=-w
    -DPETAL_BENCHMARKS=OFF -DCMAKE_UNITY_BUILD_BATCH_SIZE=12" BUILD_FOLDER=$folder scripts/build.sh "${targets[@]}"

# Debian's libraries are built without: a report must come from petal's own code.
export TSAN_OPTIONS="suppressions=$PWD/scripts/checks/thread.supp ignore_noninstrumented_modules=1 halt_on_error=1 second_deadlock_stack=1"
export LSAN_OPTIONS="suppressions=$PWD/scripts/checks/leak.supp print_suppressions=0"
export ASAN_OPTIONS="detect_stack_use_after_return=1" UBSAN_OPTIONS="print_stacktrace=1"
if [ "$sanitizers" = thread ]; then
    # Its stage uses an algorithm of oneTBB, one half of which is in the library and one in headers: TSan sees races in it.
    export GTEST_FILTER="-RunnerParallelTest.AStageThatWaitsForItsOwnTasksIsLeftAlone"
fi
scripts/checks/run_tests.sh "$folder"

if [ "${2:-}" = all ]; then
    log=$(mktemp)
    trap 'rm -f "$log"' EXIT
    "$folder/bin/petal_synthetic_scene" "$folder/scene" >"$log"
    code=0
    "$folder/bin/petal" run pipelines/letter_indoor.json --data "$folder/scene" --out "$folder/run" --force --threads 4 \
        >"$log" 2>&1 || code=$?
    [ "$code" -eq 0 ] || [ "$code" -eq 4 ] || { cat "$log" >&2; echo "petal run: exit $code" >&2; exit 1; }
fi
