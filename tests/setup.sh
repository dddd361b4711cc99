# SPDX-License-Identifier: MIT
# The set-up that .ci/run and the scripts in scenes/ and tests/ share; for `source`, not to be run. It sets `root` (the
# repository), `build` (its build folder) and lists of packages and programs, and offers install_missing PACKAGE...,
# configure_release [CMAKE'S OPTION...] and build_targets [TARGET...].

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=$root/build

# Names that every release of Debian has. Packages for building and viewing.
view_packages=(
    g++ cmake ninja-build
    libopenscenegraph-dev libtinygltf-dev libdraco-dev libmeshoptimizer-dev libglm-dev libcli11-dev nlohmann-json3-dev
    libpng-dev zlib1g-dev libturbojpeg0-dev libwebp-dev libassimp-dev
    libgl-dev libegl-dev openscenegraph libgl1-mesa-dri
)
# Further packages for the tests, and for .ci/run.
test_packages=(
    libgtest-dev libbenchmark-dev glslang-tools python3 python3-skimage python3-scipy python3-pil xvfb xauth dpkg-dev file
    pkgconf
)
ci_packages=(git clang clang-format doxygen mesa-vulkan-drivers mmdebstrap)
# The test programs with suites named ...GLTest, for other drivers; tests/gpu/missing.sh checks that none is left out.
gl_tests=(gpu_tests nodes_tests plugin_tests tool_tests osganimation_tests)

is_installed()
{
    [ "$(dpkg-query -W -f='${db:Status-Status}' "$1" 2>/dev/null)" = installed ]
}

as_root()
{
    if [ "$(id -u)" -eq 0 ]; then
        "$@"
    elif command -v sudo >/dev/null; then
        sudo "$@"
    else
        echo "Please run as root (there is no sudo): $*" >&2
        return 1
    fi
}

# Installs those of the packages that are not there yet; touches nothing where all are.
install_missing()
{
    if ! command -v apt-get >/dev/null || ! command -v dpkg-query >/dev/null; then
        echo "This is no Debian: packages like these should be there: $*" >&2
        return 0
    fi
    local package missing=()
    for package in "$@"; do
        is_installed "$package" || missing+=("$package")
    done
    [ ${#missing[@]} -gt 0 ] || return 0
    echo "Installing: ${missing[*]}"
    as_root env DEBIAN_FRONTEND=noninteractive apt-get update -q
    as_root env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends "${missing[@]}"
}

# Configures a release build in $build. Unless an option says otherwise, a new folder has no tests and compiles several
# sources as one (not with OSGGPUANIMATION_UNITY=OFF in the environment); an existing folder keeps its settings.
# OSGGPUANIMATION_WERROR=ON in the environment makes warnings errors.
configure_release()
{
    local options=()
    # A build folder keeps the generator it was made with.
    [ -f "$build/CMakeCache.txt" ] || options=(-G Ninja -DBUILD_TESTING=OFF "-DOSGGPUANIMATION_UNITY=${OSGGPUANIMATION_UNITY:-ON}")
    [ -z "${OSGGPUANIMATION_WERROR:-}" ] || options+=("-DOSGGPUANIMATION_WERROR=$OSGGPUANIMATION_WERROR")
    cmake -S "$root" -B "$build" "${options[@]}" -DCMAKE_BUILD_TYPE=Release "$@"
}

# Builds the targets in $build, or everything.
build_targets()
{
    cmake --build "$build" --parallel "$(nproc)" ${1:+--target "$@"}
}
