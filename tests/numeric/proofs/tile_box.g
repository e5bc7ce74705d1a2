# core/gridiron/engine/tree/tile_triangles.h: kBoxMargin. A corner at column c of a tile is estimated within it. c is a
# pixel of the tile: what is estimated grows with it. The rounded w is 1, the corner's error at most 2^-8 of it
# (kLeastSureW), w's that over twice the width. A pixel's direction is off by at most 0.609 2^-6 pixels: see the README.
# What the sum with the margin rounds is below 2^-16. SPDX-License-Identifier: Apache-2.0
%source core/gridiron/engine/tree/tile_triangles.h
%constant kBoxMargin inline constexpr float kBoxMargin = {};
%constant kLeastSureW inline constexpr float kLeastSureW = {};
%proves kBoxMargin least 0.788
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
%define error = 0x1.00001p0 / kLeastSureW
%define place = c + off
%define x = place * (1 + error * k * share) + error * h
%round column = x * inverse

{ c in [0, LAST] /\ |off| <= 0x0.9Cp-6 /\ |h| <= 1 /\ |k| <= 1 /\ |inverse - 1| <= 0x1p-12 /\
  share in [SHARE, SHARE] /\
  %roundings
  -> kBoxMargin - |column - c| - 0x1p-16 >= 0 }

column - c -> (column - x * inverse) + (x * (inverse - 1) + (off * (1 + error * k * share) + c * (error * k * share) + error * h));
