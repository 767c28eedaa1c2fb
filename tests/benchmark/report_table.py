#!/usr/bin/env python3
"""The report of a wound with many visits, out of the records: time, and the same bytes again.

Usage: report_table.py SCRATCH --bin FOLDER [--visits N]
The visits are weekly ones of the simulator's healing forefoot; their models are its true surfaces.
"""
import argparse
import hashlib
import json
import os
import pathlib
import statistics
import subprocess
import time


class Records:
    """tarsus-cli on one store, as one user."""

    def __init__(self, tool, folder):
        self.tool, self.folder = tool, folder
        for name in ("anna", "nina", "paul"):
            (folder / name).write_text(f"a password of {name}\n")
        self.user = "anna"
        self("store", "create")
        for name, role in (("nina", "nurse"), ("paul", "physician")):
            self("user", "add", name, "--role", role, "--new-password-file", folder / name)
        self.user = "nina"

    def __call__(self, *words, **environment):
        command = [self.tool, *words, "--store", self.folder / "records", "--user", self.user,
                   "--password-file", self.folder / self.user, "--quiet", "--json", "-"]
        done = subprocess.run([str(word) for word in command], capture_output=True, text=True,
                              env={**os.environ, **environment})
        if done.returncode != 0:
            raise SystemExit(f"{' '.join(map(str, words))}: {done.stderr or done.stdout}")
        return json.loads(done.stdout) if done.stdout.strip() else {}


def add_visits(records, tool, scratch, visits):
    patient = records("patient", "add", "--family", "Example", "--given", "Erika", "--born",
                      "1953-04-12", "--identifier", "DEMO-1")["id"]
    foot = records("patient", "foot", patient, "--side", "right")["id"]
    wound = records("wound", "add", foot, "--place", "mth_2", "--aspect", "plantar", "--onset",
                    "2026-01-02")["id"]
    for week in range(visits):
        scan = scratch / f"week-{week}"
        subprocess.run([tool, "simulate", scan, "--frames", "1", "--healing", "shrinking", "--week",
                        str(week), "--quiet"], check=True)
        truth = json.loads((scan / "truth/truth.json").read_text())
        points = [",".join(f"{x:.3f}" for x in truth[key]) for key in ("heel_mm", "toe_mm")]
        day = time.strftime("%Y-%m-%dT09:30", time.gmtime(1767780000 + week * 7 * 86400))
        visit = records("visit", "add", wound, "--at", day)["id"]
        records("visit", "measure", visit, scan / "truth/mesh.ply", "--outline",
                scan / "truth/outline_1.json", "--heel", points[0], "--toe", points[1])
        records("visit", "sign", visit)
    return visit


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("scratch", type=pathlib.Path)
    parser.add_argument("--bin", required=True, type=pathlib.Path)
    parser.add_argument("--visits", type=int, default=12)
    arguments = parser.parse_args()
    arguments.scratch.mkdir(parents=True, exist_ok=True)
    tool = arguments.bin / "tarsus-cli"
    records = Records(tool, arguments.scratch)
    last = add_visits(records, tool, arguments.scratch, arguments.visits)
    seconds, sums = [], []
    runs = [("nina", {}), ("nina", {"TZ": "Asia/Tokyo", "LANG": "de_DE.UTF-8"}), ("paul", {}),
            ("nina", {"SOURCE_DATE_EPOCH": "1999999999", "HOME": str(arguments.scratch)})]
    for records.user, environment in runs:
        before = time.monotonic()
        out = arguments.scratch / "report.pdf"
        records("visit", "report", last, out, **environment)
        seconds.append(time.monotonic() - before)
        sums.append(hashlib.sha256(out.read_bytes()).hexdigest())
    print(f"report of {arguments.visits} visits: median {statistics.median(seconds):.2f} s "
          f"(sign-in included), {out.stat().st_size / 1e6:.1f} MB; must: 3 s")
    print(f"made {len(runs)} times, by two users, in another zone and language, on another day: "
          f"{'the same bytes' if len(set(sums)) == 1 else 'NOT the same bytes'}")


if __name__ == "__main__":
    main()
