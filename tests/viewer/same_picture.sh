#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Usage: same_picture.sh FILE.glb OPTIONS
# The stock osgviewer shows the file, read with the options, and what osgconv makes of it as .osgb: under Xvfb, whose
# screen lies in a file. The options hold the clip at one time (start=… speed=0). Exit status 0: the same picture, no
# pixel different; 77: Xvfb, osgviewer or osgconv is not there.
set -euo pipefail
for program in Xvfb osgviewer osgconv; do
    command -v $program >/dev/null || { echo "there is no $program"; exit 77; }
done

folder=$(mktemp -d)
server=
end()
{
    [ -z "$server" ] || kill "$server" 2>/dev/null || true
    wait || true
    rm -rf "$folder"
}
trap end EXIT

# The first display number that is free, told on file descriptor 3.
Xvfb -displayfd 3 -screen 0 256x256x24 -nocursor -nolisten tcp -fbdir "$folder" 3>"$folder/number" 2>"$folder/xvfb.log" &
server=$!
for ((tenths = 0; tenths < 300; ++tenths)); do
    [ ! -s "$folder/number" ] || break
    sleep 0.1
done
[ -s "$folder/number" ] || { cat "$folder/xvfb.log"; exit 1; }
export DISPLAY=:$(cat "$folder/number")
screen=$folder/Xvfb_screen0
cp "$screen" "$folder/empty"

# show PICTURE ARGUMENT...: osgviewer with the arguments, until it has shown the same picture for a second.
show()
{
    local picture=$1 quiet=0 viewer
    shift
    osgviewer --window 0 0 256 256 "$@" >"$folder/log" 2>&1 &
    viewer=$!
    cp "$folder/empty" "$picture"
    for ((tenths = 0; tenths < 600 && quiet < 10; ++tenths)); do
        sleep 0.1
        kill -0 $viewer || { cat "$folder/log"; return 1; }
        if cmp -s "$screen" "$picture" && ! cmp -s "$screen" "$folder/empty"; then
            quiet=$((quiet + 1))
        else
            quiet=0
            cp "$screen" "$picture"
        fi
    done
    kill -KILL $viewer
    wait $viewer 2>/dev/null || true
    [ $quiet -eq 10 ] || { echo "osgviewer $*: no picture, or one that does not keep still"; cat "$folder/log"; return 1; }
}

osgconv -O "$2" "$1" "$folder/kept.osgb" >"$folder/osgconv.log" 2>&1 || { cat "$folder/osgconv.log"; exit 1; }
show "$folder/first" -O "$2" "$1"
show "$folder/second" "$folder/kept.osgb"
# Not the background alone.
colours=$(tail -c $((256 * 256 * 4)) "$folder/first" | od -An -v -w4 -tx4 | sort -u | wc -l)
different=$({ cmp -l <(tail -c $((256 * 256 * 4)) "$folder/first") <(tail -c $((256 * 256 * 4)) "$folder/second") || true; } | wc -l)
echo "$colours colours, $different bytes different"
[ "$colours" -gt 20 ] && [ "$different" -eq 0 ]
