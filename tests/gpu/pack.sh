#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Usage: tests/gpu/pack.sh, after tests/run.sh has built everything
# Puts two files into .gpu/: pack.tar.xz, with the test programs that need GL, the tool, the benchmark, the plugins,
# each shared library that they need, models and expected results; and go.sh, which unpacks and runs them on a machine
# with a graphics card and nothing installed. Exit status 0: nothing is missing, and it is small enough to travel.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../setup.sh"

most=$((64 << 20)) # bytes that may travel, the repository's own files included
programs=(gpu_tests nodes_tests plugin_tests tool_tests osganimation_tests osggpuanim osggpuanim_benchmark)
# OSG's own plugins: pictures, scene files with the wrappers of OSG's libraries, pseudo-loaders.
plugins=(png jpeg hdr rgb tga bmp osg ive rot trans scale deprecated_osg deprecated_osganimation deprecated_osgviewer
    serializers_osg serializers_osganimation serializers_osgviewer serializers_osgshadow serializers_osgfx)
# The C library is the machine's own.
c_library='/(ld-linux-x86-64|lib(c|m|dl|rt|pthread|resolv))\.so'

fail()
{
    echo "pack.sh: $*" >&2
    exit 1
}

# copy FROM... TO_FOLDER
copy()
{
    local from
    for from in "${@:1:$#-1}"; do
        [ -e "$from" ] || fail "$from is missing; tests/run.sh builds everything, and the characters are in ../shared"
    done
    mkdir -p "${!#}"
    cp -a "$@"
}

# The path of each shared library that the packed programs load at their start.
libraries()
{
    find "$project/build" -type f \( -perm -u+x -o -name '*.so*' \) -print0 |
        LD_LIBRARY_PATH=$project/build/lib xargs -0 ldd >"$pack/ldd"
    if grep 'not found' "$pack/ldd" >&2; then
        fail "the libraries named above are missing"
    fi
    awk '$2 == "=>" && $3 ~ "^/" { print $3 }' "$pack/ldd" | sort -u | grep -vE "$c_library"
}

# A path that the tests were compiled with.
cached()
{
    sed -n "s/^$1:[A-Z]*=//p" "$build/CMakeCache.txt"
}

pack=$(mktemp -d)
trap 'rm -rf "$pack"' EXIT
project=$pack/project
[ -f "$build/CMakeCache.txt" ] || fail "$build/CMakeCache.txt is missing; tests/run.sh builds everything"
shared=$(cached OSGGPUANIMATION_SHARED_ASSETS)
{ cached CMAKE_HOME_DIRECTORY && echo "$shared"; } >"$pack/paths"

copy "${programs[@]/#/$build/bin/}" "$project/build/bin"
copy "$build"/lib/*.so* "$build"/lib/osgPlugins-* "$project/build/lib"
ours=("$project"/build/lib/osgPlugins-*)
osgdb=$(ldd "$build/bin/osggpuanim" | awk '/libosgDB/ { print $3 }')
theirs=$(dirname "$osgdb")/$(basename "${ours[0]}")
for plugin in "${plugins[@]}"; do
    copy "$theirs/osgdb_$plugin.so" "${ours[0]}"
done
copy "$root"/scenes/*.glb "$root/scenes/directing" "$project/scenes"
copy "$root/tests/plugin/fixtures" "$project/tests/plugin"
copy "$root"/tests/tool/check_*.py "$project/tests/tool"
copy "$shared"/{assets,oracle,looks,bad_gltf} "$pack/shared"

libraries >"$pack/libraries"
while read -r library; do
    [[ $library == "$pack"/* || $library == "$build"/* ]] || cp -L "$library" "$project/build/lib"
done <"$pack/libraries"
# With the system's libraries hidden, everything is found in the pack.
if libraries | grep -vE "^($pack|$build)/" >&2; then
    fail "the libraries named above were not packed"
fi
rm "$pack/ldd" "$pack/libraries"
find "$project/build" -type f -exec strip {} +

rm -rf "$root/.gpu"
mkdir "$root/.gpu"
tar -C "$pack" -c . | xz -T0 -3 >"$root/.gpu/pack.tar.xz"
cp "$root/tests/gpu/go.sh" "$root/.gpu"
bytes=$(du -cb "$root"/.gpu/* | awk 'END { print $1 }')
tree=$(cd "$root" && git -c safe.directory='*' ls-files -z | du -cb --files0-from=- | awk 'END { print $1 }')
echo ".gpu has $((bytes >> 20)) MiB, the repository's files $((tree >> 20)) MiB"
[ $((bytes + tree)) -le $most ] || fail "more than the $((most >> 20)) MiB that may travel"
