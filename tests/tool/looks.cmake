# SPDX-License-Identifier: MIT
# A test for each reference picture of the shared looks: looks.Fox.studioGLTest, say.
file(GLOB look_files CONFIGURE_DEPENDS RELATIVE ${OSGGPUANIMATION_SHARED_ASSETS}/looks/pictures
     ${OSGGPUANIMATION_SHARED_ASSETS}/looks/pictures/*.png)
list(FILTER look_files EXCLUDE REGEX "integrated")
foreach(look_file IN LISTS look_files)
    string(REGEX REPLACE "\\.png$" "" look ${look_file})
    add_test(NAME looks.${look}GLTest
             COMMAND ${CMAKE_CURRENT_LIST_DIR}/check_looks.py $<TARGET_FILE:osggpuanim>
                     ${OSGGPUANIMATION_SHARED_ASSETS} ${look})
    set_tests_properties(looks.${look}GLTest PROPERTIES TIMEOUT 120)
endforeach()
