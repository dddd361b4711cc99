# SPDX-License-Identifier: MIT
# `cpack -G DEB` makes two Debian packages: the libraries, plugins and the tool; and what a program of one's own is built
# with. Configure with -DCMAKE_INSTALL_PREFIX=/usr for Debian's own (multiarch) library folder. On Windows `cpack -G ZIP`
# makes a folder with everything beside the programs, OSG's viewer too.
set(CPACK_PACKAGE_NAME osggpuanimation)
set(CPACK_PACKAGE_VENDOR "the osgGpuAnimation authors")
set(CPACK_PACKAGE_CONTACT "the osgGpuAnimation authors")
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_STRIP_FILES ON)
set(CPACK_GENERATOR DEB)
set(CPACK_COMPONENTS_ALL runtime development)
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME libosggpuanimation${PROJECT_VERSION_MAJOR})
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${CMAKE_LIBRARY_OUTPUT_DIRECTORY})
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_RECOMMENDS openscenegraph)
set(CPACK_COMPONENT_RUNTIME_DESCRIPTION "GPU skeletal animation for OpenSceneGraph: libraries and plugins
 The plugins for .gltf, .glb, .crowd and for OSG's own formats, the node kit's library, and the tool osggpuanim.")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libosggpuanimation-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
    "libosggpuanimation${PROJECT_VERSION_MAJOR} (= ${PROJECT_VERSION}), libopenscenegraph-dev, libglm-dev, libgl-dev")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "GPU skeletal animation for OpenSceneGraph: headers and CMake package
 For find_package(osgGpuAnimation) and #include <osgGpuAnimation/nodes/AnimatedCharacter.h>.")

install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/libosggpuanimation${PROJECT_VERSION_MAJOR}
        RENAME copyright COMPONENT runtime)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/libosggpuanimation-dev
        RENAME copyright COMPONENT development)
if(WIN32)
    set(CPACK_GENERATOR ZIP)
    get_filename_component(CPACK_OSG_FOLDER ${OSG_INCLUDE_DIR} DIRECTORY)
    set(CPACK_PROGRAMS ${CMAKE_INSTALL_BINDIR})
    set(CPACK_COMPILER_FOLDERS ${CMAKE_CXX_IMPLICIT_LINK_DIRECTORIES})
    set(CPACK_OBJDUMP ${CMAKE_OBJDUMP})
    set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_CURRENT_LIST_DIR}/windows/beside.cmake)
endif()
include(CPack)
