#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 the petal authors
# SPDX-License-Identifier: BSD-3-Clause

# Tells how much of framework/ the tests run, from the counts that ./test.sh left in build/ where it was told to keep them
# (CMAKE_OPTIONS=-DPETAL_COVERAGE=ON); fails below 90 % of the lines.
set -euo pipefail
cd "$(dirname "$0")/../.."

# gcov tells negative counts of branches where threads ran; lines are what counts here.
report=build/coverage.txt
gcovr --root . --filter framework/ --object-directory build --gcov-ignore-parse-errors --fail-under-line 90 build >"$report" 2>"$report.log" ||
    { cat "$report" "$report.log" >&2; exit 1; }
grep -E '^TOTAL' "$report"
