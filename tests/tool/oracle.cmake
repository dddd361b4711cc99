# SPDX-License-Identifier: MIT
# A test for each pose file of the shared oracle and each evaluator: oracle.gpu.Fox.1_Walk, say.
file(GLOB oracle_files CONFIGURE_DEPENDS RELATIVE ${OSGGPUANIMATION_SHARED_ASSETS}/oracle
     ${OSGGPUANIMATION_SHARED_ASSETS}/oracle/*.json)
find_package(Python3 REQUIRED COMPONENTS Interpreter)
foreach(oracle_file IN LISTS oracle_files)
    string(REGEX REPLACE "\\.json$" "" oracle_name ${oracle_file})
    set(sections nodes,skins,weights,positions,bbox)
    foreach(evaluator gpu cpu)
        set(name oracle.${evaluator}.${oracle_name})
        add_test(NAME ${name}
                 COMMAND ${Python3_EXECUTABLE} ${CMAKE_CURRENT_LIST_DIR}/check_oracle.py $<TARGET_FILE:osggpuanim>
                         ${evaluator} ${OSGGPUANIMATION_SHARED_ASSETS} ${oracle_file} ${sections})
        set_tests_properties(${name} PROPERTIES TIMEOUT 120)
    endforeach()
endforeach()
