#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Usage: plugin/packages.sh [RELEASE...]
# Builds the packages of a version into build-packages/: of each Debian release (bookworm and trixie) in a bare system, and
# the folder for Windows if tests/ports/windows.sh is there; and build-packages/SHA256SUMS. Needs what tests/ports/debian.sh
# needs.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

out=build-packages
rm -rf "$out"
releases=("$@")
[ $# -gt 0 ] || releases=(bookworm trixie)
for release in "${releases[@]}"; do
    tests/ports/debian.sh "$release" packages
    mkdir -p "$out/$release"
    cp "build-$release"/src/osgGpuAnimation/build-deb/*.deb "$out/$release/"
done
if [ $# -eq 0 ] && [ -x tests/ports/windows.sh ]; then
    tests/ports/windows.sh
    mkdir -p "$out/windows"
    find build-windows -maxdepth 2 -name "*.zip" -exec cp {} "$out/windows/" \;
fi
(cd "$out" && find . -type f ! -name SHA256SUMS -printf '%P\0' | sort -z | xargs -0 sha256sum >SHA256SUMS)
cat "$out/SHA256SUMS"
