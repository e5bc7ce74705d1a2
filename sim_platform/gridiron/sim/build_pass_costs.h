// What a unit of each kind of work of the passes that build a tree costs on a core of two in-order pipes.
// Written by gridiron_calibrate from counted operations of the passes; do not edit. tools/calibrate/README.md says how.
// Memory: constants. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/build/passes/build_work.h>
#include <gridiron/sim/work_cost.h>

#include <array>

namespace gridiron::sim {

/// By kind of BuildWork, from kFirst on.
inline constexpr std::array<WorkCost, kBuildWorkCount> kBuildPassCosts = {{
    //  cycles    least     most     even  doubles      odd branches   misses
    {    8.1,     8.0,     9.6,    8.01,    0.00,    1.57,    0.07,    0.00},  // bounded_vertex
    {   18.5,    16.0,    22.8,   11.76,    0.00,    5.54,    1.27,    0.24},  // corner
    {   90.5,    49.7,    99.1,   36.41,    0.00,   15.25,    2.36,    0.74},  // missed_corner
    {  207.3,   196.9,   312.3,  196.25,    0.01,  115.30,    1.17,    0.03},  // coded_group
    {   17.4,    16.6,    20.1,    3.03,    0.00,   16.55,    0.04,    0.00},  // sorted_record
    {    3.1,     3.1,     4.2,    1.00,    0.00,    3.12,    0.12,    0.00},  // sort_count
    {   15.1,    13.2,    23.6,   13.00,    0.00,   10.15,    0.34,    0.01},  // moved_key
    {   13.0,     9.4,    15.0,    3.01,    0.00,    7.77,    1.99,    0.09},  // exchanged_key
    {    9.9,     8.7,    14.3,    5.03,    0.00,    7.94,    0.36,    0.04},  // gathered_key
    {  129.8,    87.1,   177.5,   77.89,    0.00,   77.65,    1.96,    0.51},  // again_group
    {   36.6,    21.3,    42.7,   17.14,    0.00,   14.45,    2.00,    0.23},  // asked_record
    {   71.6,    33.1,    81.4,   33.01,    0.00,   25.02,    1.00,    0.00},  // record_span
    {   22.5,    20.2,    30.9,   19.51,    0.00,    9.94,    2.22,    0.04},  // taken_record
    {  137.8,   100.2,   156.9,   43.88,    0.00,   51.36,   10.53,    2.72},  // built_leaf
    {  337.8,   258.9,   391.9,   91.09,    6.39,  160.52,   15.69,    3.33},  // part
    {    9.6,     9.3,    14.5,    9.29,    0.00,    4.92,    0.14,    0.00},  // weighed_part
    {   18.3,    13.2,    19.2,   13.18,    0.00,    2.03,    1.03,    0.00},  // search_step
    {    3.9,     3.1,     5.8,    2.86,    0.00,    2.42,    0.23,    0.01},  // cut_step
    {  771.0,   530.5,   928.5,  282.90,    0.00,  362.82,   45.29,    9.32},  // built_node
    {  112.3,    71.0,   122.2,   28.56,    0.00,   35.80,   12.27,    1.96},  // numbered_node
}};

}  // namespace gridiron::sim
