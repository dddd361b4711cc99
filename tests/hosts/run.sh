#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Usage: [OUT=FOLDER] tests/hosts/run.sh [sumo|dart|flightgear|present3D]...
# Installs programs that show scenes of OSG (default: all four) and runs them under Xvfb over scenes/Wanderer.glb, as
# osg_nodes/doc/hosts.md tells. Compares three pictures of each: without the character, with it, and a moment later.
# flightgear also hides a part of the character by its name. Ends with a table; the pictures are in OUT (default:
# build/hosts/). The plugins must have been built. Exit status 0: everything that was asked for ran and passed.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../setup.sh"

packages_sumo=(sumo)
packages_dart=(g++ libopenscenegraph-dev libdart-gui-osg-dev libdart-external-ikfast-dev libassimp-dev)
packages_flightgear=(flightgear) # 2.6 GB with its data
packages_present3D=()

# What a character must at least change, in pixels: the host's own picture, and half a second later its own. SUMO's clock
# and indicators change up to 1,400.
min_shown=1500 min_moved=3000
min_part=60 # the lantern in fgviewer, which shows the character 170 pixels high; it has some 250

fail()
{
    echo "hosts: $*" >&2
    exit 1
}

# Each host writes its files; `start_HOST bare` shows them without the character, `start_HOST full` with it.
write_sumo()
{
    cp "$root/scenes/Wanderer.glb" .
    osgconv -O clip=Walk Wanderer.glb walk.osgb
    echo '<nodes> <node id="west" x="0" y="0"/> <node id="east" x="200" y="0"/> </nodes>' >street.nod.xml
    echo '<edges> <edge id="street" from="west" to="east" numLanes="1" sidewalkWidth="3"/> </edges>' >street.edg.xml
    netconvert -n street.nod.xml -e street.edg.xml -o street.net.xml
    echo '<routes/>' >bare.rou.xml
    cat >full.rou.xml <<'END'
<routes>
    <vType id="walker" vClass="pedestrian" osgFile="walk.osgb" width="0.9" length="0.9" height="1.7"/>
    <vType id="visitor" vClass="passenger" osgFile="Wanderer.glb" width="0.9" length="0.9" height="1.7" color="1,1,1"/>
    <person id="a" type="walker" depart="0" departPos="22"> <stop edge="street" endPos="22" duration="1000"/> </person>
    <vehicle id="b" type="visitor" depart="0" departPos="24" departSpeed="0">
        <route edges="street"/> <stop lane="street_1" endPos="24.5" duration="1000"/>
    </vehicle>
</routes>
END
    echo '<viewsettings> <viewport x="23" y="-13" z="2" centerX="23.2" centerY="-5" centerZ="0.5"/> </viewsettings>' >view.xml
}
start_sumo()
{
    SUMO_HOME=/usr/share/sumo exec sumo-gui --osg-view --start --delay 1000 --step-length 0.1 --window-pos 0,0 \
        --window-size $width,$height --gui-settings-file view.xml --net-file street.net.xml --route-files "$1.rou.xml"
}

write_dart()
{
    osgconv -O clip=Walk "$root/scenes/Wanderer.glb" walk.osgb
    g++ -std=c++17 -O1 -Wall -Wextra -Werror -isystem /usr/include/eigen3 "$root/tests/hosts/dart.cpp" -o dart \
        -ldart-gui-osg -ldart -losgViewer -losgGA -losgShadow -losgDB -losgUtil -losg -lOpenThreads -lassimp
}
start_dart()
{
    if [ "$1" = bare ]; then exec ./dart; else exec ./dart walk.osgb; fi
}

write_flightgear()
{
    cp "$root/scenes/Wanderer.glb" .
    osgconv -O "clip=Walk start=0.2 speed=0" Wanderer.glb held.osgb
    local file
    for file in Wanderer.glb held.osgb; do
        cat >"$file.xml" <<END
<?xml version="1.0"?>
<PropertyList>
    <path>$file</path>
    <animation>
        <type>select</type>
        <object-name>Lantern</object-name>
        <condition> <property>/wanderer/lantern</property> </condition>
    </animation>
</PropertyList>
END
    done
}
start_flightgear()
{
    case $1 in
        bare) exec sleep 1000 ;; # fgviewer shows nothing without a model
        full) exec /usr/games/fgviewer --prop /wanderer/lantern true Wanderer.glb.xml ;;
        with) exec /usr/games/fgviewer --prop /wanderer/lantern true held.osgb.xml ;;
        without) exec /usr/games/fgviewer held.osgb.xml ;;
    esac
}
# The two pictures keep still, and differ by the part.
also_flightgear()
{
    local name
    for name in with without; do
        photograph $name bare.1 || return
        [ "$(differing $name.1 $name.2)" -eq 0 ] || { verdict="moves at speed 0"; return; }
    done
    local part
    part=$(differing with.1 without.1)
    echo "the part has $part pixels"
    [ "$part" -ge $min_part ] || verdict="the part is not hidden"
}

