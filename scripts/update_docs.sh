#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 the petal authors
# SPDX-License-Identifier: BSD-3-Clause

# Writes docs/stages/*.md and the stage table of the README from the stages' declarations.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/build.sh petal_runtime
rm -f docs/stages/*.md
mkdir -p docs/stages
for type in $(build/bin/petal stages | cut -d' ' -f1); do
    build/bin/petal stages "$type" --markdown >"docs/stages/$type.md"
done
table=$(mktemp)
trap 'rm -f "$table"' EXIT
build/bin/petal stages --markdown >"$table"
sed -i -e '/<!-- stages:begin -->/,/<!-- stages:end -->/{//!d}' -e "/<!-- stages:begin -->/r $table" README.md
