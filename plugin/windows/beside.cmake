# SPDX-License-Identifier: MIT
# CPack runs this before it makes the ZIP. It copies OSG's viewer, converter, libraries and plugins, and all libraries that
# these and ours need except the system's, beside the programs. The target package_source has no programs.
if(CPACK_INSTALLED_DIRECTORIES)
    return()
endif()
set(programs "${CPACK_TEMPORARY_DIRECTORY}/${CPACK_PROGRAMS}")
file(INSTALL "${CPACK_OSG_FOLDER}/bin/osgviewer.exe" "${CPACK_OSG_FOLDER}/bin/osgconv.exe" DESTINATION "${programs}" OPTIONAL)
file(INSTALL "${CPACK_OSG_FOLDER}/bin/" DESTINATION "${programs}" FILES_MATCHING PATTERN *.dll)
file(GLOB executables "${programs}/*.exe")
file(GLOB libraries "${programs}/*.dll")
file(GLOB modules "${programs}/*/*.dll")
if(CMAKE_HOST_UNIX)
    set(CMAKE_GET_RUNTIME_DEPENDENCIES_PLATFORM windows+pe)
    set(CMAKE_GET_RUNTIME_DEPENDENCIES_TOOL objdump)
    set(CMAKE_GET_RUNTIME_DEPENDENCIES_COMMAND "${CPACK_OBJDUMP}")
endif()
file(GET_RUNTIME_DEPENDENCIES EXECUTABLES ${executables} LIBRARIES ${libraries} MODULES ${modules}
     DIRECTORIES "${programs}" ${CPACK_COMPILER_FOLDERS} PRE_EXCLUDE_REGEXES "^(api-ms|ext-ms)-"
     POST_EXCLUDE_REGEXES "[Ss]ystem32/" RESOLVED_DEPENDENCIES_VAR found UNRESOLVED_DEPENDENCIES_VAR of_the_system)
foreach(library IN LISTS found)
    cmake_path(IS_PREFIX programs "${library}" NORMALIZE is_there)
    if(NOT is_there)
        file(INSTALL "${library}" DESTINATION "${programs}")
    endif()
endforeach()
