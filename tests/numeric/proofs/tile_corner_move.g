# core/gridiron/engine/tree/tile_triangles.h: kCornerFactor, what an edge takes of corners' errors. An edge's function at a
# pixel is u_i v_k - v_i u_k, with u and v the corners' places less the pixel. Rounded corners have them within `size`, the
# true ones are off by `moved`. All is divided by both, g is moved / size. The bound is linear in g, the difference's
# magnitude convex: g is 0 or 2^20, far above what `is_sure` lets pass.
# SPDX-License-Identifier: Apache-2.0
%source core/gridiron/engine/tree/tile_triangles.h
%decimal kCornerFactor inline constexpr float kCornerFactor = {};
%proves kCornerFactor least 0.976
%cases RATIO
%case 0
%case 0x1p20

%line const Float size = L::bounded_sum(reach, most_w, L::max(most_x, most_y));
%line (size + moved) * (moved * Float(kCornerFactor) + size * Float(kTileEdgeError)) + Float(kLeastEdgeError);
%round size = 1 * 1 + 0
%round error = (size + g) * (1 * kCornerFactor + 0) + 0
%define moved_by = u_i * b_k + a_i * v_k + g * (a_i * b_k) - (v_i * a_k + b_i * u_k + g * (b_i * a_k))

{ |u_i| <= 1 /\ |v_i| <= 1 /\ |u_k| <= 1 /\ |v_k| <= 1 /\ |a_i| <= 1 /\ |b_i| <= 1 /\ |a_k| <= 1 /\ |b_k| <= 1 /\
  g in [RATIO, RATIO] /\
  %roundings
  -> error - |moved_by| >= 0 }
