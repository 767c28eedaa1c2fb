#!/usr/bin/python3
"""Open3D's side of `scripts/bench texture`: colours the very mesh that tarsus-bench-texture --work
left, from the same keyframes and poses:
    open3d_color_map.py TASK_DIR [--rigid 40] [--non-rigid 10]
Writes open3d_average.ply (no iteration), open3d_rigid.ply and open3d_non_rigid.ply [mm] beside the
task, and open3d.json with their seconds, the seconds of one iteration and the vertex observations
that Open3D itself counts.

Settings were chosen for Open3D's good:
- depth is that of the mesh, rendered into the colour camera at the pose given, not the sensor's:
  Open3D takes one pose for a pair of pictures, so depth must be registered to colour, and its mask
  of depth edges takes every hole of a sensor for an edge, which leaves hardly a vertex visible;
- thresholds in metres that fit a foot: visible up to 10 mm behind the first surface, a depth edge
  from 50 mm of its unnormalised gradient (12 mm between neighbours; the default 100 mm is meant for
  rooms), to 1.5 m; 10 px off the image's border and 3 neighbours for vertices without a view are
  its defaults;
- 16 anchors down the image, weight 0.316 (defaults), begun from the rigid optimiser's poses, as its
  tutorial does;
- what is made ready before the first iteration (gradients, masks, visibility) and after the last
  one (filling of unseen vertices) is not counted as the iteration's time.
Threads: all cores, waiting passively where the caller sets OMP_WAIT_POLICY so.
"""
import argparse
import json
import os
import re
import sys
import time

import numpy as np
import open3d as o3d

color_map = o3d.pipelines.color_map
SETTINGS = dict(maximum_allowable_depth=1.5, depth_threshold_for_visibility_check=0.01,
                depth_threshold_for_discontinuity_check=0.05, image_boundary_margin=10,
                invisible_vertex_color_knn=3)
MM = 0.001


class Task:
    """The mesh [m], the views and the path of a task folder."""

    def __init__(self, folder):
        self.folder = folder
        with open(os.path.join(folder, "views.json")) as file:
            facts = json.load(file)
        self.mesh = o3d.io.read_triangle_mesh(os.path.join(folder, "mesh.ply"))
        self.mesh.scale(MM, center=(0, 0, 0))
        self.views = [self.view(view, facts["depth_units_per_m"]) for view in facts["views"]]
        pinhole = o3d.camera.PinholeCameraIntrinsic(
            facts["width"], facts["height"], facts["fx"], facts["fy"], facts["cx"], facts["cy"])
        self.path = o3d.camera.PinholeCameraTrajectory()
        self.path.parameters = [self.camera(pinhole, view) for view in facts["views"]]

    def view(self, view, units_per_m):
        color = o3d.io.read_image(os.path.join(self.folder, view["color"]))
        depth = o3d.io.read_image(os.path.join(self.folder, view["depth"]))
        return o3d.geometry.RGBDImage.create_from_color_and_depth(
            color, depth, depth_scale=units_per_m, depth_trunc=3.0, convert_rgb_to_intensity=False)

    @staticmethod
    def camera(pinhole, view):
        camera = o3d.camera.PinholeCameraParameters()
        camera.intrinsic = pinhole
        extrinsic = np.array(view["color_from_scan"])
        extrinsic[:3, 3] *= MM
        camera.extrinsic = extrinsic
        return camera

    def save(self, mesh, name):
        mesh.scale(1 / MM, center=(0, 0, 0))
        o3d.io.write_triangle_mesh(os.path.join(self.folder, name + ".ply"), mesh)


class Clocked:
    """Stands in for sys.stdout: Open3D's log, each line with the time it came."""

    def __init__(self):
        self.lines = []

    def write(self, text):
        self.lines.append((time.perf_counter(), text))

    def flush(self):
        pass

    def time_of(self, words):
        return next(when for when, text in self.lines if words in text)

    def observations(self):
        counts = [re.search(r"\[cam \d+\]: (\d+)/", text) for _, text in self.lines]
        return sum(int(count.group(1)) for count in counts if count)

    def residuals(self):
        found = [re.search(r"Residual error : ([0-9.]+)", text) for _, text in self.lines]
        return [float(match.group(1)) for match in found if match]


def run(task, path, iterations, rigid=True):
    """The coloured mesh, the path after it, and the figures of the run."""
    if rigid:
        optimizer = color_map.run_rigid_optimizer
        options = color_map.RigidOptimizerOption(maximum_iteration=iterations, **SETTINGS)
    else:
        optimizer = color_map.run_non_rigid_optimizer
        options = color_map.NonRigidOptimizerOption(
            number_of_vertical_anchors=16, non_rigid_anchor_point_weight=0.316,
            maximum_iteration=iterations, **SETTINGS)
    log, kept = Clocked(), sys.stdout
    sys.stdout = log
    start = time.perf_counter()
    try:
        mesh, path = optimizer(task.mesh, task.views, path, options)
    finally:
        sys.stdout = kept
    figures = {"seconds": time.perf_counter() - start, "observations": log.observations(),
               "iterations": iterations}
    if iterations:
        iterating = log.time_of("Set Mesh Color") - log.time_of("[Iteration 0001]")
        residuals = log.residuals()
        figures.update(seconds_per_iteration=iterating / iterations,
                       first_residual=residuals[0], last_residual=residuals[-1])
    return mesh, path, figures


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("task")
    parser.add_argument("--rigid", type=int, default=40, help="iterations")
    parser.add_argument("--non-rigid", type=int, default=10, help="iterations after those")
    args = parser.parse_args()
    task = Task(args.task)
    o3d.utility.set_verbosity_level(o3d.utility.VerbosityLevel.Debug)
    figures = {}
    mesh, _, figures["open3d_average"] = run(task, task.path, 0)
    task.save(mesh, "open3d_average")
    mesh, path, figures["open3d_rigid"] = run(task, task.path, args.rigid)
    task.save(mesh, "open3d_rigid")
    mesh, _, figures["open3d_non_rigid"] = run(task, path, args.non_rigid, rigid=False)
    task.save(mesh, "open3d_non_rigid")
    with open(os.path.join(args.task, "open3d.json"), "w") as file:
        json.dump(figures, file, indent=1)
    print(json.dumps(figures))


if __name__ == "__main__":
    main()
