#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 the petal authors
# SPDX-License-Identifier: BSD-3-Clause

"""Runs pipelines/letter.json over simulated scenes and seeds and prints the tables of docs/letter.md.

Each run simulates a capture and calibrates from it; its result.json stays in the work folder, so that
an interrupted study goes on where it was. For example:

    scripts/figures/letter_scenes.py --petal build/bin/petal --seeds 20 --work /tmp/letter
"""

import json
import pathlib
import statistics

from runs import arguments, run_all

SCENES = ["indoor_floor_3m", "indoor_floor_5m", "car_3m", "car_5m", "indoor_four_boards", "car_8m"]
ASKED = SCENES[:4]  # gap of at least 10 cm, 3 and 5 m
WALL_GAPS_CM = [5, 7, 10, 15, 25, 50]
LETTER = ("the letter", 1.88, 44.64, 90.18, 99.11)


def wall_scene(gap_cm, folder):
    """A board hung before a wall, as indoor_wall_3m, with this gap behind it."""
    name = f"wall_{gap_cm:02d}cm"
    gap = gap_cm / 100
    file = folder / f"{name}.json"
    file.write_text(json.dumps({"petal_scene": 1, "name": name, "based_on": "indoor_wall_3m",
                                "objects": {"room": {"gap": [gap, gap]}}}))
    return str(file)


def patch(scene, duration):
    """Simulates in place of reading, and looks at the points behind the planes, at Table I's 5 cm too."""
    looks = {"truth": "scene.truth", "planes": "planes.planes"}
    wide = {"truth": "scene.truth", "planes": "planes_5cm.planes"}
    return {"stages": {
        "scene": {"type": "source.simulator", "params": {"scenes": [scene], "duration": duration}},
        "plane_points": {"type": "metric.plane_points", "in": looks},
        "planes_5cm": {"type": "detector.planes_ransac", "in": {"cloud": "sparse.cloud"},
                       "params": {"plane_threshold": 0.05}},
        "plane_points_5cm": {"type": "metric.plane_points", "in": wide},
        "boards": {"type": "metric.board_truth",
                   "in": {"truth": "scene.truth", "lidar": "lidar_boards.boards",
                          "image": "image_boards.boards"}},
        "result": {"in": {"metrics": ["reprojection.metrics", "table2.metrics", "labels.metrics",
                                      "truth.metrics", "plane_points.metrics", "boards.metrics"]}},
        "result_5cm": {"type": "sink.result", "params": {"file": "result_5cm.json"},
                       "in": {"extrinsics": "solve.extrinsics",
                              "correspondences": "match.correspondences",
                              "metrics": ["plane_points_5cm.metrics"]}},
        "overlay": None}}


def metrics_of(files):
    metrics = files["result"]["metrics"]
    metrics["vacant_5cm"] = files["result_5cm"]["metrics"].get("plane_points.vacant_share")
    return metrics


def values(runs, name):
    return [r[name] for r in runs if r.get(name) is not None]


def share(text, of):
    return f"{100 * text / of:.1f} %" if of else "-"


def percent_range(runs, name, digits=1):
    seen = values(runs, name)
    if not seen:
        return "-"
    return f"{100 * statistics.mean(seen):.{digits}f} ({100 * min(seen):.{digits}f} to {100 * max(seen):.{digits}f})"


def points_row(name, runs):
    sides = values(runs, "plane_points.least_side_count")
    found = sum(values(runs, "board_truth.lidar_found"))
    missed = sum(values(runs, "board_truth.lidar_missed"))
    image = sum(values(runs, "board_truth.image_found"))
    unseen = sum(values(runs, "board_truth.image_missed"))
    false = sum(values(runs, "board_truth.lidar_false"))
    false_image = sum(values(runs, "board_truth.image_false"))
    return (f"| {name} | {len(runs)} | {percent_range(runs, 'plane_points.edge_share')} | "
            f"{percent_range(runs, 'labels.before.vacant_share', 2)} | "
            f"{percent_range(runs, 'labels.after.vacant_share', 2)} | "
            f"{percent_range(runs, 'plane_points.vacant_share', 2)} | "
            f"{percent_range(runs, 'vacant_5cm', 2)} | "
            f"{min(sides):.0f} / {statistics.median(sides):.0f} | "
            f"{found:.0f} of {found + missed:.0f} | {false:.0f} | "
            f"{image:.0f} of {image + unseen:.0f} | {false_image:.0f} |")


def table_two(name, runs):
    """Failed detections count as beyond 10 px: shares are of the corners that were to be found."""
    def weighted(figure, weight):
        pairs = [(r[figure], r[weight]) for r in runs
                 if r.get(figure) is not None and r.get(weight)]
        total = sum(w for _, w in pairs)
        return sum(v * w for v, w in pairs) / total if total else float("nan")
    t = "normalised_reprojection."
    mean = weighted(t + "mean_px", t + "count")
    shares = [100 * weighted(t + f"below_{n}px_share", t + "expected") for n in (1, 5, 10)]
    ranges = values(runs, t + "largest_range")
    turn, shift = values(runs, "truth.rotation_deg"), values(runs, "truth.translation_m")
    drift = values(runs, "truth.drift_px")
    far = f"{max(ranges):.1f}" if ranges else "-"
    pose = (f"{statistics.median(turn):.2f} / {max(turn):.2f} | {1000 * statistics.median(shift):.0f} / "
            f"{1000 * max(shift):.0f} | {statistics.median(drift):.2f}") if turn else "- | - | -"
    return (f"| {name} | {mean:.2f} | {shares[0]:.2f} | {shares[1]:.2f} | {shares[2]:.2f} | {far} | "
            f"{pose} |")


def main():
    parser = arguments(__doc__, seeds=20)
    parser.add_argument("--duration", type=float, default=20.0, help="of a capture, s")
    parser.add_argument("--scenes", nargs="*", default=SCENES)
    parser.add_argument("--gaps-cm", nargs="*", type=int, default=WALL_GAPS_CM)
    options = parser.parse_args()

    options.work.mkdir(parents=True, exist_ok=True)
    scenes = options.scenes + [wall_scene(gap, options.work) for gap in options.gaps_cm]
    patches = {pathlib.Path(scene).stem: patch(scene, options.duration) for scene in scenes}
    runs = {name: [metrics_of(files) for files in each]
            for name, each in run_all(options, "letter.json", patches).items()}

    print("| scene | captures | near an edge, % | vacant before, % | behind filters, % | behind planes, % | at 5 cm, % "
          "| poorest side, least / median | LiDAR boards | false | image boards | false |")
    print("|---|---|---|---|---|---|---|---|---|---|---|---|")
    for name, each in runs.items():
        print(points_row(name, each))
    print()
    print("| scene | mean, px | < 1 px, % | < 5 px, % | < 10 px, % | largest range, m "
          "| true error, deg (median / max) | mm (median / max) | drift, px |")
    print("|---|---|---|---|---|---|---|---|---|")
    print("| {} | {} | {} | {} | {} | not told | not known | not known | |".format(*LETTER))
    for name, each in runs.items():
        print(table_two(name, each))
    asked = [r for name in ASKED for r in runs.get(name, [])]
    if asked:
        print(table_two("those at 3 and 5 m, gap from 10 cm", asked))


if __name__ == "__main__":
    main()
