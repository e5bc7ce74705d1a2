# Cortex-M7 with double-precision FPU and newlib (Debian: gcc-arm-none-eabi, libstdc++-arm-none-eabi-newlib). An example
# for a bare chip: change the three lines of flags.
# SPDX-License-Identifier: Apache-2.0
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR arm)
set(CMAKE_C_COMPILER arm-none-eabi-gcc)
set(CMAKE_CXX_COMPILER arm-none-eabi-g++)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
set(CMAKE_CXX_FLAGS_INIT "-mcpu=cortex-m7 -mfpu=fpv5-d16 -mfloat-abi=hard -mthumb")
# Size matters on a core: -O3 makes more code of the kernel than its budget holds.
set(CMAKE_CXX_FLAGS_RELEASE "-O2 -DNDEBUG" CACHE STRING "Flags of a Release build")

# The host's package file of GLM would put the host's /usr/include before newlib's headers. This one makes a directory
# of GLM alone.
set(glm_DIR ${CMAKE_CURRENT_LIST_DIR}/glm CACHE PATH "GLM for freestanding cross builds" FORCE)
