# What `cmake --install` installs, and what find_package and pkg-config find there. A component is a library with a
# public name: platform, core, sim_platform; each is an install component too, as are tools, mpi and documents. The
# libraries are static.
# SPDX-License-Identifier: Apache-2.0
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(GRIDIRON_CMAKE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/gridiron)
set(GRIDIRON_PKGCONFIG_DIR ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
set(GRIDIRON_PACKAGE_FILES ${CMAKE_CURRENT_LIST_DIR}/package)

# gridiron_install_component(NAME TARGETS targets... HEADERS directories...): targets lose their prefix gridiron_ and
# are gridiron::... for users; HEADERS are folders with all their .h, as install(DIRECTORY) takes them; they go to
# include/gridiron.
function(gridiron_install_component name)
  if(NOT GRIDIRON_INSTALL)
    return()
  endif()
  cmake_parse_arguments(arg "" "" "TARGETS;HEADERS" ${ARGN})
  foreach(target ${arg_TARGETS})
    string(REGEX REPLACE "^gridiron_" "" export_name ${target})
    set_target_properties(${target} PROPERTIES EXPORT_NAME ${export_name})
  endforeach()
  install(TARGETS ${arg_TARGETS} EXPORT gridiron_${name}
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT ${name}
    INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
  install(DIRECTORY ${arg_HEADERS} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/gridiron COMPONENT ${name}
    FILES_MATCHING PATTERN "*.h")
  install(EXPORT gridiron_${name} NAMESPACE gridiron:: FILE gridiron-${name}.cmake
    DESTINATION ${GRIDIRON_CMAKE_DIR} COMPONENT ${name})

  # The relative path from the file to the prefix, so that a prefix can be moved. Absolute folders, which some packagers
  # set, stay where they are.
  if(IS_ABSOLUTE ${GRIDIRON_PKGCONFIG_DIR})
    set(prefix ${CMAKE_INSTALL_PREFIX})
  else()
    file(RELATIVE_PATH to_prefix ${CMAKE_INSTALL_PREFIX}/${GRIDIRON_PKGCONFIG_DIR} ${CMAKE_INSTALL_PREFIX})
    string(REGEX REPLACE "/$" "" to_prefix "${to_prefix}")
    set(prefix "\${pcfiledir}/${to_prefix}")
  endif()
  foreach(kind INCLUDEDIR LIBDIR DATADIR)
    string(TOLOWER ${kind} folder)
    set(${folder} ${CMAKE_INSTALL_${kind}})
    if(NOT IS_ABSOLUTE "${${folder}}")
      string(PREPEND ${folder} "\${prefix}/")
    endif()
  endforeach()
  configure_file(${GRIDIRON_PACKAGE_FILES}/gridiron-${name}.pc.in ${PROJECT_BINARY_DIR}/gridiron-${name}.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/gridiron-${name}.pc DESTINATION ${GRIDIRON_PKGCONFIG_DIR} COMPONENT ${name})
endfunction()

# Files that all components share belong to the lowest one.
function(gridiron_install_package)
  if(NOT GRIDIRON_INSTALL)
    return()
  endif()
  configure_package_config_file(${GRIDIRON_PACKAGE_FILES}/gridiron-config.cmake.in
    ${PROJECT_BINARY_DIR}/gridiron-config.cmake INSTALL_DESTINATION ${GRIDIRON_CMAKE_DIR}
    NO_SET_AND_CHECK_MACRO NO_CHECK_REQUIRED_COMPONENTS_MACRO)
  # Before 1.0 a minor version may break what the last one offered: core/README.md, "Versions".
  write_basic_package_version_file(${PROJECT_BINARY_DIR}/gridiron-config-version.cmake COMPATIBILITY SameMinorVersion)
  install(FILES ${PROJECT_BINARY_DIR}/gridiron-config.cmake ${PROJECT_BINARY_DIR}/gridiron-config-version.cmake
    ${GRIDIRON_PACKAGE_FILES}/gridiron-c.cmake
    DESTINATION ${GRIDIRON_CMAKE_DIR} COMPONENT platform)
  # The porting kit: a project to copy, with its files from other folders.
  set(port_dir ${CMAKE_INSTALL_DATADIR}/gridiron/port)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/platform/template/ DESTINATION ${port_dir} COMPONENT platform)
  set(consumer ${PROJECT_SOURCE_DIR}/tests/package/consumer)
  install(FILES ${PROJECT_SOURCE_DIR}/tests/contract/contract_checks.h ${PROJECT_SOURCE_DIR}/platform/firmware/memory.cpp
    ${PROJECT_SOURCE_DIR}/platform/c/gridiron_c.cpp ${consumer}/c_picture.c
    ${consumer}/copy_port.h ${consumer}/port_picture.cpp ${consumer}/port_contract.cpp ${consumer}/hills.h
    ${consumer}/picture.h
    DESTINATION ${port_dir} COMPONENT platform)
  install(PROGRAMS ${PROJECT_SOURCE_DIR}/tools/checks/deepest_stack DESTINATION ${port_dir} COMPONENT platform)
  install(FILES ${PROJECT_SOURCE_DIR}/tools/checks/compiler_helpers DESTINATION ${port_dir} COMPONENT platform)
  set(toolchains ${PROJECT_SOURCE_DIR}/tools/cmake/toolchains)
  install(FILES ${toolchains}/cortex_m7.cmake DESTINATION ${port_dir}/toolchains COMPONENT platform)
  install(DIRECTORY ${toolchains}/glm DESTINATION ${port_dir}/toolchains COMPONENT platform)
  install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT platform)

  # Pages, and the porting guide beside the kit, without links to what is not installed.
  set(copy_documents ${PROJECT_SOURCE_DIR}/tools/cmake/copy_documents)
  set(documents ${PROJECT_BINARY_DIR}/documents)
  file(REMOVE_RECURSE ${documents})
  execute_process(COMMAND ${copy_documents} ${documents}/pages COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND ${copy_documents} --kit ${documents}/kit COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND ${copy_documents} --list OUTPUT_VARIABLE names COMMAND_ERROR_IS_FATAL ANY)
  string(REGEX MATCHALL "[^\n]+" names "${names}")
  list(TRANSFORM names PREPEND ${PROJECT_SOURCE_DIR}/)
  set_property(DIRECTORY ${PROJECT_SOURCE_DIR} APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${copy_documents} ${names})
  install(FILES ${documents}/kit/PORTING.md DESTINATION ${port_dir} COMPONENT platform)
  install(DIRECTORY ${documents}/pages/ DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT documents)

  if(PROJECT_IS_TOP_LEVEL)
    # A manifest has no DESTDIR: it is kept beside the manifest, for uninstall.
    install(CODE "
      set(of_component \"\")
      if(CMAKE_INSTALL_COMPONENT)
        set(of_component \"_\${CMAKE_INSTALL_COMPONENT}\")
      endif()
      file(WRITE \"${PROJECT_BINARY_DIR}/install_destdir\${of_component}.txt\" \"\$ENV{DESTDIR}\")" ALL_COMPONENTS)
    add_custom_target(uninstall COMMAND ${CMAKE_COMMAND} -D BUILD=${PROJECT_BINARY_DIR}
      -P ${PROJECT_SOURCE_DIR}/tools/cmake/uninstall.cmake COMMENT "Removing what was installed last" VERBATIM)
  endif()
endfunction()
