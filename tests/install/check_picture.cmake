# SPDX-License-Identifier: MIT
# PROGRAM draws MODEL into PICTURE, and not the background alone, of which a PNG takes 4 KB.
file(REMOVE ${PICTURE})
execute_process(COMMAND ${PROGRAM} ${MODEL} ${PICTURE} COMMAND_ERROR_IS_FATAL ANY)
file(SIZE ${PICTURE} bytes)
if(bytes LESS 15000)
    message(FATAL_ERROR "${PICTURE} has ${bytes} bytes, so there is nothing in it")
endif()
