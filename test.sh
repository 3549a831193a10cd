#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 the petal authors
# SPDX-License-Identifier: BSD-3-Clause

# Installs what is missing, builds, and runs all tests. Real data are read from PETAL_REAL_DATA or ../shared/data;
# tests that need them are skipped, visibly, where they are absent.
set -euo pipefail
cd "$(dirname "$0")"

scripts/install_packages.sh
echo "building"
scripts/build.sh
ctest --test-dir build --no-tests=error --output-on-failure --progress -j "$(nproc)" | grep -vE '^\s*$|^Test project' | tail -n 200
