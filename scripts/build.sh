#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 the petal authors
# SPDX-License-Identifier: BSD-3-Clause

# Configures and builds into build/: scripts/build.sh [CMAKE TARGET]... Quiet on success.
set -euo pipefail
cd "$(dirname "$0")/.."

log=$(mktemp)
trap 'rm -f "$log"' EXIT
quiet() {
    "$@" >"$log" 2>&1 || { cat "$log" >&2; echo "failed: $*" >&2; exit 1; }
}
generator=()
[ -e build/CMakeCache.txt ] || generator=(-G Ninja)
quiet cmake -S . -B build "${generator[@]}" -DCMAKE_BUILD_TYPE=Release -DPETAL_WERROR=ON
if [ $# -eq 0 ]; then
    quiet cmake --build build
else
    quiet cmake --build build --target "$@"
fi
