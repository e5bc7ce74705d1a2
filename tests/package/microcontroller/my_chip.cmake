# The toolchain file of the firmware's own project.
# SPDX-License-Identifier: Apache-2.0
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR arm)
set(CMAKE_C_COMPILER arm-none-eabi-gcc)
set(CMAKE_CXX_COMPILER arm-none-eabi-g++)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
set(CMAKE_C_FLAGS_INIT "-mcpu=cortex-m7 -mfpu=fpv5-d16 -mfloat-abi=hard -mthumb")
# C++ headers of the package g++-arm-linux-gnueabihf: core needs no C++ library, but its headers.
file(GLOB headers /usr/arm-linux-gnueabihf/include/c++/*)
list(GET headers 0 headers)
string(CONCAT CMAKE_CXX_FLAGS_INIT "${CMAKE_C_FLAGS_INIT} -nostdinc++ -isystem ${headers}"
  " -isystem ${headers}/arm-linux-gnueabihf -isystem /usr/arm-linux-gnueabihf/include")
set(CMAKE_CXX_STANDARD_LIBRARIES "-lgcc")
set(CMAKE_CXX_FLAGS_RELEASE "-O2 -DNDEBUG" CACHE STRING "Flags of a Release build")
