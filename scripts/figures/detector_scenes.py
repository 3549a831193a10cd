#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 the petal authors
# SPDX-License-Identifier: BSD-3-Clause

"""Runs pipelines/calibrate.json over simulated scenes and prints what its two detectors found there, as in
docs/lidar_template.md and docs/image_template.md. For example:

    scripts/figures/detector_scenes.py --petal build/bin/petal --seeds 5 --work /tmp/scenes
    scripts/figures/detector_scenes.py --lidar livox_avia --scenes indoor_floor_3m car_5m --work /tmp/avia
"""

import math
import statistics

from runs import ROOT, arguments, run_all

# Of another target, or of boards that are meant to move.
LEFT_OUT = {"checkerboard_3m", "board_moving", "wall_moving"}
TRUTH = "board_truth."


def patch(scene, options):
    simulator = {"scenes": [scene], "duration": options.duration}
    if options.lidar:
        simulator["lidar"] = options.lidar
    target = {"round_holes_3m": "four_round_holes_aruco"}.get(scene)
    detector = {"params": {"target": target}} if target else {}
    return {"stages": {
        "scene": {"type": "source.simulator", "params": simulator},
        "lidar_boards": detector, "image_boards": detector,
        "board_check": {"params": {"targets": [target]}} if target else {},
        "boards": {"type": "metric.board_truth",
                   "in": {"truth": "scene.truth", "lidar": "lidar_boards.boards",
                          "image": "image_boards.boards"}},
        "result": {"in": {"metrics": ["truth.metrics", "boards.metrics"]}},
        "overlay": None, "report": None}}


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def minus(a, b, factor=1.0):
    return [x - factor * y for x, y in zip(a, b)]


def unit(a):
    return [x / math.sqrt(dot(a, a)) for x in a]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def across_the_ray(metrics, boards):
    """m: the error of a scene's only board in the plane square to the ray to it; else None."""
    corners = [b["corners_lidar"] for b in boards if b["corners_lidar"]]
    if len(corners) != 1 or f"{TRUTH}board_1.lidar_x_m" not in metrics:
        return None
    c, row = corners[0], math.isqrt(len(corners[0]))
    x = unit(minus(c[row - 1], c[0]))
    z = unit(cross(x, minus(c[-row], c[0])))
    axes = [x, cross(z, x), z]
    told = [metrics[f"{TRUTH}board_1.lidar_{a}_m"] for a in "xyz"]
    error = [sum(told[k] * axes[k][i] for k in range(3)) for i in range(3)]
    ray = unit([sum(p[i] for p in c) for i in range(3)])
    off = minus(error, ray, dot(error, ray))
    return math.sqrt(dot(off, off))


def median(numbers, scale=1.0, form="{:.2f}"):
    return form.format(scale * statistics.median(numbers)) if numbers else ""


class Seen:
    """What one sensor's detector did in some scenes."""

    def __init__(self):
        self.found = self.missed = self.false = self.scenes = 0
        self.across, self.nees, self.shift, self.rms, self.image_nees = [], [], [], [], []

    def add(self, metrics, boards, sensor):
        self.scenes += 1
        for name in ("found", "missed", "false"):
            count = metrics.get(f"{TRUTH}{sensor}_{name}", 0)
            setattr(self, name, getattr(self, name) + int(count))
        for name, value in metrics.items():
            if name.endswith(".lidar_nees"):
                self.nees.append(value)
            if name.endswith(".image_shift_u_px"):
                self.shift.append(math.hypot(value, metrics[name.replace("_u_", "_v_")]))
            if name.endswith(".image_rms_px"):
                self.rms.append(value)
            if name.endswith(".image_nees"):
                self.image_nees.append(value / metrics[name + "_freedoms"])
        across = across_the_ray(metrics, boards)
        if across is not None:
            self.across.append(across)

    def counts(self):
        return f"{self.found} of {self.found + self.missed} | {self.false}"


def row(name, lidar, image):
    mean = statistics.mean
    return (f"| {name} | {lidar.counts()} | {median(lidar.across, 1e3)} | "
            f"{mean(lidar.nees) if lidar.nees else 0:.1f} | {image.counts()} | "
            f"{median(image.shift, form='{:.3f}')} | {median(image.rms, form='{:.3f}')} | "
            f"{mean(image.image_nees) if image.image_nees else 0:.2f} |")


def main():
    parser = arguments(__doc__, seeds=5)
    shipped = sorted(f.stem for f in (ROOT / "datasets/scenes").glob("*.json"))
    parser.add_argument("--duration", type=float, default=10.0, help="of a capture, s")
    parser.add_argument("--lidar", default="", help="a sensor in place of the scenes' own")
    parser.add_argument("--scenes", nargs="*", default=[s for s in shipped if s not in LEFT_OUT])
    options = parser.parse_args()
    patches = {scene: patch(scene, options) for scene in options.scenes}
    print("| scene | LiDAR boards | false | across the ray, mm | NEES (6) "
          "| image boards | false | centre, px | RMS, px | NEES a freedom (1) |")
    print("|---|---|---|---|---|---|---|---|---|---|")
    all_lidar, all_image = Seen(), Seen()
    for name, each in run_all(options, "calibrate.json", patches).items():
        lidar, image = Seen(), Seen()
        for result in (files["result"] for files in each):
            boards = {s["name"]: s["boards"] for s in result["scenes"]}
            for scene, metrics in result["metrics_per_scene"].items():
                for seen in (lidar, all_lidar):
                    seen.add(metrics, boards.get(scene, []), "lidar")
                for seen in (image, all_image):
                    seen.add(metrics, boards.get(scene, []), "image")
        print(row(name, lidar, image))
    print(row(f"all, {all_lidar.scenes} captures", all_lidar, all_image))


if __name__ == "__main__":
    main()
