# gridiron_lanes_test(NAME sources... LIBS libs...): a test for the baseline and, if compiler and host have them, again
# for AVX2 with 8 lanes and AVX-512 with 16, which take other code paths. Each is a program of its own, so that
# functions built for different instruction sets never replace each other.
# SPDX-License-Identifier: Apache-2.0
include_guard(DIRECTORY)
include(CheckCXXSourceRuns)
include(CMakePushCheckState)

set(GRIDIRON_LANES_avx2 8)
set(GRIDIRON_LANES_avx512 16)
set(GRIDIRON_LANES_OPTIONS_avx2 -mavx2 -mfma)
set(GRIDIRON_LANES_OPTIONS_avx512 -mavx512f -mavx512bw -mavx512dq -mavx512vl)
set(GRIDIRON_LANES_FEATURES_avx2 "__builtin_cpu_supports(\"avx2\") && __builtin_cpu_supports(\"fma\")")
set(GRIDIRON_LANES_FEATURES_avx512 "__builtin_cpu_supports(\"avx512dq\") && __builtin_cpu_supports(\"avx512vl\")")
foreach(isa avx2 avx512)
  cmake_push_check_state(RESET)
  list(JOIN GRIDIRON_LANES_OPTIONS_${isa} " " CMAKE_REQUIRED_FLAGS)
  check_cxx_source_runs(
    "int main() { __builtin_cpu_init(); return (${GRIDIRON_LANES_FEATURES_${isa}}) ? 0 : 1; }"
    GRIDIRON_HOST_RUNS_${isa})
  cmake_pop_check_state()
endforeach()

function(gridiron_lanes_test name)
  gridiron_test(${name} ${ARGN})
  foreach(isa avx2 avx512)
    if(GRIDIRON_WIDE_LANES AND GRIDIRON_HOST_RUNS_${isa})
      gridiron_test(${name}_${isa} OWN_INSTRUCTIONS ${ARGN})
      target_compile_options(${name}_${isa} PRIVATE ${GRIDIRON_LANES_OPTIONS_${isa}})
      target_compile_definitions(${name}_${isa} PRIVATE GRIDIRON_TEST_LANES=${GRIDIRON_LANES_${isa}})
    endif()
  endforeach()
endfunction()
