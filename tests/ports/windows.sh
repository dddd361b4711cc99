#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Usage: tests/ports/windows.sh [SUITE...]
# Cross-builds the kit for Windows by MinGW-w64, with OSG and the libraries of its least build from Debian's source
# packages, in build-windows/, and runs there, under Wine and Xvfb: the test programs, or those suites whose names match
# the regular expressions SUITE; the poses of ../shared/oracle by osggpuanim.exe; OSG's osgviewer.exe, whose picture is
# compared with that of Linux; and the same from the ZIP that CPack makes. What build-windows/ has already is kept and
# used again. Exit status 0: everything passed, except for the tests named here.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../setup.sh"

folder=$root/build-windows
source "$root/tests/ports/sources.sh"
prefix=$folder/prefix
build=$folder/kit
programs=(animation gpu nodes plugin)
# Tests that are left out for a reason that osg_nodes/doc/platforms.md gives.
left_out=(
    StoredLevelsTest.faultsCostTheLevelsAlone
    ProfileGLTest.aHeadlightTakesThePlaceOfLightsInTheCoreProfile 'Profiles/ProfilesGLTest.*/Core*'
)

# cross NAME SOURCE CMAKE'S-OPTION...: configures in $folder/NAME.
cross()
{
    local launcher=()
    ! command -v ccache >/dev/null || launcher=(-DCMAKE_C{,XX}_COMPILER_LAUNCHER=ccache)
    cmake -S "$2" -B "$folder/$1" -G Ninja "-DCMAKE_TOOLCHAIN_FILE=$root/tests/ports/mingw.cmake" -Wno-dev \
        "-DCMAKE_FIND_ROOT_PATH=$prefix" "-DCMAKE_INSTALL_PREFIX=$prefix" -DCMAKE_BUILD_TYPE=Release "${launcher[@]}" "${@:3}"
}

# make NAME TARGET...: builds in $folder/NAME.
make()
{
    cmake --build "$folder/$1" --parallel "$(nproc)" ${2:+--target "${@:2}"}
}

build_small_libraries()
{
    mkdir -p "$prefix/include" "$prefix/share/cmake"
    cp -a /usr/include/{glm,nlohmann,CLI,tiny_gltf.h} "$prefix/include" # headers alone
    cp -a /usr/share/cmake/{glm,nlohmann_json,CLI11} "$prefix/share/cmake"
    cross png "$folder/sources/libpng1.6" -DPNG_TESTS=OFF -DPNG_SHARED=OFF
    make png
    cmake --install "$folder/png"
    cross jpeg "$folder/sources/libjpeg-turbo" -DENABLE_SHARED=OFF -DWITH_SIMD=OFF
    make jpeg
    cmake --install "$folder/jpeg"
    cross meshoptimizer "$folder/sources/meshoptimizer"
    make meshoptimizer
    cmake --install "$folder/meshoptimizer"
    cross googletest /usr/src/googletest -DBUILD_GMOCK=OFF
    make googletest
    cmake --install "$folder/googletest"
}

build_osg()
{
    local libraries=(OpenThreads osg osgUtil osgDB osgGA osgText osgViewer osgAnimation osgShadow osgFX)
    local formats=(osg png jpeg rgb bmp tga hdr rot)
    local plugins=("${formats[@]/#/osgdb_}" osgdb_osgshadow osgdb_serializers_osg{,util,ga,text,viewer,animation,shadow,fx})
    local source=$folder/sources/openscenegraph
    # What CMake would find out by running programs; C++14, because OSG has names that C++17 has, too (byte).
    local options=(-D_OPENTHREADS_ATOMIC_USE_{GCC_BUILTINS=1,MIPOSPRO_BUILTINS=0,SUN=0,WIN32_INTERLOCKED=0,BSD_ATOMIC=0}
        -DOSG_DETERMINE_WIN_VERSION=OFF -DCMAKE_CXX_STANDARD=14 -DCMAKE_CXX_FLAGS=-Wno-narrowing
        -DBUILD_OSG_PLUGINS_BY_DEFAULT=OFF -DBUILD_OSG_PLUGIN_SHADOW=ON -DLIB_POSTFIX=)
    for format in "${formats[@]}"; do
        options+=("-DBUILD_OSG_PLUGIN_${format^^}=ON")
    done
    cross osg "$source" "${options[@]}"
    make osg "${libraries[@]}" "${plugins[@]}" application_osg{viewer,conv}
    cp -a "$source/include" "$folder/osg"/{include,lib,bin} "$prefix"
}

