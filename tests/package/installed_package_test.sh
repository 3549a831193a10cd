#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 the petal authors
# SPDX-License-Identifier: BSD-3-Clause

# Installs petal into a folder of its own, builds plugins/example against it as a user would, runs its tests, and runs it
# in a pipeline of the installed tree: installed_package_test.sh SOURCE_FOLDER BUILD_FOLDER
set -euo pipefail
source=$1
build=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
unset PETAL_PLUGIN_PATH

step() {
    "$@" >"$work/log" 2>&1 || { cat "$work/log" >&2; echo "failed: $*" >&2; exit 1; }
}
expect() {
    grep -qF -- "$1" "$2" || { cat "$2" >&2; echo "expected in the output: $1" >&2; exit 1; }
}

step cmake --install "$build" --prefix "$work/petal"
petal=$work/petal/bin/petal
# Sources elsewhere: nothing may lead back into petal's own tree.
cp -r "$source/plugins/example" "$work/example"
step cmake -S "$work/example" -B "$work/example_build" -DCMAKE_PREFIX_PATH="$work/petal"
step cmake --build "$work/example_build" --parallel
step ctest --test-dir "$work/example_build" --no-tests=error --output-on-failure

# The pipeline needs the plugin: without it the run is refused, with it the stage takes part.
step "$build/bin/petal_synthetic_scene" "$work/scene"
run=(run "$work/petal/share/petal/pipelines/letter_indoor.json" --with "$work/example/with_statistical_outlier.json"
     --data "$work/scene" --quiet)
code=0
"$petal" "${run[@]}" --out "$work/without" >"$work/log" 2>&1 || code=$?
[ "$code" -eq 2 ] || { cat "$work/log" >&2; echo "without the plugin: exit $code, expected 2" >&2; exit 1; }
expect "example.statistical_outlier" "$work/log"
code=0
"$petal" --plugin-path "$work/example_build" "${run[@]}" --out "$work/with" >"$work/log" 2>&1 || code=$?
[ "$code" -eq 0 ] || [ "$code" -eq 4 ] || { cat "$work/log" >&2; echo "with the plugin: exit $code" >&2; exit 1; }
expect '"example.statistical_outlier"' "$work/with/run.json"
expect '"T_camera_lidar"' "$work/with/result.json"

# Installed beside petal's own plugins it is found by itself.
step cmake --install "$work/example_build"
"$petal" stages >"$work/log"
expect example.statistical_outlier "$work/log"
