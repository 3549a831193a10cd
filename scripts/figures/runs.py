# SPDX-FileCopyrightText: 2026 the petal authors
# SPDX-License-Identifier: BSD-3-Clause

"""Runs a pipeline over patches and seeds, several at once; what is there already is not run again."""

import argparse
import concurrent.futures
import json
import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]


def arguments(doc, seeds):
    """What every study takes."""
    parser = argparse.ArgumentParser(description=doc,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--petal", default=str(ROOT / "build/bin/petal"))
    parser.add_argument("--seeds", type=int, default=seeds)
    parser.add_argument("--work", type=pathlib.Path, required=True, help="folder for the runs; an "
                        "interrupted study goes on there")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    return parser


def run_one(options, pipeline, patch_file, folder, seed):
    if not (folder / "result.json").exists():
        done = subprocess.run(
            [options.petal, "--quiet", "run", str(ROOT / "pipelines" / pipeline), "--with",
             str(patch_file), "--seed", str(seed), "--threads", "1", "--out", str(folder), "--force"],
            capture_output=True, text=True)
        if done.returncode not in (0, 4):
            raise RuntimeError(f"{folder}: exit {done.returncode}\n{done.stderr}")
    return {file.stem: json.loads(file.read_text()) for file in folder.glob("result*.json")}


def run_all(options, pipeline, patches):
    """For each name in `patches` the results of every seed, in order: {file stem: content}."""
    options.work.mkdir(parents=True, exist_ok=True)
    waiting = {name: [] for name in patches}
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        for name, patch in patches.items():
            file = options.work / f"{name}.patch.json"
            file.write_text(json.dumps(patch))
            for seed in range(1, options.seeds + 1):
                waiting[name].append(pool.submit(run_one, options, pipeline, file,
                                                 options.work / name / str(seed), seed))
        try:
            return {name: [one.result() for one in each] for name, each in waiting.items()}
        except RuntimeError as error:
            pool.shutdown(cancel_futures=True)
            sys.exit(str(error))
