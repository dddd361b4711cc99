#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Compares the poses that osggpuanim computes for FBX files with those that they must have.

check_fbx.py OSGGPUANIM CASES [NAME]     prints the distance of each case (or of NAME), relative to the size of the model

CASES is ../shared/cases: the files fbx_*.fbx with the values of its README, and fbx/ with what ufbx computes at rest and
at the ends of each take.
"""
import glob
import json
import os
import subprocess
import sys

TOLERANCE = 1e-3  # of the size of the model

# File, clip (None: at rest), seconds, and bounds of an axis: {"x": (minimum, maximum)}, of the last mesh in "last x", of
# a node's in "door x"; None is not compared. A text in place of bounds is what the messages must contain.
EXPECTED = {
    "fbx_small_offsets": [(None, 0, {"y": (-0.004, 0.022)})],
    "fbx_shape_at_rest": [(None, 0, {"y": (-0.5, 0.5)})],
    "fbx_rotation_pivot_anim": [("Open", 1, {"x": (0, 1)})],
    "fbx_geometric_offset": [(None, 0, {"y": (-0.5, 1.5), "child y": (-0.5, 0.5)})],
    "fbx_skin_geometric": [(None, 0, {"y": (0.5, 1.5)})],
    "fbx_take_with_outside_keys": [("Second", 1, {"x": (1.317, None)}), ("Second", 0, {"x": (-0.683, 0.683)})],
    "fbx_take_between_keys": [("Cut", 0, {"x": (0.5, 1.5)}), ("Cut", 1, {"x": (2.5, 3.5)})],
    "fbx_time_property_abort": [(None, 0, {"x": (-0.5, 0.5)})],
    "fbx_shape_curves_of_other_times": [("0", 0.5, {"y": (None, 1.5)})],
    "fbx_cubic_keys": [("0", 0.25, {"x": (-0.1875, None)})],
    "fbx_stepped_keys": [("0", 0.25, {"x": (-0.5, 0.5)}), ("0", 0.75, {"x": (0.5, 1.5)})],
    "fbx_hidden_node": [(None, 0, "KHR_node_visibility")],
    "fbx_segment_scale": [(None, 0, {"x": (1.5, 2.5)})],
    "fbx_same_names": [("Up", 1, {"last y": (1.5, 2.5), "y": (-0.5, 2.5)})],
    "fbx_shape_on_placed_node": [(None, 0, "warnings         0")],
}


def run(tool, *arguments):
    done = subprocess.run([tool, *arguments], capture_output=True, text=True)
    if done.returncode != 0:
        raise RuntimeError(f"exit status {done.returncode}: {done.stderr.strip()[-300:]}")
    return done.stdout


def pose(tool, file, clip, time):
    chosen = ["--bind"] if clip is None else ["--clip", clip, "--time", str(time)]
    found = json.loads(run(tool, "pose", file, "--evaluator", "cpu", *chosen))
    return found, found["frames"][0]


def distance_of_bounds(expected, found):
    pairs = [(e, f) for e, f in zip(expected, found) if e is not None]
    return max(abs(e - f) for e, f in pairs)


def distance_of_pose(expected, found, frame):
    """Distance to a frame of ufbx, relative to the size of its bounds. Nodes that nothing moves have no matrix."""
    low, high = expected["bbox"][:3], expected["bbox"][3:]
    size = max(h - l for l, h in zip(low, high))
    distance = distance_of_bounds(low + high, frame["bbox"][0] + frame["bbox"][1]) / size
    unit = None  # ufbx has the unit of the file in the matrices, this importer in the vertices
    for name, columns in expected["nodes"].items():
        number = found["nodeNames"].index(name) if name in found["nodeNames"] else None
        matrix = frame["nodes"][number] if number is not None else None
        if matrix is None:
            continue
        moved = [matrix[4 * column + row] for column in range(4) for row in range(3)]
        unit = unit or max(map(abs, columns[:9])) / max(map(abs, moved[:9]))
        moved[:9] = [unit * each for each in moved[:9]]
        length = max(abs(each) for each in columns[:9])
        distance = max(distance, distance_of_bounds(columns[:9], moved[:9]) / length,
                       distance_of_bounds(columns[9:], moved[9:]) / size)
    return distance


def pose_of_take(tool, file, clips, time, may_rest):
    """clips: the names under which a clip may have come. A take that moves nothing is no clip."""
    failed = None
    for clip in clips:
        try:
            return pose(tool, file, clip, time)
        except RuntimeError as fault:
            failed = fault
    if not may_rest:
        raise failed
    return pose(tool, file, None, 0)


def check_ufbx(tool, file):
    with open(file[: -len(".fbx")] + ".expected.json") as f:
        expected = json.load(f)
    found, frame = pose(tool, file, None, 0)
    distances = [("rest", distance_of_pose(expected["rest"], found, frame))]
    for number, take in enumerate(expected["takes"]):
        for moment in take["frames"]:
            found, frame = pose_of_take(tool, file, [take["name"], str(number)], moment["t"] - take["begin"],
                                        moment["bbox"] == expected["rest"]["bbox"])
            distances.append((f"{take['name']} at {moment['t']:.3f} s", distance_of_pose(moment, found, frame)))
    return distances


def check_row(tool, file, rows):
    distances = []

    def box_of(found, frame, of):
        if not of:
            return frame["bbox"]
        named = [frame["primitives"][i]["bbox"] for i, each in enumerate(found["primitives"])
                 if of == "last" or found["nodeNames"][each["node"]] == of]
        return named[-1]

    for clip, time, expected in rows:
        if isinstance(expected, str):
            said = run(tool, "inspect", file)
            distances.append((f"inspect says {expected}", 0.0 if expected in said else 1.0))
            continue
        found, frame = pose(tool, file, clip, time)
        for axis, bounds in expected.items():
            number = "xyz".index(axis[-1])
            box = box_of(found, frame, axis[:-2])
            size = max(1e-9, max(high - low for low, high in zip(*frame["bbox"])))
            distance = distance_of_bounds(bounds, [box[0][number], box[1][number]]) / size
            distances.append((f"{'rest' if clip is None else clip} at {time} s, {axis}", distance))
    return distances


def main():
    tool, cases = sys.argv[1:3]
    only = sys.argv[3] if len(sys.argv) > 3 else ""
    failed = 0
    for file in sorted(glob.glob(os.path.join(cases, "fbx_*.fbx")) + glob.glob(os.path.join(cases, "fbx", "*.fbx"))):
        name = os.path.basename(file)[: -len(".fbx")]
        if only not in ("", name):
            continue
        try:
            if name in EXPECTED:
                distances = check_row(tool, file, EXPECTED[name])
            else:
                distances = check_ufbx(tool, file)
        except (RuntimeError, ValueError) as fault:
            distances = [(str(fault), float("inf"))]
        what, worst = max(distances, key=lambda each: each[1])
        failed += not worst <= TOLERANCE
        print(f"{'ok  ' if worst <= TOLERANCE else 'FAIL'} {name:45} {worst:9.2g}  {what if worst > TOLERANCE else ''}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
