# gridiron_c_library(): Gridiron's C interface, gridiron/c/gridiron.h, compiled for the layout of a firmware.
# SPDX-License-Identifier: Apache-2.0

# gridiron_c_library(NAME LAYOUT type LANES n [LAYOUT_HEADER header] [STORE_BYTES n] [QUEUE_DEPTH n] [BUDGETS]): a static
# library that C and C++ link; it calls gridiron_dma_get() and the others of the header, which the firmware defines.
#   LAYOUT         such as "StoreLayout256K<8>", of core/gridiron/store/local_store.h or of LAYOUT_HEADER.
#   LANES          4; 1 for layouts without packets on cores without vectors.
#   LAYOUT_HEADER  absolute path of a header with a layout of one's own, in any namespace that LAYOUT names.
#   STORE_BYTES    size of the layout's local store, for a static array: GRIDIRON_STORE_BYTES of NAME and what links it.
#                  Another number than the layout's does not compile; the compiler's message has both.
#   QUEUE_DEPTH    commands that the port holds; default 16, 1 is legal.
#   BUDGETS        defines the symbols that image_budgets.ld compares; for images, not for hosted programs.
# Without an optimization level in CMake's flags it is compiled with -O2. target_compile_options(NAME PRIVATE -Os) and the
# like come after that.
function(gridiron_c_library name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "BUDGETS" "LAYOUT;LANES;LAYOUT_HEADER;STORE_BYTES;QUEUE_DEPTH" "")
  if(NOT arg_LAYOUT OR NOT arg_LANES OR arg_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "gridiron_c_library(${name}): expected LAYOUT type LANES n, got '${ARGN}'")
  endif()
  get_property(source GLOBAL PROPERTY GRIDIRON_C_SOURCE)
  get_property(kit GLOBAL PROPERTY GRIDIRON_PORT_KIT)
  add_library(${name} STATIC ${source})
  target_compile_features(${name} PRIVATE cxx_std_20)
  set(definitions "GRIDIRON_LAYOUT=${arg_LAYOUT}" GRIDIRON_LANES=${arg_LANES})
  if(arg_LAYOUT_HEADER)
    list(APPEND definitions "GRIDIRON_LAYOUT_HEADER=\"${arg_LAYOUT_HEADER}\"")
  endif()
  if(arg_QUEUE_DEPTH)
    list(APPEND definitions GRIDIRON_QUEUE_DEPTH=${arg_QUEUE_DEPTH})
  endif()
  if(arg_BUDGETS)
    list(APPEND definitions GRIDIRON_IMAGE_BUDGETS)
  endif()
  target_compile_definitions(${name} PRIVATE ${definitions})
  if(arg_STORE_BYTES)
    target_compile_definitions(${name} PUBLIC GRIDIRON_STORE_BYTES=${arg_STORE_BYTES})
  endif()
  target_include_directories(${name} PRIVATE ${kit})
  target_compile_options(${name} PRIVATE -fno-exceptions -fno-rtti -Wno-psabi -ffunction-sections -fdata-sections)
  # Unoptimised code exceeds the budgets of every layout.
  string(TOUPPER "${CMAKE_BUILD_TYPE}" build_type)
  if(NOT " ${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_${build_type}}" MATCHES " -O")
    target_compile_options(${name} BEFORE PRIVATE -O2)
  endif()
  target_link_libraries(${name} PUBLIC gridiron::platform PRIVATE gridiron::prepare gridiron::kernel)
endfunction()
