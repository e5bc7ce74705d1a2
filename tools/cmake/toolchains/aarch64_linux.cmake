# Linux on aarch64. SPDX-License-Identifier: Apache-2.0
set(GRIDIRON_TARGET aarch64-linux-gnu)
set(GRIDIRON_QEMU qemu-aarch64)
include(${CMAKE_CURRENT_LIST_DIR}/linux_gnu.cmake)
