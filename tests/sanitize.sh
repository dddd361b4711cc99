#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Usage: tests/sanitize.sh [ctest's options]
# Builds what tests/sanitized.cmake lists with clang++: with ThreadSanitizer into build-thread/ and, with everything that is
# installed, with AddressSanitizer into build-address/. Runs the tests of that list. Exit status 0: no warnings of the
# compiler, all passed, and the sanitizers had nothing to report.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

install_missing "${view_packages[@]}" "${test_packages[@]}" clang
# Two plugins hold the import, one the other's equal: detect_odr_violation=1 reports what differs in size alone.
# AddressSanitizer reads the thread-local blocks of loaded libraries where a header of glibc 2.19 would say that they
# are; with today's glibc it follows whatever lies there and can crash. intercept_tls_get_addr=0 leaves them unread.
export ASAN_OPTIONS=detect_odr_violation=1:intercept_tls_get_addr=0
for sanitizer in thread address; do
    build=$root/build-$sanitizer
    # Unity: the headers are read once for many files. -O1: a Debug build would draw too slowly.
    cmake -S "$root" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG=-O1 \
          -DCMAKE_CXX_COMPILER=clang++ -DBUILD_TESTING=ON -DOSGGPUANIMATION_SANITIZER=$sanitizer \
          -DOSGGPUANIMATION_UNITY=ON -DOSGGPUANIMATION_WERROR=ON
    cmake --build "$build" --parallel "$(nproc)" --target sanitized_tests
    ctest --test-dir "$build" -j2 --output-on-failure --no-tests=error -R '^sanitized\.' "$@"
done
