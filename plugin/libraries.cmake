# SPDX-License-Identifier: MIT
# tinygltf, and what the kit can do without: OSGGPUANIMATION_WITH_NAME is on where the library is found, and can be
# switched off. CMake's summary says what its absence costs. OSGGPUANIMATION_NAME is the target to link.
include(FeatureSummary)

find_package(nlohmann_json REQUIRED) # a static tinygltf names it
find_package(TinyGLTF QUIET)
if(NOT TARGET TinyGLTF::TinyGLTF) # vcpkg has the header alone
    find_path(TINYGLTF_INCLUDE_DIR tiny_gltf.h REQUIRED)
    file(CONFIGURE OUTPUT tinygltf.cpp CONTENT "#define TINYGLTF_IMPLEMENTATION\n#include <tiny_gltf.h>\n")
    add_library(osgGpuAnimation_tinygltf STATIC EXCLUDE_FROM_ALL ${PROJECT_BINARY_DIR}/tinygltf.cpp)
    target_include_directories(osgGpuAnimation_tinygltf SYSTEM PUBLIC ${TINYGLTF_INCLUDE_DIR})
    target_compile_definitions(osgGpuAnimation_tinygltf PUBLIC TINYGLTF_NO_STB_IMAGE TINYGLTF_NO_STB_IMAGE_WRITE)
    add_library(TinyGLTF::TinyGLTF ALIAS osgGpuAnimation_tinygltf)
endif()

# Looks for the library as find_NAME() does, which defines TARGET.
macro(osggpuanimation_optional name target loss)
    option(OSGGPUANIMATION_WITH_${name} "Use the library where it is found; otherwise ${loss}" ON)
    if(OSGGPUANIMATION_WITH_${name})
        cmake_language(CALL find_${name})
    endif()
    if(OSGGPUANIMATION_WITH_${name} AND TARGET ${target})
        set(OSGGPUANIMATION_${name} ${target})
    else()
        set(OSGGPUANIMATION_WITH_${name} OFF)
    endif()
    add_feature_info(OSGGPUANIMATION_WITH_${name} OSGGPUANIMATION_WITH_${name} "otherwise ${loss}")
endmacro()

# A target of a library without a CMake package.
function(osggpuanimation_library target header library)
    find_path(${library}_INCLUDE_DIR ${header})
    find_library(${library}_LIBRARY ${library})
    if(${library}_INCLUDE_DIR AND ${library}_LIBRARY)
        add_library(${target} INTERFACE IMPORTED GLOBAL)
        target_include_directories(${target} SYSTEM INTERFACE ${${library}_INCLUDE_DIR})
        target_link_libraries(${target} INTERFACE ${${library}_LIBRARY})
    endif()
endfunction()

macro(find_EGL)
    find_package(OpenGL QUIET OPTIONAL_COMPONENTS EGL)
endmacro()
macro(find_DRACO)
    find_package(draco CONFIG QUIET)
    if(TARGET draco::draco AND NOT TARGET draco::draco_static)
        add_library(draco::draco_static ALIAS draco::draco)
    endif()
endmacro()
macro(find_MESHOPTIMIZER)
    find_package(meshoptimizer CONFIG QUIET)
endmacro()
macro(find_PNG)
    find_package(PNG QUIET)
endmacro()
# libjpeg-turbo's CMake package wants libjpeg-dev's files too.
macro(find_TURBOJPEG)
    osggpuanimation_library(osgGpuAnimation_turbojpeg turbojpeg.h turbojpeg)
endmacro()
# Debian's libwebp-dev has no CMake package.
macro(find_WEBP)
    osggpuanimation_library(osgGpuAnimation_webp webp/decode.h webp)
endmacro()
# assimp's own CMake package wants the libraries that libassimp is linked with, among them libdraco.
macro(find_ASSIMP)
    find_package(ZLIB QUIET) # the arrays of binary FBX
    if(ZLIB_FOUND AND CMAKE_SYSTEM_NAME STREQUAL "Linux") # prctl limits the helper program
        osggpuanimation_library(osgGpuAnimation_libassimp assimp/scene.h assimp)
    endif()
endmacro()
macro(find_OSGANIMATION)
    find_package(osgAnimation QUIET)
    if(OSGANIMATION_FOUND)
        add_library(osgGpuAnimation_libosgAnimation INTERFACE IMPORTED)
        target_link_libraries(osgGpuAnimation_libosgAnimation INTERFACE ${OSGANIMATION_LIBRARIES})
    endif()
endmacro()
macro(find_CLI11)
    find_package(CLI11 CONFIG QUIET)
endmacro()

osggpuanimation_optional(EGL OpenGL::EGL "pictures without a window need a display: no EglGraphicsContext")
osggpuanimation_optional(DRACO draco::draco_static "files with KHR_draco_mesh_compression are refused")
osggpuanimation_optional(MESHOPTIMIZER meshoptimizer::meshoptimizer
    "files with EXT_meshopt_compression are refused, and triangles keep the file's order, which may draw slower")
osggpuanimation_optional(PNG PNG::PNG "OSG's plugin reads and writes PNG, with the gamma that a file names")
osggpuanimation_optional(TURBOJPEG osgGpuAnimation_turbojpeg "OSG's plugin reads JPEG, slower")
osggpuanimation_optional(WEBP osgGpuAnimation_webp "WebP textures (EXT_texture_webp) are left out")
osggpuanimation_optional(ASSIMP osgGpuAnimation_libassimp "no .fbx and other formats: no plugin osgdb_assimp")
osggpuanimation_optional(OSGANIMATION osgGpuAnimation_libosgAnimation
    "scenes of osgAnimation are not converted: no plugin .gpuanim, no osgGpuAnimation::osganimation")
osggpuanimation_optional(CLI11 CLI11::CLI11 "no command osggpuanim")
