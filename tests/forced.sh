#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Usage: tests/forced.sh FOLDER_OF_TEST_PROGRAMS [PROGRAM...]
# Runs the GL tests (default: of all programs) as on lesser drivers, which Mesa's software renderer plays:
#     texels   buffer textures of 65,536 texels, the least of OpenGL 3.1 and later
#     gl33     OpenGL 3.3 without base instances and time stamps, in both profiles
# Exit status 0: all passed.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

folder=$1
programs=("${@:2}")
[ ${#programs[@]} -gt 0 ] || programs=("${gl_tests[@]}")
export OSGGPUANIMATION_REQUIRE_GL=1
faults=0
ran=0

# run WAY FILTER VARIABLE...: each suite in a process of its own; another context of a process may find OSG's GL objects
# of an earlier one.
run()
{
    local program log tests passed before=$ran
    log=$(mktemp)
    for program in "${programs[@]}"; do
        passed=0
        while read -r tests; do
            env "${@:3}" "$folder/$program" --gtest_filter="$tests" </dev/null >"$log" 2>&1 || { faults=$((faults + 1)) && cat "$log"; }
            passed=$((passed + $(grep -acE '^\[       OK \] ' "$log" || true)))
            ran=$((ran + $(grep -acE '^\[ RUN      \] ' "$log" || true)))
        done < <("$folder/$program" --gtest_list_tests --gtest_filter="$2" |
            awk '/^[^ ]/ {suite = $1} /^ / {of[suite] = of[suite] ":" suite $1} END {for (suite in of) print substr(of[suite], 2)}')
        echo "$1, $program: $passed passed"
    done
    rm -f "$log"
    [ "$ran" -gt "$before" ] || { echo "$1: no test ran"; faults=$((faults + 1)); }
}

# glslangValidator reads the same programs in each way.
gl='*GLTest*-ShaderLanguageGLTest.*'
# The keyframes of ../shared's Knight need 128,197 texels.
run texels "$gl:Models/*/Knight*" OSGGPUANIMATION_MAX_TEXELS=65536
# Mesa makes a context of the one profile where the other one is asked for.
lacks=MESA_EXTENSION_OVERRIDE='-GL_ARB_base_instance -GL_ARB_timer_query -GL_ARB_buffer_storage'
run gl33 "$gl:*Core*:Profile*" MESA_GL_VERSION_OVERRIDE=3.3COMPAT "$lacks"
run gl33core '*Core*GLTest*:*Profile*GLTest*:*.seesALesserDriver-*Core45' MESA_GL_VERSION_OVERRIDE=3.3 "$lacks"
[ $faults -eq 0 ]
