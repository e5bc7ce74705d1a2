// A row of the tables of what work costs. Memory: values. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

namespace gridiron::sim {

/// Means over the units of the counted frames.
struct WorkCost {
  double cycles;        ///< charged: superblock schedule, branch misses included
  double least_cycles;  ///< the fuller pipe never idle; too much where these operations fill the gaps of a neighbour
  double most_cycles;   ///< bound: nothing issued together
  double even;          ///< operations of the even pipe, and of these:
  double doubles;       ///< in double precision
  double odd;           ///< operations of the odd pipe, and of these:
  double branches;
  double misses;  ///< branches that go the rarer way
};

}  // namespace gridiron::sim
