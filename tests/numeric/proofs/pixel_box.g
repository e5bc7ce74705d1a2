# core/gridiron/ray/pixel_box.h: the margin's 32, 1536 and 400, twice what the header derives. With p = e D |P|1 and w
# = e D |W|1, a ray of column c meets the triangle at (c + A p) / (1 + B w), |A| and |B| at most 7.02: 6 e D of
# directions (pixel_direction.g) and one e of the rows. One corner's exact quotient is at most that (at least: the
# mirror image), and what is computed grows with it. Numerators and depths are off by at most 8.06 p and 8.06 w times
# the depth: four roundings, and the test of `size`, which bounds |a|max. With 1 / (1 + B w) = 1 - s w, likewise v for
# depths, the corner's place is linear in p and w, but for products with `small`, which is w again. So the corners of
# 32 p + 1536 w < 1 are enough. SPDX-License-Identifier: Apache-2.0
%source core/gridiron/ray/pixel_box.h
%constant kAlong const double margin = kUnit * (bound_per_det * ({} * along + 1536.0 * size[0]) + 400.0);
%constant kDepth const double margin = kUnit * (bound_per_det * (32.0 * along + {} * size[0]) + 400.0);
%constant kQuotient const double margin = kUnit * (bound_per_det * (32.0 * along + 1536.0 * size[0]) + {});
%proves kAlong least 0.476
%proves kDepth least 0.308
%proves kQuotient least 0.156
%constant kUnit static constexpr double kUnit = {};
%cases P W
%case 0 0
%case 0x1p-5 0
%case 0 0x1.56p-11

%line return x * Float(projection.rows[k][0]) + y * Float(projection.rows[k][1]) + z * Float(projection.rows[k][2]);
%line is_sure = is_sure & (size < depth * Float(projection.most_per_depth)) & (depth > Float(0x1p-80f));
%line projection.most_per_depth = static_cast<float>(2.0 * bound_per_det * largest);
%line const Float inverse = Float(1.0f) / depth;
%line column[i] = along(1) * inverse;
%line projection.margin = static_cast<float>(margin);
%line const Float low = L::min(L::min(place[0], place[1]), place[2]) - margin;
%round margin = 1 * (kAlong * p + kDepth * w + kQuotient * kUnit)
%define along = A * (1 - small * s) * (1 - small * v) + C * (1 - small * v)
%define place = c * (1 - w * (s + v) + w * small * (s * v)) + p * along
%round quotient = place * 1
%round column = quotient * 1

{ |A| <= 0x7.06p0 /\ |C| <= 0x8.1p0 /\ |s| <= 0x7.1p0 /\ |v| <= 0x8.2p0 /\ small in [0, 0x1.56p-11] /\ c in [0, 31] /\
  p in [P, P] /\ w in [W, W] /\
  %roundings
  -> margin - (column - c) >= 0 /\ margin + (column - c) >= 0 }

place - c -> c * (w * small * (s * v) - w * (s + v)) + p * along;
column - c -> (column - exact_column) + (place - c);
