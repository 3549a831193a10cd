#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 the petal authors
# SPDX-License-Identifier: BSD-3-Clause

# Writes docs/stages/*.md, the stage table of the README and the JSON schemas in pipelines/ from the stages'
# declarations.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/build.sh petal_runtime
unset PETAL_PLUGIN_PATH  # only petal's own stages
pages=$(mktemp -d)
trap 'rm -rf "$pages"' EXIT
build/bin/petal stages >"$pages/types"
build/bin/petal stages --markdown >"$pages/table"
mkdir "$pages/stages"
while read -r type _; do
    build/bin/petal stages "$type" --markdown >"$pages/stages/$type.md"
done <"$pages/types"
mkdir -p docs/stages
rm -f docs/stages/*.md
cp "$pages"/stages/*.md docs/stages/
sed -i -e '/<!-- stages:begin -->/,/<!-- stages:end -->/{//!d}' -e "/<!-- stages:begin -->/r $pages/table" README.md
build/bin/petal schema --out pipelines/petal.schema.json
build/bin/petal schema --patch --out pipelines/petal.patch.schema.json
build/bin/petal schema --comparison --out pipelines/petal.compare.schema.json
