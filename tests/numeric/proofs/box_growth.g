# core/gridiron/base/tree_records.h: kTreeGrowth. A stored side lies outside the triangles by at least 1.5 e |n| + S /
# 2^25, n its place and S >= |n| the scene's largest coordinate, as box_terms.g and the header assume, if boxes are
# made in the usual rounding mode: an operation then has an error of 2^-24. All is linear in n and S: n is S, -S or 0.
# SPDX-License-Identifier: Apache-2.0
%source core/gridiron/base/tree_records.h
%constant kTreeGrowth inline constexpr float kTreeGrowth = {};
%constant kShare const float margin = largest_coordinate * {};
%proves kTreeGrowth least 0.876
%unit 0x1p-24
%cases AT_N
%case 1
%case 0
%case -1

%line return low - ((low < 0.0f ? -low : low) * kTreeGrowth + margin);
%round margin = S * kShare
%round grown = low - (size(low) * kTreeGrowth + margin)

{ low in [AT_N, AT_N] /\ S in [1, 1] /\
  %roundings
  -> low - grown - (0x1.8p-23 * |low| + 0x1p-25 * S) >= 0 }
