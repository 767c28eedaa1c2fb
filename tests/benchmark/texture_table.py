#!/usr/bin/python3
"""Runs tarsus-bench-texture and Open3D's colour map optimisers on the same mesh, keyframes and
poses, and prints what issue 4 asks for beside what was measured:
    texture_table.py foot SCAN MODEL --bin DIR [--no-open3d] [--rigid 40] [--non-rigid 10]
    texture_table.py bust SCAN --bin DIR
"""
import argparse
import json
import os
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
FULL_ITERATIONS = 40  # of each kind, as the table of the issue counts them


def run(command):
    """Its lines go on to ours; waiting threads do not spin, so that both programs can share."""
    sys.stdout.flush()
    subprocess.run(command, check=True, env=dict(os.environ, OMP_WAIT_POLICY="passive"))


def read(path):
    with open(path) as file:
        return json.load(file)


class Rows:
    """Figures of the rows that tarsus-bench-texture printed, by poses and method."""

    def __init__(self, rows):
        self.rows = {(row["poses"], row["method"]): row for row in rows}

    def get(self, poses, method, key):
        return self.rows.get((poses, method), {}).get(key)

    def best_open3d(self, poses):
        found = [row["psnr_clean_db"] for (where, method), row in self.rows.items()
                 if where == poses and method.startswith("open3d")]
        return max(found) if found else None


def line(what, must, measured):
    print("  %-66s %-16s %s" % (what, must, measured))


def number(value, pattern="%.2f"):
    return "-" if value is None else pattern % value


def ratio(above, below, pattern="%.2f x"):
    return "-" if not above or not below else pattern % (above / below)


def print_speed(rows, open3d):
    """Time for one vertex observation and iteration, ours and theirs."""
    for kind in ("rigid", "non_rigid"):
        theirs = open3d.get("open3d_" + kind)
        if not theirs:
            continue
        theirs_ns = 1e9 * theirs["seconds_per_iteration"] / theirs["observations"]
        seconds = rows.get("off", "aligned", kind + "_seconds")
        iterations = rows.get("off", "aligned", kind + "_iterations")
        seen = rows.get("off", "aligned", "observations") or rows.get("off", "average", "observations")
        ours_ns = 1e9 * seconds / iterations / seen if seconds and iterations else None
        line("Open3D / Tarsus, time per observation and iteration, %s" % kind.replace("_", "-"),
             ">= 20 x", "%s (%.1f ns / %s; Open3D %.2f s per iteration, %.2fM observations, Tarsus "
             "%.2fM)" % (ratio(theirs_ns, ours_ns, "%.1f x"), theirs_ns, number(ours_ns, "%.1f ns"),
                         theirs["seconds_per_iteration"], theirs["observations"] / 1e6, seen / 1e6))


def print_foot(rows, open3d):
    for name, run in open3d.items():
        print("  %s, poses off: %d iterations, %.0f s in all" % (name, run["iterations"],
                                                                 run["seconds"]))
    line("", "must", "measured")
    seconds = rows.get("off", "aligned", "seconds")
    line("stage with 40 + 40 iterations, 30 keyframes, %s vertices"
         % number(rows.get("off", "aligned", "vertices"), "%d"), "<= 20 s", number(seconds, "%.1f s"))
    print_speed(rows, open3d)
    line("photometric RMSE, aligned / average, poses off", "<= 0.5 x",
         ratio(rows.get("off", "aligned", "photometric_rmse"),
               rows.get("off", "average", "photometric_rmse")))
    for poses, least, more in (("good", 36, 2), ("off", 35, 4)):
        ours = rows.get(poses, "aligned", "psnr_clean_db")
        theirs = rows.best_open3d(poses)
        line("PSNR on views left out, poses %s" % poses, ">= %d dB" % least, number(ours, "%.2f dB"))
        line("  above the best of Open3D's (%s dB)" % number(theirs), ">= %d dB" % more,
             number(ours - theirs if theirs else None, "%+.2f dB"))
    for poses in ("good", "off"):
        line("sharpness: gradient energy, rendered / source frame, poses %s" % poses, ">= 0.8",
             number(rows.get(poses, "aligned", "gradient_to_sensed"), "%.3f"))
        line("  the same / noise-free view; squared Laplacian / noise-free view", "",
             number(rows.get(poses, "aligned", "gradient_to_clean"), "%.3f; ")
             + number(rows.get(poses, "aligned", "laplacian_to_clean"), "%.3f"))
    line("seen vertices without colour", "0",
         number(max(rows.get(poses, "aligned", "seen_without_color") for poses in ("good", "off")),
                "%d"))


def print_bust(rows):
    line("", "must", "measured")
    line("photometric RMSE, aligned / average, poses off", "<= 0.5 x",
         ratio(rows.get("off", "aligned", "photometric_rmse"),
               rows.get("off", "average", "photometric_rmse")))
    for poses in ("good", "off"):
        line("PSNR on sensed views left out, poses %s: average, aligned" % poses, "",
             ", ".join(number(rows.get(poses, method, "psnr_sensed_db"), "%.2f dB")
                       for method in ("average", "aligned")))
    line("seen vertices without colour", "0",
         number(max(rows.get(poses, "aligned", "seen_without_color") for poses in ("good", "off")),
                "%d"))


def bench(args, folder):
    ours = os.path.join(args.bin, "tarsus-bench-texture")
    inputs = [args.scan] + ([args.model] if args.kind == "foot" else [])
    figures = os.path.join(folder, "ours.json")
    more = ["--pictures", args.pictures] if args.pictures else []
    with_open3d = args.kind == "foot" and not args.no_open3d
    task = ["--work", folder] if with_open3d else []
    run([ours, args.kind] + inputs + task + ["--json", figures] + more)
    rows, open3d = read(figures), {}
    if with_open3d:
        colored = []
        for poses in ("good", "off"):
            place = os.path.join(folder, poses)
            subprocess.run(["/usr/bin/python3", os.path.join(HERE, "open3d_color_map.py"), place,
                            "--rigid", str(args.rigid), "--non-rigid", str(args.non_rigid)],
                           check=True, env=dict(os.environ, OMP_WAIT_POLICY="passive"),
                           stdout=subprocess.DEVNULL)
            open3d = read(os.path.join(place, "open3d.json"))
            colored += [os.path.join(place, name + ".ply") for name in open3d]
        run([ours, "evaluate"] + inputs + colored + ["--json", figures] + more)
        rows += read(figures)
        print("Open3D: %d rigid and then %d non-rigid iterations, on both cores"
              % (args.rigid, args.non_rigid))
    return Rows(rows), open3d


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("kind", choices=["foot", "bust"])
    parser.add_argument("scan")
    parser.add_argument("model", nargs="?")
    parser.add_argument("--bin", required=True)
    parser.add_argument("--pictures")
    parser.add_argument("--no-open3d", action="store_true")
    parser.add_argument("--rigid", type=int, default=40)
    parser.add_argument("--non-rigid", type=int, default=10)
    args = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        rows, open3d = bench(args, folder)
    print()
    if args.kind == "foot":
        print_foot(rows, open3d)
    else:
        print_bust(rows)


if __name__ == "__main__":
    main()
