#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Reads damaged copies of files with osggpuanim, which must end with status 0 or 1.

damaged_files.py OSGGPUANIM COUNT SEED FILE...

Of each file, COUNT copies are damaged: bytes or numbers replaced, pieces removed, doubled or exchanged, or cut short. A
copy that ends the tool by a signal, or that it reads for more than a minute, stays in the current folder; the tally counts
what Assimp did in its own process.
"""
import collections
import os
import random
import re
import shutil
import subprocess
import sys
import tempfile

NUMBERS = [b"-1", b"0", b"4294967295", b"2147483647", b"1e38", b"nan", b"-1e300", b"65536", b""]


def damaged(content, rng):
    data = bytearray(content)
    for _ in range(rng.choice([1, 1, 2, 5, 20])):
        if not data:
            break
        at = rng.randrange(len(data))
        length = min(rng.choice([1, 4, 16, 200]), len(data) - at)
        kind = rng.randrange(7)
        if kind == 0:
            data[at] = rng.randrange(256)
        elif kind == 1:
            data[at:at + length] = bytes([rng.choice([0, 255, 128, 1])]) * length
        elif kind == 2:
            del data[at:at + length]
        elif kind == 3:
            data[at:at] = data[at:at + length]
        elif kind == 4 and rng.random() < 0.3:
            del data[at:]
        elif kind == 5:
            to = rng.randrange(len(data))
            data[at:at + length] = data[to:to + length]
        else:
            found = list(re.finditer(rb"-?\d+(\.\d+)?", bytes(data[at:at + 400])))
            if found:
                number = rng.choice(found)
                data[at + number.start():at + number.end()] = rng.choice(NUMBERS)
    return bytes(data)


def main():
    tool, count, seed = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
    tally, ended = collections.Counter(), 0
    with tempfile.TemporaryDirectory() as folder:
        for file in sys.argv[4:]:
            with open(file, "rb") as f:
                content = f.read()
            for number in range(count):
                rng = random.Random(f"{seed} {os.path.basename(file)} {number}")
                copy = os.path.join(folder, f"{seed}_{number}_{os.path.basename(file)}")
                with open(copy, "wb") as f:
                    f.write(damaged(content, rng))
                try:
                    done = subprocess.run([tool, "inspect", copy], capture_output=True, timeout=90)
                    status, said = done.returncode, done.stderr.decode(errors="replace")
                except subprocess.TimeoutExpired:
                    status, said = -1, "the tool hangs"
                kind = ("read" if status == 0 else "a signal of Assimp" if "ended with signal" in said else
                        "stopped" if "was stopped" in said else "refused" if status == 1 else "ENDED THE TOOL")
                tally[os.path.splitext(file)[1], kind] += 1
                if kind == "ENDED THE TOOL":
                    ended += 1
                    shutil.copy(copy, ".")
                    print(f"{os.path.basename(copy)}: status {status}: {said.strip()[-300:]}")
                os.remove(copy)
    for (extension, kind), number in sorted(tally.items()):
        print(f"{extension:10} {kind:20} {number}")
    return 1 if ended else 0


if __name__ == "__main__":
    sys.exit(main())
