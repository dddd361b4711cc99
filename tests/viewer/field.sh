#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Usage: field.sh CROWD LEAST MOST
# The stock osgviewer shows the crowd of that name (FILE.glb.9x9.crowd) without further options: of the 256 rows of its
# picture at least LEAST and at most MOST are not background alone. Exit status 77: Xvfb or osgviewer is not there.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/screen.sh"

# Rows of the screen with something else than its first pixel has.
rows()
{
    cp "$screen" "$folder/picture"
    pixels "$folder/picture" | od -An -v -w4 -tx4 |
        awk 'NR == 1 { ground = $1 } $1 != ground { seen[int((NR - 1) / 256)] } END { print length(seen) }'
}

osgviewer --window 0 0 256 256 "$1" >"$folder/log" 2>&1 &
viewer=$!
for ((tenths = 0; tenths < 600; ++tenths)); do
    kill -0 $viewer || { cat "$folder/log"; exit 1; }
    [ "$(rows)" -eq 0 ] || break
    sleep 0.1
done
sleep 1 # The first frame may have been half way onto the screen.
seen=$(rows)
kill -KILL $viewer
wait $viewer 2>/dev/null || true
echo "$seen rows"
[ "$seen" -ge "$2" ] && [ "$seen" -le "$3" ]
