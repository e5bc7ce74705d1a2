// Through MPI's profiling interface: every two ranks take themselves for the ranks of a node, so that one machine shows
// what several do. Memory: none. Threads: as MPI. SPDX-License-Identifier: Apache-2.0
#define OMPI_SKIP_MPICXX 1
#define MPICH_SKIP_MPICXX 1
#include <mpi.h>

extern "C" int MPI_Comm_split_type(MPI_Comm all, int, int key, MPI_Info, MPI_Comm* node) {
  int rank = 0;
  const int result = PMPI_Comm_rank(all, &rank);
  return result == MPI_SUCCESS ? PMPI_Comm_split(all, rank / 2, key, node) : result;
}
