# Cortex-M7 with double-precision FPU. An example for a bare chip: change the line of flags. It needs gcc-arm-none-eabi
# (Debian, 454 MB with binutils) and C++ headers, from either of two packages:
#   libstdc++-arm-none-eabi-newlib   newlib and its C++ library, 1.9 GB more; what it finds first
#   g++-arm-linux-gnueabihf          only headers are read; nothing of that library is linked
# SPDX-License-Identifier: Apache-2.0
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR arm)
set(CMAKE_C_COMPILER arm-none-eabi-gcc)
set(CMAKE_CXX_COMPILER arm-none-eabi-g++)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
set(GRIDIRON_TARGET_FLAGS "-mcpu=cortex-m7 -mfpu=fpv5-d16 -mfloat-abi=hard -mthumb")
set(CMAKE_C_FLAGS_INIT "${GRIDIRON_TARGET_FLAGS}")
set(CMAKE_ASM_FLAGS_INIT "${GRIDIRON_TARGET_FLAGS}")
set(CMAKE_CXX_FLAGS_INIT "${GRIDIRON_TARGET_FLAGS}")
file(GLOB newlib_headers /usr/include/newlib/c++/*)
file(GLOB linux_headers /usr/arm-linux-gnueabihf/include/c++/*)
if(NOT newlib_headers AND linux_headers)
  list(GET linux_headers 0 linux_headers)
  string(APPEND CMAKE_CXX_FLAGS_INIT " -nostdinc++ -isystem ${linux_headers}"
    " -isystem ${linux_headers}/arm-linux-gnueabihf -isystem /usr/arm-linux-gnueabihf/include")
endif()
# The compiler's helper library, behind all others: with -nostdlib it would not be there.
set(CMAKE_CXX_STANDARD_LIBRARIES "-lgcc")
# Size matters on a core: -O3 makes more code of the kernel than its budget holds.
set(CMAKE_CXX_FLAGS_RELEASE "-O2 -DNDEBUG" CACHE STRING "Flags of a Release build")
set(CMAKE_C_FLAGS_RELEASE "-O2 -DNDEBUG" CACHE STRING "Flags of a Release build")

# The host's package file of GLM would put the host's /usr/include before newlib's headers. This one makes a directory
# of GLM alone.
set(glm_DIR ${CMAKE_CURRENT_LIST_DIR}/glm CACHE PATH "GLM for freestanding cross builds" FORCE)
