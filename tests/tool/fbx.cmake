# SPDX-License-Identifier: MIT
# A test for each FBX file of the shared cases: cases.fbx_small_offsets, say.
file(GLOB fbx_files CONFIGURE_DEPENDS ${OSGGPUANIMATION_SHARED_ASSETS}/cases/fbx_*.fbx
     ${OSGGPUANIMATION_SHARED_ASSETS}/cases/fbx/*.fbx)
foreach(fbx_file IN LISTS fbx_files)
    cmake_path(GET fbx_file STEM LAST_ONLY name)
    add_test(NAME cases.${name} COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_LIST_DIR}/check_fbx.py
                                        $<TARGET_FILE:osggpuanim> ${OSGGPUANIMATION_SHARED_ASSETS}/cases ${name})
    set_tests_properties(cases.${name} PROPERTIES TIMEOUT 120)
endforeach()
