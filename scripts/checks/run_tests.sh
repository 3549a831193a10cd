#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 the petal authors
# SPDX-License-Identifier: BSD-3-Clause

# Runs all test programs of a build folder, as many at once as there are cores: run_tests.sh FOLDER [COMMAND BEFORE EACH]...
# Faster than ctest, which starts a process for each test. Quiet on success.
set -euo pipefail
folder=$1
shift
logs=$(mktemp -d)
trap 'rm -rf "$logs"' EXIT

run_one() {
    local logs=$1 program=$2 code=0
    shift 2
    "$@" "$program" --gtest_brief=1 >"$logs/${program##*/}" 2>&1 || code=$?
    [ "$code" -eq 0 ] || { cat "$logs/${program##*/}"; echo "exit $code: $program"; return 1; } >&2
}
export -f run_one
find "$folder/bin" -name '*_tests' | sort | xargs -P "$(nproc)" -I{} bash -c 'run_one "$@"' _ "$logs" {} "$@"
