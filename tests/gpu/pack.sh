#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Usage: tests/gpu/pack.sh, after tests/run.sh has built everything
# Puts two files into .gpu/: pack.tar.xz, with the test programs that need GL, the tool, the benchmark, the plugins,
# each shared library that they need, models and expected results; and go.sh, which unpacks and runs them on a machine
# with a graphics card and nothing installed. Results in .gpu/out/ stay. Exit status 0: nothing is missing.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../setup.sh"

# OSG's own plugins: pictures, scene files with the wrappers of OSG's libraries, pseudo-loaders.
plugins=(png jpeg hdr rgb tga bmp osg ive rot trans scale deprecated_osg deprecated_osganimation deprecated_osgviewer
    osgshadow serializers_osg serializers_osganimation serializers_osgviewer serializers_osgshadow serializers_osgfx)
# The C library is the machine's own.
c_library='/(ld-linux-x86-64|lib(c|m|dl|rt|pthread|resolv))[.]so'

fail()
{
    echo "pack.sh: $*" >&2
    exit 1
}

# copy FROM... TO_FOLDER; go.sh expects each in the pack.
copy()
{
    local from
    for from in "${@:1:$#-1}"; do
        [ -e "$from" ] || fail "$from is missing; tests/run.sh builds everything, and the characters are in ../shared"
        echo "${!#}/${from##*/}" >>"$pack/parts"
    done
    mkdir -p "$pack/${!#}"
    cp -a "${@:1:$#-1}" "$pack/${!#}"
    chmod -R u+w "$pack/${!#}"
}

# Finds the libraries that packed programs, libraries and plugins load at their start, and lists the paths of those
# that are not in the pack.
find_libraries()
{
    find "$pack"/{libraries,project/build} -type f \( -perm -u+x -o -name '*.so*' \) -print0 |
        LD_LIBRARY_PATH=$pack/project/build/lib:$pack/libraries xargs -0 ldd >"$scratch/ldd" || fail "ldd cannot read a packed file"
    if grep 'not found' "$scratch/ldd" >&2; then
        fail "the libraries named above are missing"
    fi
    awk -v pack="$pack/" -v c_library="$c_library" \
        '$2 == "=>" && $3 ~ "^/" && index($3, pack) != 1 && $3 !~ c_library { print $3 }' "$scratch/ldd" |
        sort -u >"$scratch/libraries"
}

# A path that the tests were compiled with.
cached()
{
    sed -n "s/^$1:[A-Z]*=//p" "$build/CMakeCache.txt"
}

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
pack=$scratch/pack
mkdir "$pack"
[ -f "$build/CMakeCache.txt" ] || fail "$build/CMakeCache.txt is missing; tests/run.sh builds everything"
shared=$(cached OSGGPUANIMATION_SHARED_ASSETS)
{ cached CMAKE_HOME_DIRECTORY && echo "$shared"; } >"$pack/paths"
printf '%s\n' "${gl_tests[@]}" >"$pack/tests"

copy "${gl_tests[@]/#/$build/bin/}" "$build"/bin/osggpuanim{,_benchmark} project/build/bin
ours=("$build"/lib/osgPlugins-*)
copy "$build"/lib/*.so* project/build/lib
copy "${ours[0]}"/{*.so,osggpuanim_assimp} "project/build/lib/${ours[0]##*/}"
copy "$root"/scenes/*.glb "$root/scenes/directing" project/scenes
copy "$root"/tests/tool/check_{oracle,looks}.py project/tests/tool
copy "$shared"/{assets,oracle,bad_gltf} shared
copy "$shared"/looks/{models,pictures,compare.py} shared/looks
osgdb=$(ldd "$build/bin/osggpuanim" | awk '/libosgDB/ { print $3 }') || fail "ldd cannot read $build/bin/osggpuanim"
theirs=$(dirname "$osgdb")/${ours[0]##*/}
plugins=("${plugins[@]/#/$theirs/osgdb_}")
copy "${plugins[@]/%/.so}" "libraries/${ours[0]##*/}"

find_libraries
while read -r library; do
    cp -L "$library" "$pack/libraries"
done <"$scratch/libraries"
find_libraries
if grep . "$scratch/libraries" >&2; then
    fail "packed files load the libraries named above from outside of the pack"
fi
find "$pack"/{libraries,project/build} -type f -exec strip {} +

mkdir -p "$root/.gpu"
tar -C "$pack" -c . | xz -T0 -3 >"$root/.gpu/pack.tar.xz"
cp "$root/tests/gpu/go.sh" "$root/.gpu"
echo ".gpu/pack.tar.xz has $(($(stat -c %s "$root/.gpu/pack.tar.xz") >> 20)) MiB"
