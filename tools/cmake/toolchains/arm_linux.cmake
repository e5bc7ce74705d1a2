# Linux on 32-bit Arm (ARMv7-A with VFP, hard-float calls). SPDX-License-Identifier: Apache-2.0
set(GRIDIRON_TARGET arm-linux-gnueabihf)
set(GRIDIRON_QEMU qemu-arm)
include(${CMAKE_CURRENT_LIST_DIR}/linux_gnu.cmake)
