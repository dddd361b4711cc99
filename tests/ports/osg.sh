#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Usage: tests/ports/osg.sh [TEST...]
# Builds Debian's OSG without the fixed pipeline (OPENGL_PROFILE=GLCORE, from its source package) and this kit with it in
# build-osg/, and runs the GL tests there, or those whose names match the regular expressions TEST. What build-osg/ has
# already is kept and used again. The first time takes 40 minutes on two processors. Exit status 0: the tests passed.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../setup.sh"
source "$root/tests/ports/sources.sh"

folder=$root/build-osg
source=$folder/sources/openscenegraph
osg=$folder/osg
build=$folder/kit
# Tests that compare with what this OSG lacks or does otherwise.
without=(
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
    # time, which the warnings of this OSG take
    CloningGLTest.theFirstFrame
    # a program that prepareFirstDraw() does not foresee in a core profile
    FirstDrawGLTest.theFirstFrame ReadmeStartGLTest.aSceneIsCompiled
)

# The libraries that the kit links and the plugins that its tests need.
build_osg()
{
    local libraries=(OpenThreads osg osgUtil osgDB osgGA osgText osgViewer osgAnimation osgShadow osgFX)
    local formats=(osg png jpeg rgb hdr bmp tga rot)
    local plugins=("${formats[@]/#/osgdb_}" osgdb_serializers_osg{,animation,viewer,shadow,fx})
    local options=(-DOPENGL_PROFILE=GLCORE -DBUILD_OSG_APPLICATIONS=OFF -DBUILD_OSG_PLUGINS_BY_DEFAULT=OFF -Wno-dev)
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
fetch_sources openscenegraph
[ -d "$osg/lib" ] || build_osg
export OSG_DIR=$osg LD_LIBRARY_PATH=$osg/lib
configure_release -DBUILD_TESTING=ON
build_targets
[ $# -eq 0 ] || without=(nothing)
ctest --test-dir "$build" --no-tests=error -j "$(nproc)" --output-on-failure -R "$(IFS='|' && echo "${*:-GLTest}")" \
    -E "$(IFS='|' && echo "${without[*]}")"
