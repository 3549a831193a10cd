#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 the petal authors
# SPDX-License-Identifier: BSD-3-Clause
"""Makes docs/capture_placements.jpg: four placements of the board, simulated, the points over the photos.

    scripts/figures/capture.py --petal build/bin/petal --work FOLDER [--out docs/capture_placements.jpg]

The pictures of the run are put together by a headless Chromium (Debian's package chromium).
"""
import argparse
import base64
import json
import pathlib
import re
import subprocess

ROOT = pathlib.Path(__file__).resolve().parents[2]
NAMES = ["near", "left_up", "right_down", "far"]
WIDTH, HEIGHT = 480, 285  # px, of each


def simulate(petal, work):
    patch = work / "scene.json"
    patch.write_text(json.dumps({"petal": 1, "stages": {"scene": {
        "type": "source.simulator",
        "params": {"scenes": ["set_four_diverse"], "duration": 5.0}}}}))
    pipelines = ROOT / "pipelines"
    subprocess.run([petal, "run", pipelines / "calibrate.json", "--with", pipelines / "variants/pictures.json",
                    "--with", patch, "--set", "projection.max_points=60000", "--set",
                    "colored_cloud.formats=[\"ply\"]", "--seed", "3", "--out", work / "run", "--force"],
                   check=False)  # exit code 4 tells the verdict, which is no matter here
    pictures = sorted((work / "run/projection").glob("*.png"))
    return [next(p for p in pictures if name in p.name) for name in NAMES]


def montage(pictures, work):
    page = work / "montage.html"
    images = "".join(f'<img src="data:image/png;base64,{base64.b64encode(p.read_bytes()).decode()}">' for p in pictures)
    page.write_text(f"""<body>{images}<script>
addEventListener('load', () => {{
  const canvas = document.createElement('canvas');
  canvas.width = {2 * WIDTH}; canvas.height = {2 * HEIGHT};
  const draw = canvas.getContext('2d');
  document.querySelectorAll('img').forEach((image, i) =>
    draw.drawImage(image, i % 2 * {WIDTH}, Math.floor(i / 2) * {HEIGHT}, {WIDTH}, {HEIGHT}));
  document.body.textContent = canvas.toDataURL('image/jpeg', 0.6);
}});
</script></body>""")
    dom = subprocess.run(["chromium", "--headless", "--no-sandbox", "--disable-gpu", "--dump-dom", page.resolve().as_uri()],
                         check=True, capture_output=True, text=True).stdout
    return base64.b64decode(re.search(r"data:image/jpeg;base64,([^<]+)", dom).group(1))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--petal", required=True)
    parser.add_argument("--work", required=True, type=pathlib.Path)
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "docs/capture_placements.jpg")
    options = parser.parse_args()
    options.work.mkdir(parents=True, exist_ok=True)
    options.out.write_bytes(montage(simulate(options.petal, options.work), options.work))


if __name__ == "__main__":
    main()
