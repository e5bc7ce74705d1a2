# Choices of a build: the build type, optional packages, one test if the tests are not built.
# SPDX-License-Identifier: Apache-2.0

# gridiron_default_build_type(TYPE): used if none is given, except within another project.
macro(gridiron_default_build_type type)
  if(PROJECT_IS_TOP_LEVEL AND NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
    set(CMAKE_BUILD_TYPE ${type} CACHE STRING "Debug, Release, RelWithDebInfo, MinSizeRel or None" FORCE)
  endif()
endmacro()

# gridiron_with(NAME PURPOSE PACKAGE [VERSION]): the option GRIDIRON_WITH_<NAME>. AUTO uses the package if it is
# installed, ON requires it, OFF does not look for it. Sets GRIDIRON_HAS_<NAME>. A macro, so that the package's
# definitions are visible in all directories.
macro(gridiron_with name purpose package)
  set(GRIDIRON_WITH_${name} AUTO CACHE STRING "AUTO, ON or OFF: ${purpose}")
  set_property(CACHE GRIDIRON_WITH_${name} PROPERTY STRINGS AUTO ON OFF)
  if(NOT GRIDIRON_WITH_${name} MATCHES "^(AUTO|ON|OFF)$")
    message(FATAL_ERROR "GRIDIRON_WITH_${name}=${GRIDIRON_WITH_${name}}: must be AUTO, ON or OFF")
  endif()
  set(GRIDIRON_HAS_${name} OFF)
  if(NOT GRIDIRON_WITH_${name} STREQUAL "OFF")
    find_package(${package} ${ARGN} QUIET)
  endif()
  if(GRIDIRON_WITH_${name} STREQUAL "ON" AND NOT ${package}_FOUND)
    message(FATAL_ERROR "GRIDIRON_WITH_${name}=ON, but no ${package} was found (Debian: see tools/setup); OFF builds without it")
  endif()
  if(NOT GRIDIRON_WITH_${name} STREQUAL "OFF" AND ${package}_FOUND)
    set(GRIDIRON_HAS_${name} ON)
    list(APPEND gridiron_packages
      "${package} ${${package}_VERSION}${${package}_VERSION_STRING}${${package}_CXX_VERSION}, since GRIDIRON_WITH_${name}=${GRIDIRON_WITH_${name}}")
  else()
    list(APPEND gridiron_packages "no ${package}, since GRIDIRON_WITH_${name}=${GRIDIRON_WITH_${name}}")
  endif()
endmacro()

# gridiron_use_png(TARGET): defines GRIDIRON_HAS_PNG for its sources if there is libpng.
function(gridiron_use_png target)
  if(GRIDIRON_HAS_PNG)
    target_compile_definitions(${target} PRIVATE GRIDIRON_HAS_PNG)
    target_link_libraries(${target} PRIVATE PNG::PNG)
  endif()
endfunction()

# gridiron_use_zlib(TARGET): the same with zlib alone, which every libpng brings.
function(gridiron_use_zlib target)
  if(GRIDIRON_HAS_PNG)
    find_package(ZLIB REQUIRED)
    target_compile_definitions(${target} PRIVATE GRIDIRON_HAS_PNG)
    target_link_libraries(${target} PRIVATE ZLIB::ZLIB)
  endif()
endfunction()

# gridiron_use_jpeg(TARGET): the same for libjpeg, GRIDIRON_HAS_JPEG.
function(gridiron_use_jpeg target)
  if(GRIDIRON_HAS_JPEG)
    target_compile_definitions(${target} PRIVATE GRIDIRON_HAS_JPEG)
    target_link_libraries(${target} PRIVATE JPEG::JPEG)
  endif()
endfunction()

# Builds of one commit differ only by these lines, whatever else is on the machine.
function(gridiron_print_options)
  if(NOT PROJECT_IS_TOP_LEVEL)
    return()
  endif()
  set(has_tests OFF)
  if(GRIDIRON_BUILD_TESTS AND NOT CMAKE_CROSSCOMPILING)
    set(has_tests ON)
  endif()
  set(build_type ${CMAKE_BUILD_TYPE})
  if(CMAKE_CONFIGURATION_TYPES)
    set(build_type "chosen when it is built")
  endif()
  message(STATUS "Gridiron ${PROJECT_VERSION}: build type ${build_type}, program ${GRIDIRON_BUILD_TOOLS}, "
    "tests ${has_tests}, benchmarks ${GRIDIRON_BUILD_BENCHMARKS}, wide lanes ${GRIDIRON_WIDE_LANES}, "
    "warnings are errors ${GRIDIRON_WERROR}")
  foreach(line IN LISTS gridiron_packages)
    message(STATUS "Gridiron ${PROJECT_VERSION}: ${line}")
  endforeach()
endfunction()

# Without the tests, `ctest` renders one picture with the program and compares its hash.
function(gridiron_add_smoke_test)
  add_test(NAME program_renders_the_teapot.GRIDIRON_BUILD_TESTS_is_OFF
    COMMAND gridiron render ${PROJECT_SOURCE_DIR}/scenes/teapot.ply --size 64x48 --eye 3.5,6,10 --at 0.25,1.45,0
      --fov 23 -o ${PROJECT_BINARY_DIR}/smoke_test.png)
  set_tests_properties(program_renders_the_teapot.GRIDIRON_BUILD_TESTS_is_OFF PROPERTIES
    PASS_REGULAR_EXPRESSION "hash 6193136662a02492")
endfunction()
