# core/gridiron/engine/tree/tile_triangles.h: kNormalError. v and h are in the triangle of rounded corners, h where the
# ray meets the true one, in shares of corners; N is its exact normal, n the rounded one. As N . (h - v) is 0, the
# rounded volume differs from n . h by no more than that: n - N along h - v, and the roundings of n . v. What corners are
# off, `slope` counts. For fixed roundings all is linear in products of two sides, and in v and h - v, which are at most
# m and 2 m: one product is 1, the others are 0, so that the cases are n's components. SPDX-License-Identifier: Apache-2.0
%source core/gridiron/engine/tree/tile_triangles.h
%constant kNormalError inline constexpr float kNormalError = {};
%proves kNormalError least 0.957
%cases IN_X IN_Y IN_W
%case 1 0 0
%case 0 1 0
%case 0 0 1

%line side_x[i] = x[next] - x[i];
%line side_y[i] = y[next] - y[i];
%line side_w[i] = w[next] - w[i];
%round ax = A_x + 0
%round ay = A_y + 0
%round aw = A_w + 0
%round bx = B_x + 0
%round by = B_y + 0
%round bw = B_w + 0
# The second products are 0.
%line const Float p0 = ay * bw, p1 = aw * by, p2 = aw * bx, p3 = ax * bw, p4 = ax * by, p5 = ay * bx;
%line const Float nx = p0 - p1, ny = p2 - p3, nw = p4 - p5;
%round p0 = ay * bw
%round p2 = aw * bx
%round p4 = ax * by
%round nx = p0 - 0
%round ny = p2 - 0
%round nw = p4 - 0
%line const Float volume = L::bounded_sum(nx, vx, L::bounded_sum(ny, vy, nw * vw));
%round volume = nx * vx + (ny * vy + nw * vw)
%line L::bounded_sum(L::abs(p0) + L::abs(p1), most_x,
%line L::bounded_sum(L::abs(p2) + L::abs(p3), most_y, (L::abs(p4) + L::abs(p5)) * most_w));
%round rounded = (size(p0) + 0) * most + ((size(p2) + 0) * most + (size(p4) + 0) * most)
%line rounded * Float(kNormalError) + slope * moved + L::abs(nw) * moved * Float(1.0f / (2.0f * float(Width)));
%round plane_error = rounded * kNormalError + 0 + 0

%define along_way = (nx - exact_nx) * hx + (ny - exact_ny) * hy + (nw - exact_nw) * hw
%define at_corner = nx * vx + (ny * vy + nw * vw)

{ A_x in [1, 1] /\ A_y in [1, 1] /\ A_w in [1, 1] /\
  B_x in [IN_Y, IN_Y] /\ B_y in [IN_W, IN_W] /\ B_w in [IN_X, IN_X] /\
  |vx| <= 1 /\ |vy| <= 1 /\ |vw| <= 1 /\ |hx| <= 2 /\ |hy| <= 2 /\ |hw| <= 2 /\ most in [1, 1] /\
  %roundings
  -> plane_error - |along_way + (at_corner - volume)| >= 0 }

at_corner - volume -> -(volume - at_corner);
