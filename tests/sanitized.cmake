# SPDX-License-Identifier: MIT
# What .ci/run runs under the sanitizers, as one program with nothing more to compile: sanitized.ViewersGLTest…
# With ThreadSanitizer what has several threads, with AddressSanitizer also what clones, releases, keeps and reads.
set(sanitized_sources nodes/TestCharacter.cpp mesh/Tube.cpp nodes/BackgroundLevelsTest.cpp
    frame/NestedCameraGLTest.cpp nodes/ViewersGLTest.cpp
    plugin/PagerGLTest.cpp plugin/ConcurrentLoadsTest.cpp gltf/ModelBuilder.cpp)
if(OSGGPUANIMATION_SANITIZER STREQUAL address)
    list(APPEND sanitized_sources nodes/AnimatedCharacterGLTest.cpp nodes/AnimatedCrowdGLTest.cpp
         frame/CharacterDrawsGLTest.cpp nodes/EventChangesTest.cpp frame/GlCallTrace.cpp frame/GlObjectsGLTest.cpp
         plugin/CloningGLTest.cpp serializers/SerializersGLTest.cpp)
endif()
add_executable(sanitized_tests EXCLUDE_FROM_ALL ${sanitized_sources} $<TARGET_OBJECTS:test_support>)
# Those with names like others have stay apart.
list(FILTER sanitized_sources INCLUDE REGEX "GLTest|GlCallTrace")
set_source_files_properties(${sanitized_sources} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
target_link_libraries(sanitized_tests PRIVATE osgGpuAnimation_build osgGpuAnimation_gltf TinyGLTF::TinyGLTF
                      nlohmann_json::nlohmann_json ${OSGSHADOW_LIBRARIES} GTest::gtest GTest::gtest_main)
set_target_properties(sanitized_tests PROPERTIES ENABLE_EXPORTS ON) # for GlCallTrace
target_include_directories(sanitized_tests PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
target_compile_definitions(sanitized_tests PRIVATE OSGGPUANIMATION_SHARED_ASSETS="${OSGGPUANIMATION_SHARED_ASSETS}"
                           OSGGPUANIMATION_PLUGIN_FOLDER="${CMAKE_LIBRARY_OUTPUT_DIRECTORY}"
                           OSGGPUANIMATION_SCENES="${PROJECT_SOURCE_DIR}/scenes")
add_dependencies(sanitized_tests osgdb_gltf osgdb_crowd osgdb_studio osgdb_serializers_osggpuanimation)
# The rest of what is installed: clang has warnings of its own, which one build shows.
foreach(installed osggpuanim osgdb_assimp osgdb_gpuanim)
    if(TARGET ${installed} AND OSGGPUANIMATION_SANITIZER STREQUAL address)
        add_dependencies(sanitized_tests ${installed})
    endif()
endforeach()
gtest_discover_tests(sanitized_tests TEST_PREFIX sanitized. DISCOVERY_TIMEOUT 60
                     PROPERTIES TIMEOUT ${test_timeout} ENVIRONMENT "${discovered_environment}")
