# SPDX-License-Identifier: MIT
# cmake -DFILES=a;b -DHEADER=out.h -P embed.cmake
set(content "// Made by shaders/embed.cmake from the files it names.\n#pragma once\n\nnamespace osgGpuAnimation::shaders\n{\n")
foreach(file IN LISTS FILES)
    get_filename_component(name ${file} NAME)
    string(MAKE_C_IDENTIFIER ${name} identifier)
    file(READ ${file} text)
    string(APPEND content "inline constexpr char ${identifier}[] =")
    string(LENGTH "${text}" length)
    foreach(begin RANGE 0 ${length} 12000) # MSVC takes 16,380 characters at once
        string(SUBSTRING "${text}" ${begin} 12000 piece)
        string(APPEND content " R\"glsl(${piece})glsl\"")
    endforeach()
    string(APPEND content ";\n")
endforeach()
string(APPEND content "} // namespace osgGpuAnimation::shaders\n")
file(WRITE ${HEADER} "${content}")
