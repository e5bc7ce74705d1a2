# Cross-compiles for Linux with a Debian cross compiler. The including file sets GRIDIRON_TARGET, the system's name, and
# GRIDIRON_QEMU, the emulator. Libraries are found where Debian's multiarch packages put them.
# SPDX-License-Identifier: Apache-2.0
set(CMAKE_SYSTEM_NAME Linux)
string(REGEX REPLACE "-.*" "" CMAKE_SYSTEM_PROCESSOR ${GRIDIRON_TARGET})
set(CMAKE_C_COMPILER ${GRIDIRON_TARGET}-gcc)
set(CMAKE_CXX_COMPILER ${GRIDIRON_TARGET}-g++)
set(CMAKE_FIND_ROOT_PATH /usr/${GRIDIRON_TARGET})
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_CROSSCOMPILING_EMULATOR "${GRIDIRON_QEMU};-L;/usr/${GRIDIRON_TARGET}")
