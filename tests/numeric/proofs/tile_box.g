# core/gridiron/engine/tree/tile_triangles.h: kBoxMargin. A corner at column c of a tile is estimated within it. c is a
# pixel of the tile: what is estimated grows with it. The rounded w is 1, the corner's error at most 2^-8 of it
# (kLeastSureW), w's that over twice the width. A pixel's direction is off by at most 0.609 2^-6 pixels, of which the margin
# has room, or at most by 1.53 pixels and by less than the margin is wider: see the README. What the two sums with margins
# round is below 2^-15. SPDX-License-Identifier: Apache-2.0
%source core/gridiron/engine/tree/tile_triangles.h
%constant kBoxMargin inline constexpr float kBoxMargin = {};
%constant kLeastSureW inline constexpr float kLeastSureW = {};
%proves kBoxMargin least 0.799
%cases LAST SHARE
%case 7 0x1p-4
%case 15 0x1p-5
%case 31 0x1p-6
%case 63 0x1p-7

%line const auto is_near = least_w > Float(error * kLeastSureW);  // else pixels cannot be told
%line const Float inverse = L::reciprocal_estimate(w[corner]);
%line column[corner] = x[corner] * inverse;
%line const Float low = L::min(L::min(place[0], place[1]), place[2]) + Float(1.0f - 0x1p-10f - kBoxMargin);
%line const Float high = L::max(L::max(place[0], place[1]), place[2]) + Float(kBoxMargin);
%line if constexpr (IsWider) return place_of_end + Float(is_low ? -tile.direction_error : tile.direction_error);
%line first = L::select(is_near, L::max(wider(low, true), Float(0.0f)), Float(0.0f));
%line end = L::select(is_near, L::min(wider(high, false), Float(last)), Float(last));
%define error = 0x1.00001p0 / kLeastSureW
%define place = c + off
%define x = place * (1 + error * k * share) + error * h
%round column = x * inverse

{ c in [0, LAST] /\ |off| <= 0x1.88p0 /\ |h| <= 1 /\ |k| <= 1 /\ |inverse - 1| <= 0x1p-12 /\
  share in [SHARE, SHARE] /\
  %roundings
  -> kBoxMargin - 0x0.9Cp-6 - |column - place| - 0x1p-15 >= 0 }

column - place -> (column - x * inverse) + (x * (inverse - 1) + (place * (error * k * share) + error * h));
