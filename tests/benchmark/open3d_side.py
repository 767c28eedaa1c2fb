#!/usr/bin/python3
"""Open3D's side of `scripts/bench open3d`: the same frames, voxel size, band and depth limit as
tarsus-bench-frames, and the same line of JSON. Frames are decoded before the clock starts, and what
a tracker can make ready for a frame alone (grey images, vertex maps) is not timed either.

Debian's Open3D 0.16 is built without IPP, so on the CPU the filters of its tensor images fail, and
with them rgbd_odometry_multi_scale and the dense SLAM of slam.Model. What runs, all of it here:
  integrate  t.geometry.VoxelBlockGrid with the given true poses
  odometry   pipelines.odometry.compute_rgbd_odometry frame to frame, then VoxelBlockGrid
  model      what dense SLAM does inside, from parts that run: ray_cast of the VoxelBlockGrid and
             compute_odometry_result_point_to_plane against it, then VoxelBlockGrid

Settings were chosen for Open3D's good, by trial on the simulated forefoot:
- blocks of 8^3 (16^3 touches twice the voxels), float32, room for all blocks from the start
  (growing costs); threads that wait passively, set by the caller: the default, spinning, is up to
  six times slower as soon as another program runs;
- half a pixel on the principal point for integration, which rounds pixels down (at 2 mm the error
  of the surface falls from 0.66 to 0.50 mm);
- odometry: the hybrid term (colour alone drifts more); 10, 5, 3 iterations (the default 20, 10, 5
  takes a third longer and is no better); depth to 1.5 m (the room behind the foot holds the pose;
  cut behind the foot, odometry is faster by a third and drifts five times as much);
- model: half resolution (full: three times slower, no better), constant velocity, Huber at 5 mm,
  and half a voxel taken off the ray cast, which is biased by that much and drifts without it.
"""
import argparse
import json
import os
import resource
import time

import numpy as np
import open3d as o3d

core = o3d.core
odometry = o3d.t.pipelines.odometry
legacy = o3d.pipelines.odometry
BLOCK_SIDE = 8


class Scan:
    """A scan folder (design: TUM layout, depth and colour of one size and place) in memory."""

    def __init__(self, folder, frames, with_color):
        with open(os.path.join(folder, "camera.json")) as file:
            camera = json.load(file)
        self.scale = camera["depth_scale"]
        pinhole = camera["depth"]
        self.width, self.height = pinhole["width"], pinhole["height"]
        self.intrinsics = np.array([[pinhole["fx"], 0, pinhole["cx"]],
                                    [0, pinhole["fy"], pinhole["cy"]], [0, 0, 1.0]])
        lines = self.table(os.path.join(folder, "associations.txt"))[:frames]
        self.depth = [o3d.t.io.read_image(os.path.join(folder, line[3])) for line in lines]
        self.color = [o3d.t.io.read_image(os.path.join(folder, line[1])) for line in lines] \
            if with_color else []
        truth = np.array(self.table(os.path.join(folder, "groundtruth.txt")), dtype=float)
        nearest = [np.argmin(np.abs(truth[:, 0] - float(line[2]))) for line in lines]
        self.poses = [pose_matrix(truth[i]) for i in nearest]

    @staticmethod
    def table(path):
        with open(path) as file:
            return [line.split() for line in file if line.strip() and not line.startswith("#")]

    def metres(self, i, far_m, step):
        depth = self.depth[i].as_tensor().numpy()[::step, ::step, 0].astype(np.float32) / self.scale
        return np.where(depth < far_m, depth, 0).astype(np.float32)


