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
# A program's GL tests. This driver leaves an object out of a frame in about one of 250 runs of a test that renders to a
# texture (NestedCameraGLTest, the same before and after changes of the kit; llvmpipe's OpenGL never), and has ended one
# process of about forty. So what a signal ended, or a test that failed, runs once more, and is named.
run()
{
    local log status filter='*GLTest.*'
    log=$(mktemp)
    for attempt in 1 2; do
        status=0
        "$1" --gtest_filter="$filter" >"$log" 2>&1 || status=$?
        [ $status -ne 0 ] || break
        if [ $status -ge 128 ]; then
            echo "zink: signal $((status - 128)) ended $(basename "$1") in: $(grep -a '^\[ RUN' "$log" | tail -n 1)"
        else
            cat "$log"
            filter=$(sed -n '/ listed below:$/,$ s/^\[  FAILED  \] \([^ ,]*\.[^ ,]*\).*/\1/p' "$log" | paste -sd:)
            echo "zink: failed in $(basename "$1"), attempt $attempt: $filter"
            [ -n "$filter" ] || break
        fi
    done
    grep -aE '^\[==|^\[  PASSED|SKIPPED|: Skipped' "$log" || true
    rm -f "$log"
    return $status
}
export -f run
# Two programs at a time, each in a context of its own.
printf '%s\n' "${gl_tests[@]}" | xargs -P 2 -I '{}' bash -c 'run "$1/$2"' bash "$1" '{}'
