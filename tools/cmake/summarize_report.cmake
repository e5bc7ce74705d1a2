# Prints the main figures of a render report in six lines: cmake -D REPORT=file.json -P summarize_report.cmake
# SPDX-License-Identifier: Apache-2.0
file(READ "${REPORT}" report)

# integer(OUT keys...): the value at `keys`, truncated to an integer (cycles, of which there are millions).
function(integer out)
  string(JSON value GET "${report}" ${ARGN})
  string(REGEX REPLACE "\\..*$" "" value "${value}")
  set(${out} ${value} PARENT_SCOPE)
endfunction()

# tenths(OUT value): 123 -> 12.3
function(tenths out value)
  math(EXPR whole "${value} / 10")
  math(EXPR rest "${value} % 10")
  set(${out} "${whole}.${rest}" PARENT_SCOPE)
endfunction()

string(JSON machine GET "${report}" machine name)
integer(clock_hz machine clock_hz)
integer(frame_cycles frame cycles)
integer(triangles scene triangles)
integer(arena_bytes local_store arena_bytes)
integer(code_bytes local_store code_bytes)
integer(stack_bytes local_store stack_bytes)

string(JSON core_count LENGTH "${report}" cores)
math(EXPR last_core "${core_count} - 1")
set(wait 0)
set(init 0)
set(compute 0)
set(idle 0)
set(bytes 0)
foreach(core RANGE ${last_core})
  string(JSON level_count LENGTH "${report}" cores ${core} dma_wait_cycles)
  math(EXPR last_level "${level_count} - 1")
  foreach(index RANGE ${last_level})
    string(JSON level MEMBER "${report}" cores ${core} dma_wait_cycles ${index})
    integer(value cores ${core} dma_wait_cycles ${level})
    math(EXPR wait "${wait} + ${value}")
  endforeach()
  foreach(part init compute idle)
    integer(value cores ${core} ${part}_cycles)
    math(EXPR ${part} "${${part}} + ${value}")
  endforeach()
  foreach(direction in out)
    integer(value cores ${core} dma bytes_${direction})
    math(EXPR bytes "${bytes} + ${value}")
  endforeach()
endforeach()

# Data ends where the last region does; alignment between regions counts.
string(JSON region_count LENGTH "${report}" local_store regions)
math(EXPR last_region "${region_count} - 1")
integer(last_offset local_store regions ${last_region} offset)
integer(last_bytes local_store regions ${last_region} bytes)
math(EXPR data_bytes "${last_offset} + ${last_bytes}")

math(EXPR all "${frame_cycles} * ${core_count}")
foreach(part init compute wait idle)
  math(EXPR share "(${${part}} * 1000 + ${all} / 2) / ${all}")
  tenths(${part}_percent ${share})
endforeach()
math(EXPR fps_tenths "(${clock_hz} * 10 + ${frame_cycles} / 2) / ${frame_cycles}")
tenths(fps ${fps_tenths})
math(EXPR clock_tenths "${clock_hz} / 100000000")
tenths(clock_ghz ${clock_tenths})
math(EXPR megabytes_tenths "(${bytes} * 10 + 524288) / 1048576")
tenths(megabytes ${megabytes_tenths})

set(lines
  "scene       ${triangles} triangles"
  "machine     ${machine}: ${core_count} cores at ${clock_ghz} GHz"
  "frame       ${frame_cycles} cycles, ${fps} frames a second"
  "cycles      ${compute_percent} % computing, ${init_percent} % starting, ${wait_percent} % waiting for DMA, ${idle_percent} % idle"
  "DMA         ${megabytes} MB moved"
  "local store ${data_bytes} bytes of data, ${stack_bytes} reserved for the stack, ${code_bytes} for code, of ${arena_bytes}")
foreach(line IN LISTS lines)
  execute_process(COMMAND ${CMAKE_COMMAND} -E echo "${line}")
endforeach()
