#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Usage: scenes/view.sh [FILE]
# Installs what is missing on a Debian (12, 13 or sid), builds the plugins into build/ and opens FILE (.glb, .gltf, .fbx,
# …; default: our own Wanderer.glb in the studio) in the stock osgviewer. Pseudo-loaders may follow:
# Wanderer.glb.20x20.crowd.studio. Without a display it draws a picture (of the model or the crowd, in the studio's light)
# into build/ and says where.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../tests/setup.sh"

if [ $# -gt 1 ] || [[ "${1:-}" == -* ]]; then
    sed -n '3,7s/^# //p' "${BASH_SOURCE[0]}"
    [[ "${1:-}" == -h || "${1:-}" == --help ]] && exit 0
    exit 2
fi
file=${1:-$root/scenes/Wanderer.glb.studio}
# The longest part of the name that is a file: what follows is for OSG's pseudo-loaders (.20x20.crowd, .90,0,0.rot).
model=$file
while [ ! -f "$model" ]; do
    if [[ "$(basename "$model")" != ?*.* ]]; then
        echo "There is no file $file" >&2
        exit 1
    fi
    model=${model%.*}
done

install_missing "${view_packages[@]}"
configure_release
build_targets plugins osggpuanim
export OSG_LIBRARY_PATH=$build/lib${OSG_LIBRARY_PATH:+:$OSG_LIBRARY_PATH}

if [ -n "${DISPLAY:-}" ]; then
    echo "osgviewer $file (Escape ends it)"
    log=$(mktemp)
    trap 'rm -f "$log"' EXIT
    status=0
    osgviewer --window 100 100 1024 768 "$file" 2>&1 | tee "$log" || status=$?
    grep -q "Unable to open display" "$log" || exit "$status"
fi
drawn=$model
[[ "$file" == "$model.gpuanim"* ]] && drawn=$model.gpuanim
[[ "$file" =~ ^(.*\.crowd)(\..*)?$ ]] && drawn=${BASH_REMATCH[1]}
picture=$build/$(basename "${model%.*}${drawn#"$model"}").png  # Wanderer.png, Wanderer.5x5.crowd.png
"$build/bin/osggpuanim" render "$drawn" --time 0.5 -o "$picture"
left_out=${file#"$drawn"}
[[ "$left_out" =~ ^(\.studio)?$ ]] || echo "The picture is without $left_out, which OSG's viewer alone takes"
echo "There is no display to show $file on; a picture of $drawn is in $picture"
