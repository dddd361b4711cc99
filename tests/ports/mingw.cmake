# SPDX-License-Identifier: MIT
# CMake's toolchain file for Windows by Debian's MinGW-w64, with C++'s threads of the system (posix). CMAKE_PREFIX_PATH or
# CMAKE_FIND_ROOT_PATH tells where cross-built libraries are; what Debian installs for itself is not looked at.
set(CMAKE_SYSTEM_NAME Windows)
set(CMAKE_SYSTEM_PROCESSOR x86_64)
set(CMAKE_C_COMPILER x86_64-w64-mingw32-gcc-posix)
set(CMAKE_CXX_COMPILER x86_64-w64-mingw32-g++-posix)
set(CMAKE_RC_COMPILER x86_64-w64-mingw32-windres)
list(APPEND CMAKE_FIND_ROOT_PATH /usr/x86_64-w64-mingw32)
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
# Libraries with many symbols, and big object files of Debug.
set(CMAKE_CXX_FLAGS_INIT -Wa,-mbig-obj)
