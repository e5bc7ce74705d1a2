# aarch64 (ARMv8-A with NEON), freestanding.
# SPDX-License-Identifier: Apache-2.0
set(GRIDIRON_TARGET aarch64)
set(GRIDIRON_TARGET_FLAGS "-mstrict-align -mno-outline-atomics")
include(${CMAKE_CURRENT_LIST_DIR}/freestanding_linux_gnu.cmake)
