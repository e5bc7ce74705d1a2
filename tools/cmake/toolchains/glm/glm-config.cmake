# GLM for cross builds: a directory that holds a link to the host's GLM headers and nothing else.
# SPDX-License-Identifier: Apache-2.0
find_path(GRIDIRON_GLM_PARENT glm/glm.hpp PATHS /usr/include /usr/local/include NO_DEFAULT_PATH NO_CMAKE_FIND_ROOT_PATH)
if(NOT GRIDIRON_GLM_PARENT)
  set(glm_FOUND FALSE)
  set(glm_NOT_FOUND_MESSAGE "glm/glm.hpp is not installed (Debian: libglm-dev)")
  return()
endif()
file(MAKE_DIRECTORY ${CMAKE_BINARY_DIR}/cross_include)
file(CREATE_LINK ${GRIDIRON_GLM_PARENT}/glm ${CMAKE_BINARY_DIR}/cross_include/glm SYMBOLIC)
if(NOT TARGET glm::glm)
  add_library(glm::glm INTERFACE IMPORTED)
  target_include_directories(glm::glm SYSTEM INTERFACE ${CMAKE_BINARY_DIR}/cross_include)
endif()
