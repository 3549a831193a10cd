#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 the petal authors
# SPDX-License-Identifier: BSD-3-Clause

# clang-tidy with the checks of .clang-tidy over framework and plugins. It reads the compile commands of build/ (made by
# scripts/build.sh), where several sources are one: that is many times faster than each by itself.
set -euo pipefail
cd "$(dirname "$0")/../.."

log=$(mktemp)
trap 'rm -f "$log"' EXIT
mapfile -t units < <(grep -oE '"file": "[^"]+"' build/compile_commands.json | cut -d'"' -f4 |
    grep -E '/(framework|plugins)/' | grep -vE '/tests/' | sort -u)
[ ${#units[@]} -gt 0 ] || { echo "build/compile_commands.json names no source; run scripts/build.sh" >&2; exit 1; }
printf '%s\n' "${units[@]}" |
    xargs -P "$(nproc)" -n 1 clang-tidy -p build --quiet --warnings-as-errors='*' \
        --header-filter="^$PWD/(framework|plugins)/" >"$log" 2>&1 || { grep -vE '^[0-9]+ warnings? (generated|treated)' "$log" >&2; exit 1; }
