# Cortex-M7 as this project's own images are built: with call graphs, for the depth of stacks, and without calls of
# memory functions that the compiler would make of their own loops.
# SPDX-License-Identifier: Apache-2.0
include(${CMAKE_CURRENT_LIST_DIR}/cortex_m7.cmake)
string(APPEND CMAKE_CXX_FLAGS_INIT " -fcallgraph-info=su,da -fno-tree-loop-distribute-patterns")
string(APPEND CMAKE_C_FLAGS_INIT " -fcallgraph-info=su,da -fno-tree-loop-distribute-patterns")
