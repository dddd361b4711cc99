#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Usage: tests/ports/osg.sh [core|float|static] [TEST...]
# Builds Debian's OSG otherwise, from its source package, and this kit with it:
#   core    without the fixed pipeline (OPENGL_PROFILE=GLCORE), in build-osg/
#   float   with float matrices, planes and quaternions (OSG_USE_FLOAT_MATRIX and so on), in build-osg-float/
#   static  static libraries and plugins, and with them tests/install/embedded, in build-osg-static/
# and runs the GL tests there, or those whose names match the regular expressions TEST; for `static`, the program embedded.
# What the folder has already is kept and used again. The first time takes 40 minutes on two processors. Exit status 0:
# the tests passed.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../setup.sh"
source "$root/tests/ports/sources.sh"

variant=core
if [[ "${1:-}" =~ ^(core|float|static)$ ]]; then
    variant=$1
    shift
fi
folder=$root/build-osg-$variant
[ $variant != core ] || folder=$root/build-osg
source=$root/build-osg/sources/openscenegraph # of all variants
osg=$folder/osg
build=$folder/kit
# Tests that compare with what this OSG lacks or does otherwise; float matrices need none.
without=(nothing)
[ $variant != core ] || without=(
    # the fixed pipeline's look, a compatibility profile, drawables of a host without shaders
    '(SurfaceGLTest|SurfaceNeedGLTest|PlacedSurfacesGLTest|ProfilesGLTest)' EglGraphicsContextGLTest.isACompat
    ProfileGLTest.osgsLights EnvironmentGLTest.even HostGLTest.hooksApplyInDepth ShaderKeyGLTest.holes
    ShaderLanguageGLTest ReadmeShadersGLTest CharacterDrawsGLTest.drawnTogether SurfaceColorsGLTest.theTextureMatrix
    # lighting that is on unless it is switched off, and lights without a LightSource
    'PbrLightGLTest' 'PbrMaterialGLTest' LightsGLTest AnimatedPropertiesGLTest.stored ProfileGLTest.overridden
    looks.furnace # without lights a core profile has a headlight
    # osgShadow and osgFX
    ShadowGLTest ShadowPluginGLTest
    # its record of buffers in vertex array objects, programs whose matrices contexts share, warnings of its own
    BindingsGLTest JoiningModelsGLTest ViewersGLTest.contextsThatShare 'TwoContextsGLTest.*Shared' SerializersGLTest
    # drawings of osgAnimation, plugins that are not built here
    ConvertedScenesGLTest CommandFailuresGLTest PlantedPluginsGLTest
    # a program that prepareFirstDraw() does not foresee in a core profile
    FirstDrawGLTest.theFirstFrame ReadmeStartGLTest.aSceneIsCompiled
)

# The libraries that the kit links and the plugins that its tests need.
build_osg()
{
    local libraries=(OpenThreads osg osgUtil osgDB osgGA osgText osgViewer osgAnimation osgShadow osgFX)
    local formats=(osg png jpeg rgb hdr bmp tga rot)
    local plugins=("${formats[@]/#/osgdb_}" osgdb_osgshadow osgdb_deprecated_osg{,animation}
        osgdb_serializers_osg{,animation,viewer,shadow,fx})
    # No paths in OSG's libraries: CMake may end them with an empty element, for which the loader takes the current folder.
    local options=(-DBUILD_OSG_APPLICATIONS=OFF -DBUILD_OSG_PLUGINS_BY_DEFAULT=OFF -DBUILD_OSG_PLUGIN_SHADOW=ON
        -DCMAKE_SKIP_RPATH=ON -Wno-dev)
    case $variant in
        core) options+=(-DOPENGL_PROFILE=GLCORE) ;;
        float) options+=(-DOSG_USE_FLOAT_{MATRIX,PLANE,QUAT}=ON) ;;
        static) options+=(-DDYNAMIC_OPENTHREADS=OFF -DDYNAMIC_OPENSCENEGRAPH=OFF) ;;
    esac
    for format in "${formats[@]}"; do
        options+=("-DBUILD_OSG_PLUGIN_${format^^}=ON")
    done
    cmake -S "$source" -B "$folder/osg-build" -G Ninja "${options[@]}" -DCMAKE_BUILD_TYPE=Release -DLIB_POSTFIX=
    cmake --build "$folder/osg-build" --parallel "$(nproc)" --target "${libraries[@]}" "${plugins[@]}"
    rm -rf "$osg"
    mkdir "$osg"
    cp -a "$source/include" "$folder/osg-build"/{include,lib} "$osg"
}

install_missing "${view_packages[@]}" "${test_packages[@]}" libx11-dev libxrandr-dev
mkdir -p "$folder"
fetch_sources "$root/build-osg" openscenegraph
[ -d "$osg/lib" ] || build_osg
export OSG_DIR=$osg LD_LIBRARY_PATH=$osg/lib
if [ $variant = static ]; then
    # Static libraries need each other, and the system's; -DOSG_LIBRARY_STATIC makes main.cpp name OSG's plugins.
    libraries=("$osg"/lib/*.a) # the plugins are among them
    others=(-lpng -ljpeg -lz -lfontconfig -lX11 -lXrandr -lXext -lGL -ldl -lpthread)
    cmake -S "$root/tests/install/embedded" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DOSGGPUANIMATION_UNITY=ON \
        -DCMAKE_CXX_FLAGS=-DOSG_LIBRARY_STATIC \
        "-DCMAKE_CXX_STANDARD_LIBRARIES=-Wl,--start-group ${libraries[*]} -Wl,--end-group ${others[*]}"
    cmake --build "$build" --parallel "$(nproc)" --target embedded
    exec "$build/embedded" "$root/scenes/Wanderer.glb" "$build/Wanderer.osgt"
fi
configure_release -DBUILD_TESTING=ON
build_targets
[ $# -eq 0 ] || without=(nothing)
ctest --test-dir "$build" --no-tests=error -j "$(nproc)" --output-on-failure -R "$(IFS='|' && echo "${*:-GLTest}")" \
    -E "$(IFS='|' && echo "${without[*]}")"
