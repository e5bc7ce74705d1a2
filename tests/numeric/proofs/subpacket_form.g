# core/gridiron/ray/edges.h: half of kSubpacketErrorFactor covers the difference of edge functions and their linear
# forms, of which the coefficients are rounded. The argument is that of place_outside.g. The other half:
# subpacket_sums.g. SPDX-License-Identifier: Apache-2.0
%source core/gridiron/ray/edges.h
%constant kEdgeErrorFactor inline constexpr float kEdgeErrorFactor = {};
%constant kSubpacketErrorFactor inline constexpr float kSubpacketErrorFactor = {};
%proves kSubpacketErrorFactor least 0.953
%cases IN_C IN_U X_0 COLUMN
%case 0 1 0x1.28p0 0
%case 1 0 0 0
%case 0 1 0 0x1.28p0

%define x = x_0 + c
%define y = y_0 + r
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
%define form = first + (c * per_column + r * per_row)

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

{ C in [IN_C, IN_C] /\ U in [IN_U, IN_U] /\ V in [0, 0] /\ A - o in [1, 1] /\ |F| <= 1 /\
  x_0 in [X_0, X_0] /\ c in [COLUMN, COLUMN] /\ y_0 in [0, 0] /\ r in [0, 0] /\
  %roundings
  -> limit / 4 - |exact_n * direction - form| >= 0 }

exact_n * direction - form -> exact_n * (direction - exact_direction) - ((first - exact_first) +
  (c * (per_column - exact_per_column) + r * (per_row - exact_per_row)));
