#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 the petal authors
# SPDX-License-Identifier: BSD-3-Clause

# Installs what is missing, builds, simulates recordings of four placements of a board, calibrates camera and LiDAR from
# their raw points, and says how far that is from the truth and where the results lie. Where there are real data
# (PETAL_REAL_DATA, or ../shared/data) the letter's indoor scene is calibrated too. Exits 0 when the runs themselves went
# well, whatever the verdict.
set -euo pipefail
data=$(realpath -m "${PETAL_REAL_DATA:-$(dirname "$0")/../shared/data}")/sjtu_indoor
cd "$(dirname "$0")"

scripts/install_packages.sh
echo "building"
scripts/build.sh petal_runtime

# 4 says that it ran and the result is weak or not usable: an honest answer, not a failure of the demo.
calibrate() {
    local code=0
    build/bin/petal run "$@" --force || code=$?
    [ "$code" -eq 0 ] || [ "$code" -eq 4 ] || exit "$code"
}
recording=runs/demo_recording
echo "simulating four recordings of a rig: a Livox Mid-70, a camera, one board that is placed near, left, right and far"
build/bin/petal run pipelines/simulate.json --set 'scene.scenes=["set_four_diverse"]' --set scene.duration=10 \
    --set 'record.file="{scene}/scene.rawlog"' --out "$recording" --force --quiet \
    >build/demo.log || { cat build/demo.log >&2; exit 1; }
build/bin/petal inspect "$recording/set_four_diverse_near/scene.rawlog"
echo "calibrating from their raw points"
calibrate pipelines/calibrate.json --data "$recording" --out runs/demo --set 'scene.files=[
    "${data}/set_four_diverse_near/scene.rawlog", "${data}/set_four_diverse_left_up/scene.rawlog",
    "${data}/set_four_diverse_right_down/scene.rawlog", "${data}/set_four_diverse_far/scene.rawlog"]'
echo "against the truth:"
grep -m 3 -E '"truth\.(rotation_deg|translation_m|drift_px)"' runs/demo/result.json
echo "report: $PWD/runs/demo/report.html"
echo "overlay pictures: $PWD/runs/demo/stages/overlay"

if [ -e "$data/lidar_margin_points.csv" ]; then
    echo "calibrating on the letter's indoor scene, $data"
    calibrate pipelines/letter_indoor.json --data "$data" --out runs/demo_indoor
    echo "overlay picture: $(find "$PWD/runs/demo_indoor/stages/overlay" -name '*.png' | head -n 1)"
fi
