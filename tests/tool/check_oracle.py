#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Lets osggpuanim take the poses of one oracle file and compares them with it.

check_oracle.py OSGGPUANIM EVALUATOR SHARED ORACLE_NAME SECTION,...

SHARED is the folder with assets/ and oracle/; the sections are those of its compare.py, all of them required.
"""
import json
import os
import subprocess
import sys
import tempfile

TOLERANCE = "1e-5"  # relative to the model's size: what single precision leaves (see the oracle's README)


def main():
    tool, evaluator, shared, name, sections = sys.argv[1:]
    oracle = os.path.join(shared, "oracle", name)
    with open(oracle) as f:
        asset = os.path.join(shared, "assets", name.split(".")[0], json.load(f)["asset"]["file"])
    with tempfile.TemporaryDirectory() as folder:
        poses = os.path.join(folder, name)
        subprocess.run([tool, "pose", asset, "--like", oracle, "--evaluator", evaluator, "-o", poses], check=True)
        return subprocess.run([sys.executable, os.path.join(shared, "oracle", "compare.py"), oracle, poses,
                               "--tolerance", TOLERANCE, "--only", sections, "--require", sections]).returncode


if __name__ == "__main__":
    sys.exit(main())
