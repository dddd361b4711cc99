# SPDX-License-Identifier: MIT
# Makes the Debian packages of BUILD in FOLDER, and looks at what they hold, say and need. LIBDIR, PLUGINS: where the
# libraries and, below, the plugins go; VERSION: the project's.
file(REMOVE_RECURSE ${FOLDER})
# xz takes three times as long.
execute_process(COMMAND ${CPACK} -G DEB --config ${BUILD}/CPackConfig.cmake -D CPACK_DEBIAN_COMPRESSION_TYPE=gzip -B ${FOLDER}
                OUTPUT_QUIET ERROR_QUIET COMMAND_ERROR_IS_FATAL ANY)

# The one package of that name, unpacked into FOLDER/unpacked; sets `control` to what it says of itself.
macro(unpack name)
    file(GLOB package ${FOLDER}/${name}_${VERSION}*_*.deb)
    list(LENGTH package count)
    if(NOT count EQUAL 1)
        message(FATAL_ERROR "${count} packages ${name} of version ${VERSION} in ${FOLDER}, where there should be one")
    endif()
    execute_process(COMMAND ${DPKG_DEB} --info ${package} OUTPUT_VARIABLE control COMMAND_ERROR_IS_FATAL ANY)
    execute_process(COMMAND ${DPKG_DEB} --extract ${package} ${FOLDER}/unpacked COMMAND_ERROR_IS_FATAL ANY)
endmacro()

function(expect_said pattern)
    if(NOT control MATCHES "${pattern}")
        message(SEND_ERROR "the package does not say ${pattern}:\n${control}")
    endif()
endfunction()

function(expect_file file)
    if(NOT EXISTS ${FOLDER}/unpacked/usr/${file})
        message(SEND_ERROR "no usr/${file} in the package")
    endif()
endfunction()

unpack(libosggpuanimation1)
# A package of a library has its version in its name, which differs from one Debian to the next: libpng16-16t64.
foreach(library libopenscenegraph libmeshoptimizer libpng16- libturbojpeg libwebp libegl libstdc\\+\\+)
    expect_said("Depends:[^\n]* ${library}[0-9][0-9a-z]*[ ,\n]")
endforeach()
expect_said("shlibs")
foreach(plugin gltf glb osggpuanimation crowd serializers_osggpuanimation)
    expect_file(${LIBDIR}/${PLUGINS}/osgdb_${plugin}.so)
endforeach()
expect_file(${LIBDIR}/libosgGpuAnimation.so.1)
expect_file(${LIBDIR}/libosgGpuAnimation_osganimation.so.1)
expect_file(share/doc/libosggpuanimation1/copyright)
if(EXISTS ${FOLDER}/unpacked/usr/include)
    message(SEND_ERROR "headers in the package of the libraries")
endif()
execute_process(COMMAND ${CMAKE_COMMAND} -DFOLDER=${FOLDER}/unpacked -DBUILD=${BUILD} -DREADELF=${READELF}
                        -P ${CMAKE_CURRENT_LIST_DIR}/check_libraries.cmake COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${FOLDER}/unpacked/usr/bin/osggpuanim --help OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)

unpack(libosggpuanimation-dev)
expect_said("Depends: libosggpuanimation1 \\(= ${VERSION}\\), libopenscenegraph-dev, libglm-dev, libgl-dev\n")
expect_file(include/osgGpuAnimation/nodes/AnimatedCharacter.h)
expect_file(include/osgGpuAnimation/osganimation/SkeletonConversion.h)
expect_file(${LIBDIR}/libosgGpuAnimation.so)
expect_file(${LIBDIR}/cmake/osgGpuAnimation/osgGpuAnimationConfig.cmake)
