#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Compares pictures of `osggpuanim render --look` with the shared reference pictures.

check_looks.py OSGGPUANIM SHARED NAME [FOLDER]

SHARED is the folder with assets/ and looks/; NAME is a reference picture's, as `Fox.studio`. The picture stays in
FOLDER, if one is given. Needs python3-skimage, -scipy and -pil, of the system's Python.
"""
import glob
import importlib.util
import os
import subprocess
import sys
import tempfile

import numpy as np
from PIL import Image
from scipy.ndimage import binary_erosion

# of the first clip, as in the README beside the pictures
TIMES = {"Knight": 0.4, "Fox": 0.5, "AnimatedMorphCube": 0.6}
# the highest mean dE00, by model; 95 % of the pixels are within three times as much
LIMITS = {"vertex_colors": 0.7, "alpha": 4.0}
LEAST_SIMILARITY = 0.95


def comparison(shared):
    path = os.path.join(shared, "looks", "compare.py")
    spec = importlib.util.spec_from_file_location("compare", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def model_of(shared, name):
    return (glob.glob(os.path.join(shared, "looks", "models", name + ".glb"))
            + glob.glob(os.path.join(shared, "assets", name, name + ".gl*")))[0]


def faults(compare, picture, shared, name, look):
    reference = os.path.join(shared, "looks", "pictures", f"{name}.{look}")
    found = compare.compare(picture, reference + ".png")
    limit = LIMITS.get(name, 2.0)
    print({key: round(float(value), 3) for key, value in found.items()})
    if not found["dE"] <= limit:
        yield f"mean dE00: expected at most {limit}, found {found['dE']:.2f}"
    if not found["dE95"] <= 3 * limit:
        yield f"dE00 of 95 %: expected at most {3 * limit}, found {found['dE95']:.2f}"
    if not found["ssim"] >= LEAST_SIMILARITY:
        yield f"SSIM: expected at least {LEAST_SIMILARITY}, found {found['ssim']:.3f}"
    if os.path.exists(reference + ".integrated.png"):
        inner = compare.compare(picture, reference + ".integrated.png")["inner"]
        if not inner <= 1.5:
            yield f"inner dE00 of the integrated picture: expected at most 1.5, found {inner:.2f}"
    if look == "furnace":
        pixels = np.asarray(Image.open(picture).convert("RGB"))
        back = compare.backdrop(*pixels.shape[:2])
        inside = binary_erosion(np.abs(pixels / 255 - back).max(-1) > 3 / 255, iterations=3)
        if pixels[inside].min() < 253:
            yield f"pixels of the balls: expected at least 253, found {pixels[inside].min()}"
    if name == "grey_ramp":
        a, b = compare.read(picture), compare.read(reference + ".png")
        mask = np.abs(b - compare.backdrop(*b.shape[:2])).max(-1) > 3 / 255
        rows = np.where(mask.any(1))[0]
        for half in (rows[: len(rows) // 2], rows[len(rows) // 2:]):
            inner = binary_erosion(mask, iterations=3)
            delta = compare.deltaE_ciede2000(compare.rgb2lab(a), compare.rgb2lab(b))[half][inner[half]].mean()
            if delta > 0.7:
                yield f"rows {half[0]} to {half[-1]}: expected dE00 of at most 0.7, found {delta:.2f}"


def main():
    tool, shared, picture, *kept = sys.argv[1:]
    name, look = picture.split(".")
    with tempfile.TemporaryDirectory() as folder:
        output = os.path.join(*(kept or [folder]), picture + ".png")
        subprocess.run([tool, "render", model_of(shared, name), "--look", look, "--time", str(TIMES.get(name, 0.0)),
                        "--size", "512x512", "-o", output], check=True)
        found = list(faults(comparison(shared), output, shared, name, look))
    for fault in found:
        print(fault)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
