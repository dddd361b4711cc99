#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Usage: same_picture.sh FILE.glb OPTIONS
# The stock osgviewer shows the file, read with the options, and what osgconv makes of it as .osgb: under Xvfb, whose
# screen lies in a file. The options hold the clip at one time (start=… speed=0). Exit status 0: the same picture, no
# pixel different; 77: Xvfb, osgviewer or osgconv is not there.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/screen.sh"

osgconv -O "$2" "$1" "$folder/kept.osgb" >"$folder/osgconv.log" 2>&1 || { cat "$folder/osgconv.log"; exit 1; }
show "$folder/first" -O "$2" "$1"
show "$folder/second" "$folder/kept.osgb"
# Not the background alone.
colours=$(pixels "$folder/first" | od -An -v -w4 -tx4 | sort -u | wc -l)
different=$({ cmp -l <(pixels "$folder/first") <(pixels "$folder/second") || true; } | wc -l)
echo "$colours colours, $different bytes different"
[ "$colours" -gt 20 ] && [ "$different" -eq 0 ]
