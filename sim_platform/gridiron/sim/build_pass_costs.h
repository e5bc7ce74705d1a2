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
    {   21.1,    17.4,    25.2,   12.38,    0.00,    6.25,    1.27,    0.28},  // corner
    {  100.4,    64.7,   111.2,   54.06,    0.00,   19.89,    1.98,    0.59},  // missed_corner
    {  206.8,   196.8,   312.4,  196.22,    0.00,  115.52,    1.16,    0.03},  // coded_group
    {   14.9,    12.1,    16.0,    2.03,    0.00,   12.10,    0.08,    0.00},  // sorted_record
    {    3.2,     3.2,     4.3,    1.06,    0.00,    3.15,    0.15,    0.00},  // sort_count
    {   30.3,    13.8,    35.8,   13.17,    0.00,   11.10,    1.21,    0.03},  // moved_key
    {   12.9,     9.2,    14.8,    3.02,    0.00,    7.27,    1.64,    0.11},  // exchanged_key
    {    9.7,     8.4,    13.2,    4.05,    0.00,    7.85,    0.60,    0.03},  // gathered_key
    {  294.7,   167.0,   332.8,  124.65,    0.00,   97.94,   10.59,    2.35},  // middle_group
    {  333.6,   215.1,   400.0,  172.71,    0.00,  124.10,   10.57,    2.35},  // again_group
    {   54.0,    29.4,    58.2,   13.83,    0.00,   13.98,    4.92,    0.86},  // asked_record
    {   26.2,    17.0,    29.5,   17.00,    0.00,    6.00,    0.00,    0.00},  // record_span
    {   49.8,    39.8,    63.1,   28.76,    0.00,   21.47,    3.99,    0.61},  // taken_record
    {  108.9,    77.7,   124.3,   33.09,    0.00,   45.48,    8.86,    1.79},  // built_leaf
    {  348.5,   265.5,   403.6,   91.78,    6.41,  166.16,   15.57,    3.38},  // part
    {    9.6,     9.3,    14.5,    9.29,    0.00,    4.93,    0.14,    0.00},  // weighed_part
    {   16.2,    11.2,    17.7,   11.19,    0.00,    3.00,    0.85,    0.00},  // search_step
    {  751.9,   517.3,   897.5,  268.57,    0.00,  345.92,   43.58,    9.52},  // built_node
    {  113.8,    71.8,   124.0,   28.97,    0.00,   36.14,   12.39,    1.98},  // numbered_node
}};

}  // namespace gridiron::sim
