# SPDX-License-Identifier: MIT
# Installs BUILD into STAGE, a folder of the test's own, new each time.
file(REMOVE_RECURSE ${STAGE})
execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD} --prefix ${STAGE} OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
