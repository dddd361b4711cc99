# SPDX-License-Identifier: MIT
# cmake -DFILES=a;b -DHEADER=out.h -P embed.cmake
set(content "// Made by shaders/embed.cmake from the files it names.\n#pragma once\n\nnamespace osgGpuAnimation::shaders\n{\n")
foreach(file IN LISTS FILES)
    get_filename_component(name ${file} NAME)
    string(MAKE_C_IDENTIFIER ${name} identifier)
    file(READ ${file} text)
    string(APPEND content "inline constexpr char ${identifier}[] = R\"glsl(${text})glsl\";\n")
endforeach()
string(APPEND content "} // namespace osgGpuAnimation::shaders\n")
file(WRITE ${HEADER} "${content}")
