#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 the petal authors
# SPDX-License-Identifier: BSD-3-Clause

"""Prints what petal compare wrote as the tables of docs/compare_runs.md:

    petal compare pipelines/compare/solvers.json --out DIR
    scripts/figures/compare_tables.py DIR/compare.json
"""

import json
import sys


def interval(figure, sign=""):
    if figure is None:
        return "none"

    def text(value):
        return value if isinstance(value, str) else f"{value:{sign}.3g}"
    return f"{text(figure['value'])} [{text(figure['low'])}, {text(figure['high'])}]"


def rows(metric):
    about = metric["name"] + (f" ({metric['unit']})" if metric.get("unit") else "")
    if metric["better"] != "none":
        about += f", {metric['better']}; margin {metric['margin']:g}"
    for variant, seen in metric["variants"].items():
        failed = f"{seen['failed'] + seen['missing']} of {seen['units']}"
        line = f"| {about} | {variant} | {failed} | {interval(seen['median'])} |"
        other = seen.get("to_reference")
        if other is None:
            yield line + " | | | reference |"
        else:
            yield (f"{line} {interval(other['median_difference'], '+')} | {100 * other['win_share']:.0f} % | "
                   f"{other['p_holm']:.2g} | {other['verdict']} |")
        about = ""


def main():
    comparison = json.load(open(sys.argv[1], encoding="utf-8"))
    print("| metric | variant | without a value | median [95 %] | median difference [95 %] | wins | p (Holm) | verdict |")
    print("|---|---|---|---|---|---|---|---|")
    for metric in comparison["metrics"]:
        for line in rows(metric):
            print(line)


if __name__ == "__main__":
    main()
