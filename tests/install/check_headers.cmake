# SPDX-License-Identifier: MIT
# The headers below INSTALLED are HEADERS, no more and no fewer.
file(GLOB_RECURSE installed RELATIVE ${INSTALLED} ${INSTALLED}/*)
list(SORT installed)
list(SORT HEADERS)
if(NOT installed STREQUAL HEADERS)
    message(FATAL_ERROR "installed: ${installed}\nthere are: ${HEADERS}")
endif()
