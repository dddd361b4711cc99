#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Usage: tests/clang.sh [ctest's options]
# Builds everything with clang++ into build-clang/ and runs every test but those of installed packages, which tests/run.sh
# runs. Exit status 0: all passed.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

install_missing "${packages[@]}" clang
build=$root/build-clang
# Unity: the headers are read once for many files.
configure_release -DBUILD_TESTING=ON -DCMAKE_CXX_COMPILER=clang++ -DOSGGPUANIMATION_UNITY=ON
build_targets
ctest --test-dir "$build" -j2 --output-on-failure --no-tests=error -E '^install\.' "$@"
