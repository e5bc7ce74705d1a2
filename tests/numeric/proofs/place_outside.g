# core/gridiron/ray/edges.h: kSubpacketErrorFactor, as squares, quarters and rows of rays use it: where the linear
# form says that an edge function is below surely_outside everywhere in a place, it is below 0 for every ray of the
# place. The difference is linear in the edge, in |S|1, in the parts C, U, V of D (pixel_direction.g), and in x_0, c_0
# and the ray's column in the place, which add up to x_last in magnitude, or 15/13 of it as x_0 >= -1/2: one of each
# is enough. Rows round no more than columns. One component of S leaves two terms, one of each other component of d;
# each must be within half of the bound. SPDX-License-Identifier: Apache-2.0
%source core/gridiron/ray/edges.h
%constant kEdgeErrorFactor inline constexpr float kEdgeErrorFactor = {};
%constant kSubpacketErrorFactor inline constexpr float kSubpacketErrorFactor = {};
%proves kSubpacketErrorFactor least 0.545
%cases IN_C IN_U IN_V X_0 C_0 T Y_0 R_0 W
%case 0 1 0 0x1.28p0 0 0 0 0 0
%case 1 0 0 0 0 0 0 0 0
%case 0 1 0 0 0x1.28p0 0 0 0 0
%case 0 1 0 0 0 1 0 0 0

# The place begins at column c_0, row r_0, and has `span` more of them; the ray is at the shares t and u of these.
%define x = x_0 + (c_0 + t * span)
%define y = y_0 + (r_0 + u * span)
%source core/gridiron/ray/hits.h
%line return (Real(frame.corner[axis]) + x * Real(frame.step_x[axis])) + y * Real(frame.step_y[axis]);
%round direction = (C + x * U) + y * V
%round first_dir = (C + x_0 * U) + y_0 * V
# One term of the edge function, which takes part in every sum.
%source core/gridiron/ray/edges.h
%line const Float n_x = s_y * f_z - s_z * f_y;
%line return inward_x * Float(direction[0]) + inward_y * Float(direction[1]) + inward_z * Float(direction[2]);
%round n = ((A - o) + 0) * (F + 0) - 0
%line const Float first = along(packet.first_dir);
%line const Float per_column = along(packet.step_x);
%line const Float per_row = along(packet.step_y);
%round first = n * first_dir + 0 + 0
%round per_column = n * U + 0 + 0
%round per_row = n * V + 0 + 0
# max(per_column, 0) is at least t per_column, and what it is more makes the value greater.
%line const Float rise_column = L::max(per_column, Float(0.0f));
%line const Float rise = rise_column + L::max(per_row, Float(0.0f));  // per pixel of a square's side
%line (first + rise * Float(kSquareSpan)).store(batch.first_square);
%round rise = exactly(t * per_column) + exactly(u * per_row)
%round largest = first + rise * span
%source core/gridiron/ray/subpackets.h
%line Float(largest[lane]) + (column * Float(batch.per_column[lane]) + row * Float(batch.per_row[lane]));
%round value = largest + (c_0 * per_column + r_0 * per_row)

# |d|max cancels, but for its roundings.
%source core/gridiron/ray/edges.h
%line const Float error = scale * Float(kEdgeErrorFactor * packet.dir_max) + Float(kUnderflow * packet.range_factor);
%line (-(error * Float(packet.subpacket_widening))).store(batch.surely_outside);
%round size_a = size(A - o) + 0 + 0
%round size_f = 1 + 0
%round scale = (size_a + 0) * size_f
%round error = scale * (kEdgeErrorFactor * 1) + 0
%source core/gridiron/ray/camera.h
%line packet.subpacket_widening = kSubpacketErrorFactor / kEdgeErrorFactor * (dir_bound / dir_max);
%define factor = kSubpacketErrorFactor / kEdgeErrorFactor
%round dir_bound = size(C) + 1 * size(U) + 1 * size(V)
%round widening = factor * (dir_bound / 1)
%round limit = error * widening

{ C in [IN_C, IN_C] /\ U in [IN_U, IN_U] /\ V in [IN_V, IN_V] /\ A - o in [1, 1] /\ |F| <= 1 /\
  x_0 in [X_0, X_0] /\ c_0 in [C_0, C_0] /\ t in [T, T] /\ y_0 in [Y_0, Y_0] /\ r_0 in [R_0, R_0] /\ u in [W, W] /\
  span in [0x1.28p0, 0x1.28p0] /\
  %roundings
  -> limit / 2 - (exact_n * direction - value) >= 0 }

exact_n * direction - value -> exact_n * (direction - exact_direction) - (value - exact_value);
