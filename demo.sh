#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 the petal authors
# SPDX-License-Identifier: BSD-3-Clause

# Installs what is missing, builds, simulates a capture as a recorder would write it, calibrates camera and LiDAR on the
# letter's indoor scene, and says where the results lie. The real data are read from PETAL_REAL_DATA or ../shared/data;
# where they are absent, a synthetic scene of the same form is made and used instead. Exits 0 when the runs themselves
# went well, whatever the verdict.
set -euo pipefail
data=$(realpath -m "${PETAL_REAL_DATA:-$(dirname "$0")/../shared/data}")/sjtu_indoor
cd "$(dirname "$0")"

scripts/install_packages.sh
echo "building"
scripts/build.sh petal_runtime

echo "simulating a capture: a Livox Mid-70, a camera, a board on the floor"
build/bin/petal run pipelines/simulate.json --out runs/simulated --force --quiet
build/bin/petal inspect runs/simulated/scene.rawlog

if [ -e "$data/lidar_margin_points.csv" ]; then
    echo "calibrating on the letter's indoor scene, $data"
else
    data=build/synthetic_scene
    build/bin/petal_synthetic_scene "$data"
    echo "no real data (set PETAL_REAL_DATA): calibrating on a synthetic scene, $data"
fi

code=0
build/bin/petal run pipelines/letter_indoor.json --data "$data" --out runs/demo --force || code=$?
# 4 says that it ran and the result is weak or not usable: an honest answer, not a failure of the demo.
[ "$code" -eq 0 ] || [ "$code" -eq 4 ] || exit "$code"
echo "recording with its truth: $PWD/runs/simulated (scene.rawlog, truth.json, labels.u8)"
echo "overlay picture: $(find "$PWD/runs/demo/stages/overlay" -name '*.png' | head -n 1)"
