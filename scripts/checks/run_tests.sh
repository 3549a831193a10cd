#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 the petal authors
# SPDX-License-Identifier: BSD-3-Clause

# Runs all test programs of a build folder, each in as many parts as there are cores: run_tests.sh FOLDER [COMMAND BEFORE EACH]...
# Faster than ctest, which starts a process for each test. Quiet on success.
set -euo pipefail
folder=$1
shift
logs=$(mktemp -d)
trap 'rm -rf "$logs"' EXIT

run_one() {
    local logs=$1 part=${2%% *} program=${2#* } code=0
    shift 2
    local log=$logs/${program##*/}.$part
    GTEST_TOTAL_SHARDS=$(nproc) GTEST_SHARD_INDEX=$part "$@" "$program" --gtest_brief=1 >"$log" 2>&1 || code=$?
    [ "$code" -eq 0 ] || { cat "$log"; echo "exit $code: $program"; return 1; } >&2
}
export -f run_one
for program in $(find "$folder/bin" -name '*_tests' | sort); do
    for part in $(seq 0 $(($(nproc) - 1))); do echo "$part $program"; done
done | xargs -P "$(nproc)" -I{} bash -c 'run_one "$@"' _ "$logs" {} "$@"
