#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 the petal authors
# SPDX-License-Identifier: BSD-3-Clause

# clang-tidy with the checks of .clang-tidy over framework and plugins. It reads all sources of a library as one, so that
# the headers of MRPT, Eigen and OpenCV are read once for each: many times faster than each by itself.
set -euo pipefail
cd "$(dirname "$0")/../.."

log=$(mktemp)
trap 'rm -f "$log"' EXIT
cmake -S . -B build/tidy -G Ninja -DPETAL_TESTS=OFF -DPETAL_BENCHMARKS=OFF -DCMAKE_UNITY_BUILD=ON \
    -DCMAKE_UNITY_BUILD_BATCH_SIZE=0 >"$log" 2>&1 || { cat "$log" >&2; exit 1; }
mapfile -t units < <(grep -oE '"file": "[^"]+"' build/tidy/compile_commands.json | cut -d'"' -f4 |
    grep -E '/(framework|plugins)/' | sort -u)
[ ${#units[@]} -gt 0 ] || { echo "build/tidy/compile_commands.json names no source" >&2; exit 1; }
printf '%s\n' "${units[@]}" |
    xargs -P "$(nproc)" -n 1 clang-tidy -p build/tidy --quiet --warnings-as-errors='*' \
        --header-filter="^$PWD/(framework|plugins)/" >"$log" 2>&1 ||
    { grep -vE '^[0-9]+ warnings? (generated|treated)' "$log" >&2; exit 1; }
