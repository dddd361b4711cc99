# SPDX-License-Identifier: MIT
# A test for each model, where Khronos's validator is there: validator.Fox.glb, say.
set(OSGGPUANIMATION_NODE_MODULES "" CACHE PATH
    "Folder node_modules with the npm package gltf-validator: written .glb files are validated where it exists")
find_program(NODE_PROGRAM node)
if(NODE_PROGRAM AND EXISTS "${OSGGPUANIMATION_NODE_MODULES}/gltf-validator/package.json")
    file(GLOB validated_files CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/scenes/*.glb ${OSGGPUANIMATION_SHARED_ASSETS}/assets/*/*.gl*
         ${OSGGPUANIMATION_SHARED_ASSETS}/assets/*/*.fbx ${OSGGPUANIMATION_SHARED_ASSETS}/assets/*/*.bvh)
    if(NOT TARGET osgGpuAnimation_assimp)
        list(FILTER validated_files INCLUDE REGEX "\\.gl")
    endif()
    if(EXISTS ${OSGGPUANIMATION_SHARED_ASSETS}/assets/nathan/nathan.osg)
        list(APPEND validated_files ${OSGGPUANIMATION_SHARED_ASSETS}/assets/nathan/nathan.osg.gpuanim)
    endif()
    foreach(validated_file IN LISTS validated_files)
        cmake_path(GET validated_file FILENAME name)
        add_test(NAME validator.${name} COMMAND ${NODE_PROGRAM} ${CMAKE_CURRENT_LIST_DIR}/check_glb.js
                                                $<TARGET_FILE:osggpuanim> ${validated_file})
        set_tests_properties(validator.${name} PROPERTIES TIMEOUT 120 ENVIRONMENT
            "NODE_PATH=${OSGGPUANIMATION_NODE_MODULES};OSG_LIBRARY_PATH=${CMAKE_LIBRARY_OUTPUT_DIRECTORY}")
    endforeach()
endif()
