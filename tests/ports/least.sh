#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Usage: tests/ports/least.sh
# The kit with OSG, GLM, tinygltf and nlohmann json alone: every OSGGPUANIMATION_WITH_… is off, and OSG's plugins read the
# pictures. Builds it in build-least/ and runs all its tests, the stock osgviewer over Wanderer.glb among them.
# Then a project that has the kit as a part and links it statically (tests/install/embedded), in build-embedded/. GL needs a
# display without EGL: Xvfb's. The first time takes half an hour on two processors. Exit status 0: all passed.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../setup.sh"

install_missing "${view_packages[@]}" "${test_packages[@]}"
off=()
for part in EGL DRACO MESHOPTIMIZER PNG TURBOJPEG WEBP ASSIMP OSGANIMATION CLI11; do
    off+=("-DOSGGPUANIMATION_WITH_$part=OFF")
done
# Tests of what OSG's own classes do otherwise.
without=(
    # OSG's pbuffer of X11 has no core profile, and does not tell apart contexts that share
    CoreProfile Core33 Core45
    # OSG's plugin for PNG applies the gamma that a file names
    PictureTest.gammaDoesNotCount
)

build=$root/build-least
configure_release -DBUILD_TESTING=ON "${off[@]}"
build_targets
# Without -noreset the server starts anew, and refuses programs meanwhile, whenever its only client leaves.
OSGGPUANIMATION_REQUIRE_GL=1 xvfb-run -a -s -noreset ctest --test-dir "$build" --no-tests=error -j "$(nproc)" \
    --output-on-failure -E "$(IFS='|' && echo "${without[*]}")"

embedded=$root/build-embedded
cmake -S "$root/tests/install/embedded" -B "$embedded" -G Ninja -DCMAKE_BUILD_TYPE=Release -DOSGGPUANIMATION_UNITY=ON "${off[@]}"
cmake --build "$embedded" --parallel "$(nproc)" --target embedded
"$embedded/embedded" "$root/scenes/Wanderer.glb" "$embedded/Wanderer.osgt"
