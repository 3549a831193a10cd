#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 the petal authors
# SPDX-License-Identifier: BSD-3-Clause

"""Does what a page of the documentation tells its reader to do: writes its files and runs its commands, in their order, in
an empty folder in which `build`, `pipelines` and `datasets` are those of the source tree.

    run_page.py PAGE SOURCE_FOLDER BUILD_FOLDER

A block "```sh" is run by bash and must exit with 0, "```sh exit=4" with 4; a block "```cpp file=NAME" (of any language) is
written to NAME; other blocks are for reading only. A page without a command is an error."""

import os
import pathlib
import re
import subprocess
import sys
import tempfile

BLOCK = re.compile(r"^```(\w+)((?: \w+=\S+)*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def blocks(text):
    """(language, {key: value}, content) of each fenced block."""
    for match in BLOCK.finditer(text):
        yield match[1], dict(word.split("=", 1) for word in match[2].split()), match[3]


def run(script, expected, folder):
    done = subprocess.run(["bash", "-euo", "pipefail", "-c", script], cwd=folder, text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          env={**os.environ, "HOME": str(folder)})
    if done.returncode != expected:
        sys.exit(f"{script}\n{done.stdout}\nexit {done.returncode}, the page says {expected}")


def main():
    page, source, build = (pathlib.Path(argument).resolve() for argument in sys.argv[1:4])
    commands = 0
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "build").symlink_to(build)
        for each in ("pipelines", "datasets"):
            (folder / each).symlink_to(source / each)
        for language, options, content in blocks(page.read_text()):
            if "file" in options:
                file = folder / options["file"]
                file.parent.mkdir(parents=True, exist_ok=True)
                file.write_text(content)
            elif language == "sh":
                commands += 1
                run(content, int(options.get("exit", 0)), folder)
    if commands == 0:
        sys.exit(f"{page} has no command to run")


if __name__ == "__main__":
    main()
