# SPDX-License-Identifier: MIT
# An overlay port of this tree: vcpkg install osggpuanimation --overlay-ports=tests/ports/vcpkg
vcpkg_check_linkage(ONLY_DYNAMIC_LIBRARY) # a static installation has no plugins
set(SOURCE_PATH "${CMAKE_CURRENT_LIST_DIR}/../../../..")
vcpkg_check_features(OUT_FEATURE_OPTIONS options FEATURES
                     draco OSGGPUANIMATION_WITH_DRACO
                     meshoptimizer OSGGPUANIMATION_WITH_MESHOPTIMIZER
                     png OSGGPUANIMATION_WITH_PNG
                     turbojpeg OSGGPUANIMATION_WITH_TURBOJPEG
                     webp OSGGPUANIMATION_WITH_WEBP
                     assimp OSGGPUANIMATION_WITH_ASSIMP)
vcpkg_cmake_configure(SOURCE_PATH "${SOURCE_PATH}" OPTIONS ${options} -DBUILD_TESTING=OFF)
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(PACKAGE_NAME osgGpuAnimation CONFIG_PATH lib/cmake/osgGpuAnimation)
vcpkg_copy_tools(TOOL_NAMES osggpuanim AUTO_CLEAN)
vcpkg_copy_pdbs()
file(REMOVE_RECURSE "${CURRENT_PACKAGES_DIR}/debug/include" "${CURRENT_PACKAGES_DIR}/debug/share")
vcpkg_install_copyright(FILE_LIST "${SOURCE_PATH}/LICENSE")
