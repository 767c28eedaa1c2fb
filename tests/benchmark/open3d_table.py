#!/usr/bin/python3
"""Runs Tarsus and Open3D in turns on the same frames and prints their figures and ratios:
    open3d_table.py SCAN --bin DIR [--truth mesh.ply] [--frames 150] [--runs 3] [--far-mm 700]
"""
import argparse
import collections
import json
import os
import statistics
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
Row = collections.namedtuple("Row", "name program arguments")
Table = collections.namedtuple("Table", "title rows")


def tables(tracking_only):
    fine = ["--voxel-mm", "1", "--delta-mm", "6"]
    coarse = ["--voxel-mm", "2", "--delta-mm", "9"]
    integration = [
        Table("integration, 1 mm, band 6 mm, depth", pair("integrate", fine)),
        Table("integration, 1 mm, band 6 mm, depth and colour", pair("integrate", fine + ["--color"])),
        Table("integration, 2 mm, band 9 mm, depth", pair("integrate", coarse))]
    tracking = Table("tracking and integration, 2 mm, band 9 mm, depth fused", [
        Row("Tarsus, ScanTracker", "tarsus", ["stream", "--voxel-mm", "2"]),
        Row("Open3D, RGB-D odometry", "open3d", ["odometry"] + coarse),
        Row("Open3D, the same at half resolution", "open3d", ["odometry", "--step", "2"] + coarse),
        Row("Open3D, frame to model, half resolution", "open3d", ["model"] + coarse)])
    return ([] if tracking_only else integration) + [tracking]


def pair(task, arguments):
    return [Row("Tarsus, TsdfVolume", "tarsus", [task] + arguments),
            Row("Open3D, VoxelBlockGrid", "open3d", [task] + arguments)]


def call(command, cores):
    """The program's figures. Bound to so many cores, OpenMP and TBB start as many threads."""
    environment = dict(os.environ, OMP_NUM_THREADS=str(cores), OMP_WAIT_POLICY="passive")
    done = subprocess.run(["taskset", "-c", "0-%d" % (cores - 1)] + command, env=environment,
                          stdout=subprocess.PIPE)
    if not done.stdout:
        raise SystemExit("failed: " + " ".join(command))
    return json.loads(done.stdout.decode().strip().splitlines()[-1])


class Bench:
    def __init__(self, args):
        self.args = args
        self.ours = os.path.join(args.bin, "tarsus-bench-frames")
        self.common = ["--frames", str(args.frames), "--far-mm", str(args.far_mm)]

    def command(self, row, mesh):
        task, rest = row.arguments[0], row.arguments[1:]
        if row.program == "tarsus":
            start = [self.ours, task, self.args.scan]
        else:
            start = ["/usr/bin/python3", os.path.join(HERE, "open3d_side.py"), self.args.scan, task]
        return start + rest + self.common + (["--mesh", mesh] if mesh else [])

    def measure(self, table, folder):
        """Rows in turns, so that a busy minute meets all of them."""
        runs = [collections.defaultdict(list) for _ in table.rows]
        for turn in range(self.args.runs):
            for threads in (1, max(2, os.cpu_count())):
                for number, row in enumerate(table.rows):
                    mesh = os.path.join(folder, "%d.ply" % number) \
                        if self.args.truth and turn == 0 and threads == 1 else None
                    result = call(self.command(row, mesh), threads)
                    runs[number]["processor_ms"] += [result["cpu_ms"]] if threads == 1 else []
                    runs[number]["wall_ms"] += [result["wall_ms"]] if threads > 1 else []
                    for key in ("touched_voxels", "work_mb", "trajectory_rmse_mm"):
                        runs[number][key].append(result.get(key, 0.0))
                    if mesh and os.path.exists(mesh):
                        compared = call([self.ours, "compare", mesh, self.args.truth], 1)
                        runs[number]["model_rms_mm"] = [compared["model_rms_mm"]]
        return [{key: statistics.median(values) for key, values in run.items()} for run in runs]


HEAD = ("%-42s %12s %7s %9s %9s %9s %9s %11s %9s"
        % ("", "1 thread", "ratio", "all cores", "ratio", "Mvoxel/s", "memory", "trajectory", "model"))
UNITS = ("%-42s %12s %7s %9s %9s %9s %9s %11s %9s"
         % ("", "ms processor", "", "ms wall", "", "1 thread", "MB", "RMSE mm", "RMS mm"))


def cell(value, pattern):
    return pattern % value if value else "-"


def print_table(table, rows):
    print(table.title)
    first = rows[0]
    for row, figures in zip(table.rows, rows):
        # Voxels of the blocks that a frame touches; each program has its own choice of blocks.
        alone = row.arguments[0] == "integrate"
        voxels = alone * figures["touched_voxels"] / figures["processor_ms"] / 1000
        print("  %-40s %12.2f %6.2fx %9.2f %8.2fx %9s %9.0f %11s %9s" % (
            row.name, figures["processor_ms"], figures["processor_ms"] / first["processor_ms"],
            figures["wall_ms"], figures["wall_ms"] / first["wall_ms"], cell(voxels, "%.0f"),
            figures["work_mb"], cell(figures["trajectory_rmse_mm"], "%.2f"),
            cell(figures.get("model_rms_mm"), "%.3f")))
    for row, figures in list(zip(table.rows, rows))[1:]:
        ratios = [(name, figures.get(key) / first.get(key)) for name, key in
                  (("memory", "work_mb"), ("trajectory error", "trajectory_rmse_mm"),
                   ("model error", "model_rms_mm")) if first.get(key) and figures.get(key)]
        print("    to Tarsus, %s: %s" % (row.name, ", ".join("%s %.1fx" % r for r in ratios)))
    sys.stdout.flush()


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("scan")
    parser.add_argument("--bin", required=True)
    parser.add_argument("--truth")
    parser.add_argument("--frames", type=int, default=150)
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--far-mm", type=float, default=700)
    parser.add_argument("--tracking-only", action="store_true")
    args = parser.parse_args()
    print("first %d frames, decoded before; depth to %.0f mm; each figure for one frame; median of "
          "%d runs; load %.2f" % (args.frames, args.far_mm, args.runs, os.getloadavg()[0]))
    print(HEAD)
    print(UNITS)
    bench = Bench(args)
    with tempfile.TemporaryDirectory() as folder:
        for table in tables(args.tracking_only):
            print_table(table, bench.measure(table, folder))
    print("load at the end %.2f" % os.getloadavg()[0])


if __name__ == "__main__":
    main()
