# What `cmake --install` puts where, and what find_package and pkg-config find there. A component is a library that one
# asks for by name: platform, core, sim_platform; each is an install component too.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(GRIDIRON_CMAKE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/gridiron)
set(GRIDIRON_PKGCONFIG_DIR ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
set(GRIDIRON_PACKAGE_FILES ${CMAKE_CURRENT_LIST_DIR}/package)

# gridiron_install_component(NAME TARGETS targets... HEADERS directories... [FILES headers...]): targets lose their
# prefix gridiron_ and are gridiron::... for users; HEADERS are folders with all their .h, as install(DIRECTORY) takes
# them, FILES single headers; both go to include/gridiron.
function(gridiron_install_component name)
  if(NOT GRIDIRON_INSTALL)
    return()
  endif()
  cmake_parse_arguments(arg "" "" "TARGETS;HEADERS;FILES" ${ARGN})
  foreach(target ${arg_TARGETS})
    string(REGEX REPLACE "^gridiron_" "" export_name ${target})
    set_target_properties(${target} PROPERTIES EXPORT_NAME ${export_name})
  endforeach()
  install(TARGETS ${arg_TARGETS} EXPORT gridiron_${name}
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT ${name}
    INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
  install(DIRECTORY ${arg_HEADERS} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/gridiron COMPONENT ${name}
    FILES_MATCHING PATTERN "*.h")
  install(FILES ${arg_FILES} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/gridiron COMPONENT ${name})
  install(EXPORT gridiron_${name} NAMESPACE gridiron:: FILE gridiron-${name}.cmake
    DESTINATION ${GRIDIRON_CMAKE_DIR} COMPONENT ${name})

  # From where the file lies to the prefix, so that a prefix can be moved.
  file(RELATIVE_PATH to_prefix ${CMAKE_INSTALL_PREFIX}/${GRIDIRON_PKGCONFIG_DIR} ${CMAKE_INSTALL_PREFIX})
  string(REGEX REPLACE "/$" "" to_prefix "${to_prefix}")
  configure_file(${GRIDIRON_PACKAGE_FILES}/gridiron-${name}.pc.in ${PROJECT_BINARY_DIR}/gridiron-${name}.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/gridiron-${name}.pc DESTINATION ${GRIDIRON_PKGCONFIG_DIR} COMPONENT ${name})
endfunction()

# What all components share goes with the lowest one.
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
    DESTINATION ${GRIDIRON_CMAKE_DIR} COMPONENT platform)
  install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT platform)
endfunction()