write_present3D()
{
    cp "$root/scenes/Wanderer.glb" .
    local name model
    for name in bare full; do
        model='<model options="clip=Walk noKeys" scale="0.7">Wanderer.glb</model>'
        [ $name = full ] || model=
        cat >$name.p3d <<END
<?xml version="1.0"?>
<presentation>
    <slide> <title>A character</title> <layer> $model </layer> </slide>
</presentation>
END
    done
}
start_present3D()
{
    exec present3D "$1.p3d"
}

# differing A B: the number of pixels of two pictures that differ.
differing()
{
    { cmp -l <(pixels "$1") <(pixels "$2") || true; } |
        awk '{ pixel[int(($1 - 1) / 4)] } END { print length(pixel) }'
}

# photograph NAME [PICTURE]: starts the host that way, and takes the pictures NAME.1 and, half a second later, NAME.2: when
# $min_shown pixels differ from PICTURE, else when the screen has kept still for two seconds.
photograph()
{
    local name=$1 tenths quiet=0 program
    (start_$host "$name") >"$name.log" 2>&1 </dev/null &
    program=$!
    cp "$empty" "$name.1"
    for ((tenths = 0; tenths < 900; tenths += 5)); do
        sleep 0.5
        kill -0 $program 2>/dev/null || { verdict="ended by itself, see $name.log"; return 1; }
        cp "$screen" "$name.2"
        if [ $# -eq 2 ]; then
            [ "$(differing "$2" $name.2)" -lt $min_shown ] || break
        else
            if [ "$(differing $name.1 $name.2)" -lt 200 ]; then quiet=$((quiet + 1)); else quiet=0; fi
            [ $quiet -lt 4 ] || [ $tenths -lt 50 ] || break
            cp "$name.2" "$name.1"
        fi
    done
    sleep 2 # The first frame may be half way onto the screen.
    cp "$screen" "$name.1"
    sleep 0.5
    cp "$screen" "$name.2"
    kill -KILL $program
    wait $program 2>/dev/null || true
    sleep 0.5
}

compare()
{
    shown=$(differing bare.1 full.1) moved=$(differing full.1 full.2)
    if [ "$shown" -lt $min_shown ]; then
        verdict="no character"
    elif [ "$moved" -lt $min_moved ]; then
        verdict="the character does not move"
    elif declare -F "also_$host" >/dev/null; then
        "also_$host"
    fi
}

# The row of a host. Runs in a subshell, with a screen of its own.
run_host()
{
    host=$1 verdict=passed shown=0 moved=0 width=800 height=600
    export LIBGL_ALWAYS_SOFTWARE=1 OSG_LIBRARY_PATH=${OSG_LIBRARY_PATH:-$build/lib}
    source "$root/tests/viewer/screen.sh"
    cd "$folder"
    export HOME=$folder # for settings that hosts keep
    if ! (set -e; "write_$host") >write.log 2>&1; then
        verdict="its files could not be written, see write.log"
    elif photograph bare && photograph full bare.1; then
        compare
    fi
    echo "| $host | $shown | $moved | $verdict |" >>"$out/table.md"
    keep
}

# The pictures and what was said.
keep()
{
    local picture
    for picture in *.[12]; do
        pixels "$picture" | /usr/bin/python3 -c "import sys, PIL.Image
PIL.Image.frombytes('RGB', ($width, $height), sys.stdin.buffer.read(), 'raw', 'BGRX').save('$out/$host.$picture.png')"
    done
    for picture in *.log; do
        cp "$picture" "$out/$host.$picture"
    done
}

[ $# -gt 0 ] || set -- sumo dart flightgear present3D
packages=(openscenegraph libgl1-mesa-dri xvfb python3 python3-pil)
for host in "$@"; do
    [[ " sumo dart flightgear present3D " == *" $host "* ]] || fail "expected sumo, dart, flightgear or present3D, found $host"
    declare -n needed=packages_$host
    packages+=("${needed[@]}")
done
install_missing "${packages[@]}"
mkdir -p "${OUT:=$build/hosts}"
out=$(cd "$OUT" && pwd)
printf '%s\n' '| host | pixels of the character | pixels that move | result |' '| --- | --- | --- | --- |' >"$out/table.md"
for host in "$@"; do
    rm -f "$out/$host".*
    (run_host "$host")
done
cat "$out/table.md"
[ "$(grep -c '| passed |$' "$out/table.md")" -eq $# ]
