# SPDX-License-Identifier: MIT
# Checks which symbols leave the programs and libraries below FOLDER, as NM lists them. The loader binds equal names of
# two libraries to one of them, so another build of a third party's code in the process must not meet ours: no file
# exports it, and only functions of the kit mention its types in their parameters (GLM's); run-time type information of
# function types (GCC 14) is the same from any build. A plugin exports osgdb_NAME.
set(third_parties "8tinygltf|8nlohmann|3CLI|5draco|3glm|stbi|stb_")
set(function_types "^_ZT[IS]P?F")
set(ours "^_ZN[KVRO]*15osgGpuAnimation|${function_types}")

file(GLOB_RECURSE files ${FOLDER}/*.so ${FOLDER}/*.so.*.* ${FOLDER}/bin/* ${FOLDER}/osggpuanim_assimp)
list(LENGTH files count)
if(count LESS 8)
    message(FATAL_ERROR "${count} programs and libraries in ${FOLDER}, where there should be 8 at least")
endif()
foreach(file IN LISTS files)
    get_filename_component(name ${file} NAME)
    execute_process(COMMAND ${NM} --dynamic --defined-only --format=just-symbols ${file}
                    OUTPUT_VARIABLE symbols COMMAND_ERROR_IS_FATAL ANY)
    string(REGEX REPLACE "[][;]" "|" symbols "${symbols}") # which would split a list
    string(REGEX MATCHALL "[^\n]+" symbols "${symbols}")
    set(suspects ${symbols})
    if(NOT name MATCHES "^osgdb_")
        list(FILTER suspects INCLUDE REGEX "${third_parties}")
    endif()
    set(faults "")
    foreach(symbol IN LISTS suspects)
        string(REPLACE "3glm" "" without_glm "${symbol}")
        if((name MATCHES "^osgdb_" AND NOT symbol MATCHES "^osgdb_[a-z]+$")
           OR (symbol MATCHES "${third_parties}" AND NOT symbol MATCHES "${ours}")
           OR (without_glm MATCHES "${third_parties}" AND NOT symbol MATCHES "${function_types}"))
            string(APPEND faults "\n  ${symbol}")
        endif()
    endforeach()
    list(LENGTH symbols count)
    message(STATUS "${name}: ${count} symbols")
    if(faults)
        message(SEND_ERROR "${name} exports:${faults}")
    endif()
endforeach()
