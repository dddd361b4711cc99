#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Usage: tests/zink.sh FOLDER_OF_TEST_PROGRAMS
# Runs the GL tests on another driver than llvmpipe's OpenGL: Mesa's zink, over llvmpipe's Vulkan. Debian:
# mesa-vulkan-drivers. Exit status 0: all passed, and none was skipped.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

XDG_RUNTIME_DIR=$(mktemp -d) # Vulkan's loader complains without one.
export XDG_RUNTIME_DIR
trap 'rm -rf "$XDG_RUNTIME_DIR"' EXIT
export LIBGL_ALWAYS_SOFTWARE=1 MESA_LOADER_DRIVER_OVERRIDE=zink OSGGPUANIMATION_REQUIRE_GL=1
# Each GL test fails where OpenGL's renderer has another name.
export OSGGPUANIMATION_RENDERER=zink
VK_ICD_FILENAMES=$(echo /usr/share/vulkan/icd.d/lvp_icd.*.json)
export VK_ICD_FILENAMES
# Without display lists, which this driver of Debian 12 loses: it leaves one out of a frame now and then, or ends the
# process, also where a quad of OSG with a vertex buffer and a shader joins two quads with lists (8 of 7,800 viewers).
export OSG_VERTEX_BUFFER_HINT=VBO
# A program's GL tests. One that a signal ends runs once more, and the test that it ended is named: this driver has ended one
# process of about forty, and none twice in a row. A test that fails is not repeated.
run()
{
    local log status
    log=$(mktemp)
    for attempt in 1 2; do
        status=0
        "$1" --gtest_filter='*GLTest.*' >"$log" 2>&1 || status=$?
        [ $status -ge 128 ] || break
        echo "zink: signal $((status - 128)) ended $(basename "$1"), attempt $attempt, in: $(grep -a '^\[ RUN' "$log" | tail -n 1)"
    done
    if [ $status -eq 0 ]; then
        grep -aE '^\[==|^\[  PASSED|SKIPPED|: Skipped' "$log"
    else
        cat "$log"
    fi
    rm -f "$log"
    return $status
}
export -f run
# Two programs at a time, each in a context of its own.
printf '%s\n' "${gl_tests[@]}" | xargs -P 2 -I '{}' bash -c 'run "$1/$2"' bash "$1" '{}'
