#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Usage: tests/gpu/missing.sh
# pack.sh and go.sh fail and say what is missing. Exit status 0: they do.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir -p "$folder"/{build/bin,tests/gpu}
mkdir -p "$folder"/other/project/{build/{bin,lib/osgPlugins-0},scenes,tests/{plugin/fixtures,tool}}
mkdir -p "$folder"/other/shared/{assets,oracle,looks/{models,pictures}}
cp "$here/../setup.sh" "$folder/tests"
cp "$here"/{pack,go}.sh "$folder/tests/gpu"
cp "$here/go.sh" "$folder/other"
programs="gpu_tests nodes_tests plugin_tests tool_tests osganimation_tests osggpuanim osggpuanim_benchmark"

# expect MESSAGE SCRIPT ARGUMENT...
expect()
{
    local status=0
    bash "${@:2}" >"$folder/said" 2>&1 || status=$?
    [ $status -ne 0 ] && grep -qF "$1" "$folder/said" && return
    echo "expected a failure with \"$1\", found exit status $status and:" >&2
    cat "$folder/said" >&2
    exit 1
}

# programs_without FOLDER MISSING: all programs but that one.
programs_without()
{
    local program
    for program in $programs; do
        rm -f "$1/$program"
        [ "$program" = "$2" ] || install -m 755 /dev/null "$1/$program"
    done
}

expect "CMakeCache.txt is missing" "$folder/tests/gpu/pack.sh"
echo "OSGGPUANIMATION_SHARED_ASSETS:PATH=$folder/nowhere" >"$folder/build/CMakeCache.txt"
expect "there is no $folder/other/pack.tar.xz" "$folder/other/go.sh" tests
expect "expected tests, poses, looks or bench, found pictures" "$folder/other/go.sh" pictures
touch "$folder"/other/project/tests/tool/check_{oracle,looks}.py
for program in $programs; do
    programs_without "$folder/build/bin" "$program"
    expect "build/bin/$program is missing" "$folder/tests/gpu/pack.sh"
    programs_without "$folder/other/project/build/bin" "$program"
    tar -C "$folder/other" -cJf "$folder/other/pack.tar.xz" project shared
    expect "build/bin/$program is not in the pack" "$folder/other/go.sh" tests
done
