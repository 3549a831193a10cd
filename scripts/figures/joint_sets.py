#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 the petal authors
# SPDX-License-Identifier: BSD-3-Clause

"""Runs pipelines/calibrate.json over simulated sets of placements and prints the tables of docs/joint.md:
does the 95 % ellipsoid hold the truth, how large are the errors in units of their sigma, what is the
verdict. For example:

    scripts/figures/joint_sets.py --petal build/bin/petal --seeds 200 --work /tmp/joint
"""

import collections
import math
import statistics

from runs import arguments, run_all

SETS = ["set_four_diverse", "set_six_diverse", "set_one_flat", "set_three_yaw"]
CHI2_95_6 = 12.592  # 95 % of a chi-square with 6 degrees of freedom
AXES = [f"{kind}_{axis}" for kind in ("translation", "rotation") for axis in "xyz"]


def patch(scene, duration):
    return {"stages": {
        "scene": {"type": "source.simulator", "params": {"scenes": [scene], "duration": duration}},
        "boards": {"type": "metric.board_truth",
                   "in": {"truth": "scene.truth", "lidar": "lidar_boards.boards",
                          "image": "image_boards.boards"}},
        "result": {"in": {"metrics": ["reprojection.metrics", "intrinsics.metrics",
                                      "stillness.metrics", "board_check.metrics",
                                      "truth.metrics", "boards.metrics"]}},
        "overlay": None, "report": None}}


def sigmas(result):
    """The error of each axis in units of its sigma."""
    metrics, it = result["metrics"], result["extrinsics"][0]
    told = {f"translation_{a}": s for a, s in zip("xyz", it["sigma_translation_m"])}
    told.update({f"rotation_{a}": s for a, s in zip("xyz", it["sigma_rotation_deg"])})
    unit = {"translation": "m", "rotation": "deg"}
    return {axis: metrics[f"truth.{axis}_{unit[axis.split('_')[0]]}"] / told[axis] for axis in AXES}


def rms(numbers):
    return math.sqrt(statistics.mean(x * x for x in numbers))


def percentile(numbers, share):
    ordered = sorted(numbers)
    return ordered[min(len(ordered) - 1, int(share * len(ordered)))]


def row(name, results):
    solved = [r for r in results if r.get("extrinsics")]
    levels = collections.Counter(r["verdict"] for r in results)
    decided = collections.Counter(r["orientation"]["decided_by"] for r in solved)
    nees = [r["metrics"]["truth.nees"] for r in solved]
    held = sum(n <= CHI2_95_6 for n in nees)
    turn = [r["metrics"]["truth.rotation_deg"] for r in solved]
    shift = [1000 * r["metrics"]["truth.translation_m"] for r in solved]
    drift = [r["metrics"]["truth.drift_px"] for r in solved]
    wrong = sum(t > 30 for t in turn)  # a wrong order turns by a quarter or a half
    usable_wrong = sum(r["verdict"] == "usable" and r["metrics"]["truth.rotation_deg"] > 1
                       for r in solved)
    spread = " ".join(f"{rms([sigmas(r)[axis] for r in solved]):.2f}" for axis in AXES)
    count = len(results)
    return (f"| {name} | {count} | {len(solved)} | {100 * held / len(solved):.1f} % | "
            f"{statistics.mean(nees):.1f} / {statistics.median(nees):.1f} | {spread} | "
            f"{statistics.median(turn):.3f} / {percentile(turn, .95):.3f} | "
            f"{statistics.median(shift):.1f} / {percentile(shift, .95):.1f} | "
            f"{statistics.median(drift):.2f} | "
            f"{levels['usable']} / {levels['weak']} / {levels['not_usable']} | "
            f"{decided['data']} / {decided['prior']} / {decided['undecided']} | "
            f"{wrong} / {usable_wrong} |")


def main():
    parser = arguments(__doc__, seeds=200)
    parser.add_argument("--duration", type=float, default=10.0, help="of a capture, s")
    parser.add_argument("--sets", nargs="*", default=SETS)
    options = parser.parse_args()
    patches = {name: patch(name, options.duration) for name in options.sets}
    results = run_all(options, "calibrate.json", patches)
    print("| set | runs | solved | truth in the 95 % ellipsoid | NEES mean / median "
          "| RMS of error / sigma: t x y z, rot x y z | deg, median / 95 % | mm, median / 95 % "
          "| drift, px | usable / weak / not usable | order by data / prior / undecided "
          "| wrong order / called usable and wrong |")
    print("|---|---|---|---|---|---|---|---|---|---|---|---|")
    for name, each in results.items():
        print(row(name, [files["result"] for files in each]))


if __name__ == "__main__":
    main()
