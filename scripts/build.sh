#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 the petal authors
# SPDX-License-Identifier: BSD-3-Clause

# Configures and builds into build/: scripts/build.sh [CMAKE TARGET]... Quiet on success. BUILD_FOLDER names another
# folder, CMAKE_OPTIONS adds options of CMake (words, separated by blanks).
set -euo pipefail
cd "$(dirname "$0")/.."

build=${BUILD_FOLDER:-build}
log=$(mktemp)
trap 'rm -f "$log"' EXIT
quiet() {
    "$@" >"$log" 2>&1 || { cat "$log" >&2; echo "failed: $*" >&2; exit 1; }
}
options=(-DCMAKE_BUILD_TYPE=Release -DPETAL_WERROR=ON -DPETAL_COVERAGE=OFF)
[ -e "$build/CMakeCache.txt" ] || options+=(-G Ninja)
# Several files to a compiler run: reading the headers of MRPT, Eigen and OpenCV costs most of the time of a build
# from nothing.
options+=(-DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=12)
read -r -d "" -a more <<<"${CMAKE_OPTIONS:-}" || true
quiet cmake -S . -B "$build" "${options[@]}" "${more[@]}"
if [ $# -eq 0 ]; then
    quiet cmake --build "$build"
else
    quiet cmake --build "$build" --target "$@"
fi
