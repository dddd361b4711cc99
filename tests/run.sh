#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Usage: tests/run.sh [ctest's options, -R Fox for instance]
# Installs what is missing on a Debian (12, 13 or sid), builds everything into build/ and runs every test. Exit status 0: all passed.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

install_missing "${view_packages[@]}" "${test_packages[@]}"
configure_release -DBUILD_TESTING=ON
build_targets
ctest --test-dir "$build" -j2 --output-on-failure --no-tests=error "$@"
