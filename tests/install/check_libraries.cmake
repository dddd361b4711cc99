# SPDX-License-Identifier: MIT
# The programs and libraries below FOLDER name no folder of BUILD (said by READELF), and the loader finds all they need.
file(GLOB_RECURSE files ${FOLDER}/*.so ${FOLDER}/*.so.* ${FOLDER}/bin/* ${FOLDER}/usr/bin/*
     ${FOLDER}/osggpuanim_assimp)
list(LENGTH files count)
if(count LESS 8)
    message(FATAL_ERROR "${count} programs and libraries in ${FOLDER}, where there should be 8 at least")
endif()
foreach(file IN LISTS files)
    execute_process(COMMAND ${READELF} -d ${file} OUTPUT_VARIABLE header COMMAND_ERROR_IS_FATAL ANY)
    string(FIND "${header}" "${BUILD}" at)
    if(at GREATER_EQUAL 0)
        message(SEND_ERROR "${file} looks for libraries in the build folder:\n${header}")
    endif()
    execute_process(COMMAND ldd ${file} OUTPUT_VARIABLE libraries COMMAND_ERROR_IS_FATAL ANY)
    if(libraries MATCHES "not found")
        message(SEND_ERROR "${file} needs what is not found:\n${libraries}")
    endif()
endforeach()