def pose_matrix(row):
    x, y, z, w = row[4:8]
    pose = np.eye(4)
    pose[:3, :3] = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                    [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                    [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
    pose[:3, 3] = row[1:4]
    return pose


class Volume:
    """VoxelBlockGrid with the settings of one run."""

    def __init__(self, scan, args):
        self.scan, self.args = scan, args
        rounded_down = scan.intrinsics + np.array([[0, 0, 0.5], [0, 0, 0.5], [0, 0, 0]])
        self.intrinsics = core.Tensor(rounded_down)
        self.multiplier = args.delta_mm / args.voxel_mm
        self.grid = self.new_grid(1000)
        seen = [self.blocks_of(i, scan.poses[i]).cpu().numpy()
                for i in range(0, len(scan.depth), 5)]
        needed = len(np.unique(np.concatenate(seen), axis=0))
        self.touched = BLOCK_SIDE ** 3 * float(np.mean([len(s) for s in seen]))
        self.grid = self.new_grid(int(1.3 * needed))

    def new_grid(self, capacity):
        names, channels = ("tsdf", "weight"), ((1), (1))
        if self.args.color:
            names, channels = names + ("color",), channels + ((3),)
        return o3d.t.geometry.VoxelBlockGrid(names, (core.float32,) * len(names), channels,
                                             self.args.voxel_mm / 1000, BLOCK_SIDE, capacity,
                                             core.Device("CPU:0"))

    def blocks_of(self, i, pose):
        return self.grid.compute_unique_block_coordinates(
            self.scan.depth[i], self.intrinsics, core.Tensor(np.linalg.inv(pose)),
            self.scan.scale, self.args.far_mm / 1000, self.multiplier)

    def integrate(self, i, pose):
        blocks = self.blocks_of(i, pose)
        images = (self.scan.depth[i],) + ((self.scan.color[i],) if self.args.color else ())
        self.grid.integrate(blocks, *images, self.intrinsics, core.Tensor(np.linalg.inv(pose)),
                            self.scan.scale, self.args.far_mm / 1000, self.multiplier)
        return blocks


class FrameToFrame:
    """RGB-D odometry between neighbours, at full or at half resolution."""

    def __init__(self, scan, step, far_m):
        self.images = []
        for i, color in enumerate(scan.color):
            pixels = np.ascontiguousarray(color.as_tensor().numpy()[::step, ::step])
            self.images.append(o3d.geometry.RGBDImage.create_from_color_and_depth(
                o3d.geometry.Image(pixels), o3d.geometry.Image(scan.metres(i, far_m, step).copy()),
                1.0, far_m, True))
        k = scan.intrinsics / step
        self.intrinsics = o3d.camera.PinholeCameraIntrinsic(
            scan.width // step, scan.height // step, k[0, 0], k[1, 1], k[0, 2], k[1, 2])
        self.term = legacy.RGBDOdometryJacobianFromHybridTerm()
        self.options = legacy.OdometryOption(o3d.utility.IntVector([10, 5, 3]), 0.03, 0.1, far_m)

    def step(self, i, pose, _volume, _blocks):
        _, motion, _ = legacy.compute_rgbd_odometry(self.images[i], self.images[i - 1],
                                                    self.intrinsics, np.eye(4), self.term,
                                                    self.options)
        return pose @ motion


class FrameToModel:
    """Point-to-plane against the ray-cast model."""

    STEP = 2

    def __init__(self, scan, args):
        self.scan, self.args = scan, args
        self.motion = np.eye(4)
        self.sources = [self.vertices(i) for i in range(len(scan.depth))]

    def level(self, step):
        k = self.scan.intrinsics.copy()
        k[:2] /= step
        return core.Tensor(k)

    def vertices(self, i):
        depth = self.scan.metres(i, self.args.far_mm / 1000, self.STEP)
        depth = np.where(depth > 0, depth, np.nan).astype(np.float32)
        image = o3d.t.geometry.Image(core.Tensor(depth[:, :, None].copy()))
        return image.create_vertex_map(self.level(self.STEP), float("nan")).as_tensor()

    def step(self, i, pose, volume, blocks):
        half_voxel = np.eye(4)
        half_voxel[:3, 3] = -0.0005 * self.args.voxel_mm
        seen = volume.grid.ray_cast(
            blocks, self.level(self.STEP), core.Tensor(np.linalg.inv(pose) @ half_voxel),
            self.scan.width // self.STEP, self.scan.height // self.STEP, ["vertex", "normal"],
            self.scan.scale, 0.1, self.args.far_mm / 1000, min(float(i), 3.0), volume.multiplier,
            BLOCK_SIDE)
        nothing = seen["vertex"].numpy()[:, :, 2] <= 0
        seen["vertex"].numpy()[nothing] = np.nan
        motion = core.Tensor(self.motion)
        for further in (2, 1):
            maps = [m[::further, ::further].contiguous()
                    for m in (self.sources[i], seen["vertex"], seen["normal"])]
            for _ in range(5):
                result = odometry.compute_odometry_result_point_to_plane(
                    *maps, self.level(self.STEP * further), motion, 0.02, 0.005)
                motion = result.transformation @ motion
        self.motion = motion.numpy()
        return pose @ self.motion


def tracker_of(scan, args):
    if args.task == "odometry":
        return FrameToFrame(scan, args.step, args.odometry_far_mm / 1000)
    return FrameToModel(scan, args) if args.task == "model" else None


def peak_mb():
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


def run(scan, args):
    tracker = tracker_of(scan, args)
    before_mb = peak_mb()
    volume = Volume(scan, args)
    pose, blocks, errors, wall, track_wall = scan.poses[0], None, [], [], []
    cpu = 0.0
    for i in range(len(scan.depth)):
        cpu_start, start = time.process_time(), time.perf_counter()
        try:
            if tracker is None:
                pose = scan.poses[i]
            elif i > 0:
                pose = tracker.step(i, pose, volume, blocks)
        except RuntimeError:  # singular: no pose, the last one is kept
            pass
        tracked = time.perf_counter()
        blocks = volume.integrate(i, pose)
        wall.append(time.perf_counter() - start)
        track_wall.append(tracked - start)
        cpu += time.process_time() - cpu_start
        errors.append(1000 * np.linalg.norm(pose[:3, 3] - scan.poses[i][:3, 3]))
    figures = {"program": "open3d " + o3d.__version__, "frames": len(wall),
            "wall_ms": 1000 * float(np.median(wall)), "track_ms": 1000 * float(np.median(track_wall)),
            "mean_ms": 1000 * float(np.mean(wall)), "cpu_ms": 1000 * cpu / len(wall),
            "touched_voxels": volume.touched, "work_mb": peak_mb() - before_mb,
            "blocks": volume.grid.hashmap().size(),
            "trajectory_rmse_mm": float(np.sqrt(np.mean(np.square(errors)))),
            "trajectory_max_mm": float(np.max(errors))}
    print(json.dumps(figures), flush=True)
    if args.mesh:  # last: an assertion in Open3D's extraction ends the program now and then
        write_mesh(volume, args.mesh)


def write_mesh(volume, path):
    mesh = volume.grid.extract_triangle_mesh(3.0).to_legacy()
    mesh.scale(1000.0, np.zeros(3))
    plain = o3d.geometry.TriangleMesh(mesh.vertices, mesh.triangles)
    o3d.io.write_triangle_mesh(path, plain)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("scan")
    parser.add_argument("task", choices=("integrate", "odometry", "model"))
    parser.add_argument("--voxel-mm", type=float, default=2.0)
    parser.add_argument("--delta-mm", type=float, default=9.0)
    parser.add_argument("--far-mm", type=float, default=700.0)
    parser.add_argument("--odometry-far-mm", type=float, default=1500.0)
    parser.add_argument("--frames", type=int, default=150)
    parser.add_argument("--step", type=int, default=1, help="2: odometry at half resolution")
    parser.add_argument("--color", action="store_true")
    parser.add_argument("--mesh", help="write the surface there")
    args = parser.parse_args()
    scan = Scan(args.scan, args.frames, args.color or args.task == "odometry")
    run(scan, args)


if __name__ == "__main__":
    main()
