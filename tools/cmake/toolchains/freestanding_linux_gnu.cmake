# Cross-compiles core with a Debian cross compiler, freestanding. The including file sets GRIDIRON_TARGET.
# SPDX-License-Identifier: Apache-2.0
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR ${GRIDIRON_TARGET})
set(CMAKE_C_COMPILER ${GRIDIRON_TARGET}-linux-gnu-gcc)
set(CMAKE_CXX_COMPILER ${GRIDIRON_TARGET}-linux-gnu-g++)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
set(CMAKE_CXX_FLAGS_INIT
  "-fno-pie -fcallgraph-info=su,da -fno-tree-loop-distribute-patterns ${GRIDIRON_TARGET_FLAGS}")
# Size matters on a core: -O3 unrolls and clones the kernel to nearly twice the code of -O2.
set(CMAKE_CXX_FLAGS_RELEASE "-O2 -DNDEBUG" CACHE STRING "Flags of a Release build")

# The host's /usr/include must not be on a cross compiler's path: GLM is reached through a directory of its own.
set(glm_DIR ${CMAKE_CURRENT_LIST_DIR}/glm CACHE PATH "GLM for freestanding cross builds" FORCE)
