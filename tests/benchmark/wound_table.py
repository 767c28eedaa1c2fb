#!/usr/bin/env python3
"""Measured wounds beside their truth, and how much the values of repeated scans scatter.

usage: wound_table.py --bin DIR FOLDER...
Each FOLDER is named FOOT-SEED and holds model.ply and truth/ of `tarsus-cli simulate`."""

import argparse
import json
import pathlib
import statistics
import subprocess

SHOWN = [
    ("opening_area_mm2", "area mm2"),
    ("bed_area_mm2", "bed mm2"),
    ("perimeter_mm", "perimeter mm"),
    ("volume_mm3", "volume mm3"),
    ("max_depth_mm", "max depth mm"),
    ("p99_depth_mm", "p99 depth mm"),
]
SCATTER = ["opening_area_mm2", "volume_mm3", "p99_depth_mm"]


def measure(program, folder, number):
    outline = folder / "truth" / f"outline_{number}.json"
    ran = subprocess.run(
        [program, "measure", folder / "model.ply", "--outline", outline, "--json", "-", "--quiet"],
        capture_output=True, text=True, check=False)
    return json.loads(ran.stdout)


def row(name, values, truth):
    cells = []
    for key, _ in SHOWN:
        if key in truth:
            off = values[key] - truth[key]
            as_percent = "depth" not in key
            cells.append(f"{100.0 * off / truth[key]:+6.1f} %" if as_percent else f"{off:+8.2f}")
        else:
            cells.append(f"{values[key]:8.2f}")
    print(f"{name:<22}" + " ".join(f"{c:>13}" for c in cells))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--bin", type=pathlib.Path, required=True)
    parser.add_argument("folders", type=pathlib.Path, nargs="+")
    arguments = parser.parse_args()
    print("measured with the true outline; area, perimeter and volume: difference from the truth in "
          "per cent, depth: in mm (p99: the value, where the truth has none)")
    print(f"{'foot, seed, wound':<22}" + " ".join(f"{title:>13}" for _, title in SHOWN))
    scatter = {}
    for folder in sorted(arguments.folders):
        truth = json.loads((folder / "truth" / "truth.json").read_text())
        for number, wound in enumerate(truth["wounds"], 1):
            values = measure(arguments.bin / "tarsus-cli", folder, number)
            name = f"{folder.name} {number}"
            if "error" in values:
                print(f"{name:<22} {values['error']['message']}")
                continue
            row(name, values, wound)
            foot = f"{folder.name.rsplit('-', 1)[0]} {number}"
            scatter.setdefault(foot, []).append(([values[k] for k in SCATTER], [wound.get(k) for k in SCATTER]))
    print(f"\n{'repeated scans':<22}" + " ".join(f"{k.rsplit('_', 1)[0]:>26}" for k in SCATTER))
    for foot, rows in scatter.items():
        cells = []
        for i in range(len(SCATTER)):
            values = [measured[i] for measured, _ in rows]
            truth = rows[0][1][i]
            mean = statistics.fmean(values)
            spread = 100.0 * statistics.stdev(values) / mean if len(values) > 1 else 0.0
            off = f"mean {100.0 * (mean / truth - 1.0):+5.1f} %, " if truth else ""
            cells.append(f"{off}CV {spread:4.1f} %")
        print(f"{foot + ', ' + str(len(rows)):<22}" + " ".join(f"{c:>26}" for c in cells))
    print("must: area 2 %, volume 5 %; coefficient of variation 1.5 %, 4 %, 4 %")


main()
