#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 the petal authors
# SPDX-License-Identifier: BSD-3-Clause

"""How well the pose from all boards but one puts that one into the photo: the letter's indoor scene, with
each choice of detectors. Prints the table of docs/lidar_template.md. For example:

    scripts/figures/leave_one_board_out.py --data ../shared/data/sjtu_indoor --work /tmp/left_out
"""

import argparse
import json
import math
import pathlib
import re
import subprocess

from runs import ROOT

VARIANTS = {
    "board_lines, image_contours (the letter's)": [],
    "lidar_template, image_contours": ["lidar_template"],
    "board_lines, image_template": ["image_template"],
    "both templates": ["lidar_template", "image_template"],
}


class Camera:
    """A pinhole camera with OpenCV's plumb-bob distortion, from its YAML."""

    def __init__(self, file):
        text = file.read_text()

        def numbers(name):
            data = re.search(name + r":.*?data: \[(.*?)\]", text, re.S).group(1)
            return [float(x) for x in data.split(",")]
        self.k = numbers("CameraMat")
        self.d = numbers("DistCoeff") + [0.0] * 5

    def project(self, pose, point):
        q = [sum(pose[i][j] * point[j] for j in range(3)) + pose[i][3] for i in range(3)]
        x, y = q[0] / q[2], q[1] / q[2]
        k1, k2, p1, p2, k3 = self.d[:5]
        r2 = x * x + y * y
        radial = 1 + k1 * r2 + k2 * r2 ** 2 + k3 * r2 ** 3
        u = x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x)
        v = y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y
        return self.k[0] * u + self.k[2], self.k[4] * v + self.k[5]

    def squares(self, pose, board):
        """The squared distances of a board's corners from where the pose puts them, px^2."""
        for point, seen in zip(*board):
            u, v = self.project(pose, point)
            yield (u - seen[0]) ** 2 + (v - seen[1]) ** 2


def rms(squares):
    squares = list(squares)
    return math.sqrt(sum(squares) / len(squares))


def run(options, pipeline, out, *arguments):
    command = [options.petal, "--quiet", "run", str(ROOT / "pipelines" / pipeline), "--data",
               str(options.data), "--out", str(out), "--force", *arguments]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode not in (0, 4):
        raise SystemExit(f"{' '.join(command)}: exit {done.returncode}\n{done.stderr}")
    return json.loads((out / "result.json").read_text())


def pose_of(options, boards, work):
    pairs = work / "pairs.csv"
    pairs.write_text("".join(",".join(f"{x:.9f}" for x in point + seen) + "\n"
                             for board in boards for point, seen in zip(*board)))
    result = run(options, "pairs.json", work / "pose", "--set", f'pairs.pairs="{pairs}"', "--set",
                 'pairs.distortion_model="auto"', "--set", 'pairs.corner_order="rows"')
    return result["extrinsics"][0]["T_camera_lidar"]


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--petal", default=str(ROOT / "build/bin/petal"))
    parser.add_argument("--data", type=pathlib.Path, required=True, help="sjtu_indoor")
    parser.add_argument("--work", type=pathlib.Path, required=True, help="folder for the runs")
    options = parser.parse_args()
    options.work.mkdir(parents=True, exist_ok=True)
    options.data, options.work = options.data.resolve(), options.work.resolve()
    camera = Camera(options.data / "intrinsics.yaml")
    print("| detectors | boards | all, RMS px | each left out, px | RMS px |")
    print("|---|---|---|---|---|")
    for name, variants in VARIANTS.items():
        patches = [part for variant in variants
                   for part in ("--with", str(ROOT / f"pipelines/variants/{variant}.json"))]
        result = run(options, "letter_indoor.json", options.work / "all", *patches)
        boards = [(b["corners_lidar"], b["corners_image"]) for scene in result["scenes"]
                  for b in scene["boards"] if b["corners_lidar"] and b["corners_image"]]
        every = result["extrinsics"][0]["T_camera_lidar"]
        left_out = [list(camera.squares(pose_of(options, boards[:k] + boards[k + 1:], options.work),
                                        boards[k])) for k in range(len(boards))]
        print(f"| {name} | {len(boards)} | {rms(s for b in boards for s in camera.squares(every, b)):.2f} | "
              f"{', '.join(f'{rms(b):.2f}' for b in left_out)} | {rms(s for b in left_out for s in b):.2f} |")


if __name__ == "__main__":
    main()
