# SPDX-License-Identifier: MIT
# Run by the installation on Windows, with the folders of OSG's programs and of the compiler's libraries: what the
# installed programs and plugins need comes to lie beside the programs, except for the system's own libraries.
set(programs $ENV{DESTDIR}${CMAKE_INSTALL_PREFIX}/${PROGRAMS})
file(GLOB executables ${programs}/*.exe)
file(GLOB libraries ${programs}/*.dll)
file(GLOB modules ${programs}/*/*.dll)
if(CMAKE_HOST_UNIX)
    set(CMAKE_GET_RUNTIME_DEPENDENCIES_PLATFORM windows+pe)
    set(CMAKE_GET_RUNTIME_DEPENDENCIES_TOOL objdump)
    set(CMAKE_GET_RUNTIME_DEPENDENCIES_COMMAND ${OBJDUMP})
endif()
file(GET_RUNTIME_DEPENDENCIES EXECUTABLES ${executables} LIBRARIES ${libraries} MODULES ${modules}
     DIRECTORIES ${programs} ${FOLDERS} PRE_EXCLUDE_REGEXES "^(api-ms|ext-ms)-" POST_EXCLUDE_REGEXES "[Ss]ystem32/"
     RESOLVED_DEPENDENCIES_VAR found UNRESOLVED_DEPENDENCIES_VAR system)
list(FILTER found EXCLUDE REGEX "^${programs}/")
file(INSTALL ${found} DESTINATION ${programs})
message(STATUS "Not installed, but of the system: ${system}")