# Libraries that take long are left off, as the least build leaves them off.
build_kit()
{
    local option options=()
    for option in EGL DRACO WEBP ASSIMP; do
        options+=("-DOSGGPUANIMATION_WITH_$option=OFF")
    done
    cross kit "$root" -DBUILD_TESTING=ON -DOSGGPUANIMATION_UNITY=ON -DOSGGPUANIMATION_WERROR=ON "${options[@]}" \
        -DCMAKE_SKIP_INSTALL_ALL_DEPENDENCY=ON
    make kit plugins osggpuanim "${programs[@]/%/_tests}"
}

# Starts a Windows program of the build on $DISPLAY.
start()
{
    local path=$build/bin:$prefix/bin:/usr/lib/gcc/x86_64-w64-mingw32/12-posix:/usr/x86_64-w64-mingw32/lib
    WINEPATH="Z:${path//:/;Z:}" OSG_LIBRARY_PATH="Z:$build/lib;Z:$prefix/bin" exec wine "$build/bin/$1" "${@:2}"
}

# test_suite PROGRAM SUITE: prints googletest's lines about each test. A crash, or a suite that takes more than two minutes,
# is a failure.
test_suite()
{
    local log=$folder/logs/$1.${2//\//-}log
    timeout -k 10 120 bash -c 'start "$@"' - "$1_tests.exe" "--gtest_filter=$2*-$without" </dev/null 2>&1 | tr -d '\r' >"$log" || true
    grep -E '^\[ +(OK|FAILED|SKIPPED) +\] [^ ]+ \(' "$log" | sed 's/ (.*//' || true
    grep -qE '^\[  PASSED|^\[  FAILED' "$log" && grep -q 'Global test environment tear-down' "$log" ||
        echo "[  FAILED  ] $(grep -oE '^\[ RUN +\] .*' "$log" | tail -1 | sed 's/.*\] //' | grep . || echo "${2}starts") (crash)"
}

# Every suite of the programs on its own, two at a time. $folder/results has a line a test.
run_tests()
{
    local program suites
    export -f start test_suite
    export folder build prefix without=$(IFS=: && echo "${left_out[*]}")
    rm -rf "$folder/logs"
    mkdir -p "$folder/logs"
    for program in "${programs[@]}"; do
        mapfile -t suites < <((start "${program}_tests.exe" --gtest_list_tests) 2>/dev/null | tr -d '\r' |
            sed -nE 's/^([^ ]+\.).*/\1/p' | grep -E "$1")
        [ ${#suites[@]} -eq 0 ] ||
            printf '%s\0' "${suites[@]}" | xargs -0 -P "$(nproc)" -I{} bash -c 'test_suite "$@"' - "$program" {}
    done >"$folder/results"
}

# Fails if a test failed.
judge_tests()
{
    local kind
    for kind in OK SKIPPED FAILED; do
        echo "$kind: $(grep -cE "^\[ +$kind" "$folder/results" || true)"
    done
    ! grep FAILED "$folder/results"
}

# The poses of the shared oracle by the tool for Windows, on the GPU path.
run_oracle()
{
    local name passed=0 files=("$root"/../shared/oracle/*.json)
    export -f start
    printf '#!/bin/bash\nbuild=%q prefix=%q\n%s\nstart osggpuanim.exe "$@"\n' "$build" "$prefix" "$(declare -f start)" \
        >"$folder/osggpuanim"
    chmod +x "$folder/osggpuanim"
    for name in "${files[@]##*/}"; do
        python3 "$root/tests/tool/check_oracle.py" "$folder/osggpuanim" gpu "$root/../shared" "$name" \
            nodes,skins,weights,positions,bbox >"$folder/logs/oracle.$name.log" 2>&1 || { echo "oracle: $name differs"; continue; }
        passed=$((passed + 1))
    done
    echo "oracle on the GPU path: $passed of ${#files[@]} within 1e-5"
    [ $passed -eq ${#files[@]} ]
}

# CPack's ZIP, unpacked into $folder/unpacked.
unpack_zip()
{
    rm -rf "$folder/zip" "$folder/unpacked"
    mkdir -p "$folder/unpacked"
    (cd "$build" && cpack -G ZIP -B "$folder/zip")
    (cd "$folder/unpacked" && cmake -E tar xf "$folder"/zip/*.zip)
}

# The picture of the stock viewer from the ZIP, with nothing on the paths, and that of Linux, from a build in build/. The
# windows are smaller than the screen, where Wine would not let one cover it; Wine's desktop is on one screen at a time.
compare_pictures()
(
    pictures=$folder/pictures
    mkdir -p "$pictures"
    options="clip=Run start=0.37 speed=0" scene=$root/scenes/Wanderer.glb.studio
    wineserver -k || true
    width=320 height=320
    source "$root/tests/viewer/screen.sh"
    OSG_LIBRARY_PATH=$root/build/lib show "$pictures/linux" -O "$options" "$scene"
    cd "$pictures/../unpacked"/*/bin
    osgviewer() { exec wine osgviewer.exe "$@"; }
    show "$pictures/windows" -O "$options" "Z:$scene"
    wineserver -k || true
    /usr/bin/python3 - "$pictures" $width <<'PYTHON'
import sys
import numpy as np
from PIL import Image
from skimage.color import deltaE_ciede2000, rgb2lab

folder, side = sys.argv[1], int(sys.argv[2])


def read(system):
    pixels = np.fromfile(f"{folder}/{system}", np.uint8)[-side * side * 4:].reshape(side, side, 4)[:256, :256, 2::-1]
    Image.fromarray(np.ascontiguousarray(pixels)).save(f"{folder}/{system}.png")
    return rgb2lab(pixels / 255)


difference = deltaE_ciede2000(read("linux"), read("windows"))
print(f"osgviewer.exe beside osgviewer: mean dE00 {difference.mean():.3f}, highest {difference.max():.1f}")
sys.exit(bool(difference.mean() > 1))  # of a numpy.bool_ it would print "False" and fail
PYTHON
)

install_missing cmake ninja-build g++-mingw-w64-x86-64-posix libz-mingw-w64-dev wine wine64 xvfb xauth dpkg-dev \
    libglm-dev nlohmann-json3-dev libcli11-dev libtinygltf-dev googletest python3-skimage python3-pil
mkdir -p "$folder"
fetch_sources "$folder" openscenegraph libpng1.6 libjpeg-turbo meshoptimizer
[ -f "$prefix/lib/libgtest.a" ] || build_small_libraries
[ -f "$prefix/bin/osgviewer.exe" ] || build_osg
build_kit
export WINEPREFIX=$folder/wine WINEDEBUG=-all WINEDLLOVERRIDES=mscoree,mshtml= LIBGL_ALWAYS_SOFTWARE=1
if [ -z "${DISPLAY:-}" ] || [ -z "${OSGGPUANIMATION_SCREEN:-}" ]; then # the rest on a screen of its own
    exec env OSGGPUANIMATION_SCREEN=1 xvfb-run -a -s '-screen 0 1280x1024x24' "${BASH_SOURCE[0]}" "$@"
fi
[ -d "$WINEPREFIX/drive_c" ] || wineboot -i
failures=0
run_tests "${1:+$(IFS='|' && echo "$*")}"
judge_tests || failures=$((failures + 1))
run_oracle || failures=$((failures + 1))
unpack_zip
compare_pictures || failures=$((failures + 1))
exit $failures
