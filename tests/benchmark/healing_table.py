#!/usr/bin/env python3
"""Two simulated visits of one foot, compared, beside the truth.

Usage: healing_table.py SCRATCH --bin FOLDER [--poses N] [--frames N]
For each foot: first visits, and later ones posed otherwise whose ulcer shrank by half, lost 20 % of
its area and 30 % of its volume, or did not change. Prints residual of the skin, error of the wound's
middle against the true pose, error of the changes in points, and what was called changed wrongly.
"""
import argparse
import json
import math
import pathlib
import subprocess

FEET = ("forefoot", "heel", "lateral", "two")
KINDS = {
    "half": ["--area-factor", "0.5", "--depth-factor", "0.7"],
    "less": ["--area-factor", "0.8", "--depth-factor", "0.875"],
    "same": [],
}


def times(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(4)) for j in range(4)] for i in range(4)]


def inverse(a):
    turned = [[a[j][i] for j in range(3)] for i in range(3)]
    back = [-sum(turned[i][k] * a[k][3] for k in range(3)) for i in range(3)]
    return [turned[i] + [back[i]] for i in range(3)] + [[0, 0, 0, 1]]


def moved(a, p):
    return [sum(a[i][k] * p[k] for k in range(3)) + a[i][3] for i in range(3)]


class Visit:
    def __init__(self, tool, folder, foot, seed, frames, options):
        self.folder = folder
        if not (folder / "model.ply").exists():
            scan = str(folder / "scan")
            subprocess.run([tool, "simulate", scan, "--foot", foot, "--frames", str(frames), "--seed",
                            str(seed), "--quiet", *options], check=True)
            subprocess.run([tool, "reconstruct", scan, str(folder), "--no-texture", "--quiet"],
                           check=True)
            subprocess.run(["rm", "-rf", scan + "/rgb", scan + "/depth"], check=True)
        self.truth = json.loads((folder / "scan/truth/truth.json").read_text())
        self.wound = self.truth["wounds"][0]

    def point(self, key):
        return ",".join(f"{x:.3f}" for x in self.truth[key])


def compare(tool, first, later, out):
    outline = "scan/truth/outline_1.json"
    done = subprocess.run(
        [tool, "compare", first.folder / "model.ply", first.folder / outline,
         later.folder / "model.ply", later.folder / outline, "--days", "28",
         "--heel-a", first.point("heel_mm"), "--toe-a", first.point("toe_mm"),
         "--heel-b", later.point("heel_mm"), "--toe-b", later.point("toe_mm"),
         "--quiet", "--json", out], capture_output=True, text=True)
    if done.returncode != 0:
        return None, done.stderr.strip()
    return json.loads(out.read_text()), ""


def row_of(first, later, result):
    true = times(later.truth["scan_from_foot"], inverse(first.truth["scan_from_foot"]))
    middle = first.wound["center_mm"]
    trace = true[0][0] + true[1][1] + true[2][2]
    row = {"turn": math.degrees(math.acos(max(-1.0, min(1.0, (trace - 1.0) / 2.0)))),
           "shift": math.dist(moved(true, middle), middle),
           "accepted": result["accepted"], "rms": result["rms_residual_mm"]}
    if result["b_from_a"]:
        row["off"] = math.dist(moved(result["b_from_a"], middle), moved(true, middle))
    for name, key in (("area", "opening_area_mm2"), ("volume", "volume_mm3")):
        found = result[name + "_change_percent"]
        if found is not None:
            row[name] = found - 100.0 * (later.wound[key] / first.wound[key] - 1.0)
    row["changed"] = [name for name, change in result["changes"].items() if change["detectable"]]
    return row


def span(rows, key):
    values = [row[key] for row in rows if row.get(key) is not None]
    return f"{min(values):+.2f} .. {max(values):+.2f}" if values else "-"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("scratch", type=pathlib.Path)
    parser.add_argument("--bin", required=True, type=pathlib.Path)
    parser.add_argument("--poses", type=int, default=6)
    parser.add_argument("--frames", type=int, default=400)
    arguments = parser.parse_args()
    tool = str(arguments.bin / "tarsus-cli")
    print("| visits | compared | accepted | turn, shift of the foot | skin residual mm | middle off mm "
          "| area off, points | volume off, points | changed wrongly |\n|---|---|---|---|---|---|---|---|---|")
    for kind, options in KINDS.items():
        rows, troubles = [], []
        for foot in FEET:
            first = Visit(tool, arguments.scratch / f"{foot}-first", foot, 31, arguments.frames, [])
            for pose in range(1, arguments.poses + 1):
                later = Visit(tool, arguments.scratch / f"{foot}-{kind}-{pose}", foot, 200 + pose,
                              arguments.frames, options + ["--posed", str(pose)])
                result, trouble = compare(tool, first, later, arguments.scratch / "compared.json")
                if result is None:
                    troubles.append(f"{foot} {kind} {pose}: {trouble}")
                else:
                    rows.append(row_of(first, later, result))
        wrong = sum(bool(row["changed"]) for row in rows) if kind == "same" else "-"
        print(f"| {kind} | {len(rows)} | {sum(row['accepted'] for row in rows)} "
              f"| {max(r['turn'] for r in rows):.0f} deg, {max(r['shift'] for r in rows):.0f} mm "
              f"| {span(rows, 'rms')} | {span(rows, 'off')} | {span(rows, 'area')} "
              f"| {span(rows, 'volume')} | {wrong} |", flush=True)
        for trouble in troubles:
            print("  not compared:", trouble)


if __name__ == "__main__":
    main()
