#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Usage: tests/gpu/missing.sh
# setup.sh lists every GL test program; pack.sh and go.sh fail and say what is missing, and go.sh deletes nobody's files.
# Exit status 0: they do.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
source "$here/../setup.sh"
unset OUT LIMIT FILTER GPU BENCH

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
project=$folder/parent/project
other=$folder/other
programs=("${gl_tests[@]}" osggpuanim osggpuanim_benchmark)

fail()
{
    echo "missing.sh: $*" >&2
    exit 1
}

# expect MESSAGE SCRIPT ARGUMENT...
expect()
{
    local status=0
    bash "${@:2}" >"$folder/said" 2>&1 || status=$?
    [ $status -ne 0 ] && grep -qF "$1" "$folder/said" && return
    fail "expected a failure with \"$1\", found exit status $status and: $(cat "$folder/said")"
}

# without PART COMMAND...: while that file or folder has another name.
without()
{
    mv "$1" "$folder/hidden"
    "${@:2}"
    mv "$folder/hidden" "$1"
}

expect_from_go()
{
    tar -C "$folder/contents" -cJf "$other/pack.tar.xz" .
    expect "$1" "$other/go.sh" tests
}

for file in "$here"/../*/*GLTest.cpp; do
    tests=$(basename "$(dirname "$file")")
    program=$(sed -nE "s/^ *osggpuanimation_tests\\((\w+) FOLDERS [a-z ]*\\b$tests\\b.*/\\1_tests/p" "$here/../CMakeLists.txt")
    [[ " ${gl_tests[*]} " == *" $program "* ]] || fail "gl_tests in tests/setup.sh lacks $program"
done

# A project whose programs and libraries are empty files.
mkdir -p "$project"/{scenes/directing,tests/{gpu,tool},build/{bin,lib/osgPlugins-0}}
mkdir -p "$folder"/parent/shared/{assets,oracle,bad_gltf,looks/{models,pictures}}
cp "$here/../setup.sh" "$project/tests"
cp "$here"/{pack,go}.sh "$project/tests/gpu"
touch "$project"/{scenes/Wanderer.glb,tests/tool/check_{oracle,looks}.py,build/lib/{libours.so,osgPlugins-0/{osgdb_ours.so,osggpuanim_assimp}}}
touch "$folder/parent/shared/looks/compare.py"
for program in "${programs[@]}"; do
    install -m 755 /dev/null "$project/build/bin/$program"
done

expect "CMakeCache.txt is missing" "$project/tests/gpu/pack.sh"
printf '%s\n' "CMAKE_HOME_DIRECTORY:INTERNAL=$project" "OSGGPUANIMATION_SHARED_ASSETS:PATH=$folder/parent/shared" \
    >"$project/build/CMakeCache.txt"
expect "ldd cannot read $project/build/bin/osggpuanim" "$project/tests/gpu/pack.sh"
for part in "${programs[@]/#/project/build/bin/}" project/build/lib/osgPlugins-0/{osgdb_ours.so,osggpuanim_assimp} \
    project/scenes/{Wanderer.glb,directing} project/tests/tool/check_{oracle,looks}.py \
    shared/{assets,oracle,bad_gltf,looks/{models,pictures,compare.py}}; do
    missing=$part
    case $part in *.glb | *.so) missing=$(dirname "$part")/\*.${part##*.} ;; esac
    without "$folder/parent/$part" expect "${missing#project/} is missing" "$project/tests/gpu/pack.sh"
    parts+=("$part")
done

# A pack of these files, beside which somebody has a project and ../shared of his own.
mkdir -p "$other"/{project,shared,out}
touch "$other"/{project,shared}/theirs "$other/out/benchmark.json"
cp "$here/go.sh" "$other"
expect "expected tests, poses, looks, gpu or bench, found pictures" "$other/go.sh" pictures
expect "there is no $other/pack.tar.xz" "$other/go.sh" tests
cp -r "$folder/parent" "$folder/contents"
mkdir "$folder/contents/libraries"
printf '%s\n' "$folder"/linked/{project,shared} >"$folder/contents/paths"
printf '%s\n' "${gl_tests[@]}" >"$folder/contents/tests"
printf '%s\n' "${parts[@]}" >"$folder/contents/parts"
for part in paths tests parts "${parts[@]}"; do
    without "$folder/contents/$part" expect_from_go "$part is not in the pack"
done
tool=$folder/contents/project/build/bin/osggpuanim
printf '%s\n' '#!/bin/bash' 'exec sleep 30' >"$tool"
LIMIT=2 expect_from_go "the tool does not evaluate a pose, exit status 124"
printf '%s\n' '#!/bin/bash' 'echo "a CPU" >"${!#}"' >"$tool"
expect_from_go "the tool's pose names no GPU"
[ -f "$other/project/theirs" ] && [ -f "$other/shared/theirs" ] || fail "go.sh deleted files that are not its own"
[ ! -e "$other/out/benchmark.json" ] || fail "go.sh kept figures of an earlier run"
