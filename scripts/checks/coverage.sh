#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 the petal authors
# SPDX-License-Identifier: BSD-3-Clause

# Tells how much of framework/ the tests run, from the counts that the build with address,undefined left behind
# (-DPETAL_COVERAGE=ON); fails below 90 % of its lines.
set -euo pipefail
cd "$(dirname "$0")/../.."

report=build/coverage.txt
gcovr --root . --filter framework/ --object-directory build/address-undefined --fail-under-line 90 \
    --exclude-unreachable-branches --exclude-throw-branches build/address-undefined >"$report" 2>"$report.log" ||
    { cat "$report" "$report.log" >&2; exit 1; }
grep -E '^TOTAL' "$report"
