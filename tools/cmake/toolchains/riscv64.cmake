# riscv64 (RV64GC), freestanding.
# SPDX-License-Identifier: Apache-2.0
set(GRIDIRON_TARGET riscv64)
set(GRIDIRON_TARGET_FLAGS "-mcmodel=medany")
include(${CMAKE_CURRENT_LIST_DIR}/freestanding_linux_gnu.cmake)
