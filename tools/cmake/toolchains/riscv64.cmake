# riscv64 (RV64GC), freestanding.
set(GRIDIRON_TARGET riscv64)
set(GRIDIRON_TARGET_FLAGS "-mcmodel=medany")
include(${CMAKE_CURRENT_LIST_DIR}/freestanding_linux_gnu.cmake)
