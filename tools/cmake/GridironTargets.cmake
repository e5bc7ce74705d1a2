# Helpers that give every target of the project the same language level, warnings and floating-point rules.
# SPDX-License-Identifier: Apache-2.0

# All targets: C++20, warnings (errors with GRIDIRON_WERROR), no contraction anywhere (correctness depends on it),
# square roots as an instruction.
function(gridiron_target_defaults target)
  target_compile_features(${target} PUBLIC cxx_std_20)
  set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF)
  target_compile_options(${target} PRIVATE
    -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Wno-psabi
    $<$<BOOL:${GRIDIRON_WERROR}>:-Werror> -ffp-contract=off -fno-math-errno)
endfunction()

# Targets that must run without an operating system.
function(gridiron_freestanding target)
  target_compile_options(${target} PRIVATE
    -ffreestanding -fno-exceptions -fno-rtti -fno-threadsafe-statics -ffunction-sections)
  # tools/checks/memory_table measures builds without an operating system: without tables for unwinding, which are
  # unused, and with frames of a fixed size, none as large as the stack of a 256 KB core.
  if(NOT GRIDIRON_IS_HOSTED AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(${target} PRIVATE
      -fno-asynchronous-unwind-tables -fno-unwind-tables -Wvla -Walloca -Wstack-usage=8704)
  endif()
endfunction()

# A program's or test's sources, compiled a few at a time: most of the work is their headers. So names that are local to
# one source must differ from those of its neighbours.
function(gridiron_unity target)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 6)
endfunction()
