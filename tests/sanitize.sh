#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Usage: tests/sanitize.sh [ctest's options]
# Builds what tests/sanitized.cmake lists with ThreadSanitizer into build-thread/ and runs it. Exit
# status 0: all passed, and the sanitizer had nothing to report.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

build=$root/build-thread

install_missing "${packages[@]}"
# Unity: the headers are read once for many files. -O1: a Debug build would draw too slowly.
cmake -S "$root" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG=-O1 \
      -DOSGGPUANIMATION_SANITIZER=thread -DOSGGPUANIMATION_UNITY=ON
cmake --build "$build" --parallel "$(nproc)" --target sanitized_tests
ctest --test-dir "$build" -j2 --output-on-failure --no-tests=error -R '^sanitized\.' "$@"
