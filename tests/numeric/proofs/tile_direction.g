# core/gridiron/engine/tree/tile_projection.h: the 1.01 of direction_error. A component of a direction is rounded four
# times. For fixed roundings the error is linear in what is rounded, in exact arithmetic: column term, left, row term, all;
# one of them is 1, the others are 0. SPDX-License-Identifier: Apache-2.0
%source core/gridiron/engine/tree/tile_projection.h
%decimal kShare tile.direction_error = static_cast<float>({} * ((moved[0] > moved[1] ? moved[0] : moved[1]) + span * moved[2]));
%decimal kShareOfW tile.w_error = static_cast<float>({} * moved[2]);
%proves kShare least 0.991
%proves kShareOfW least 0.991
%line kFloatUnit * (larger(x * step_x, x1 * step_x) + larger(left, right) + larger(top, bottom) + ends);
%define off = 0x1p-23
%cases COLUMN LEFT ROW ALL
%case 1 0 0 0
%case 0 1 0 0
%case 0 0 1 0
%case 0 0 0 1

%round direction_error = kShare * off
%round w_error = kShareOfW * off
%source core/gridiron/ray/hits.h
%line return (Real(frame.corner[axis]) + x * Real(frame.step_x[axis])) + y * Real(frame.step_y[axis]);
%round column = column_term * 1
%define sum = left + (column - column_term)
%round rounded_left = sum * 1
%round row = row_term * 1
%define both = all + ((rounded_left - left) + (row - row_term))
%round direction = both * 1

{ column_term in [COLUMN, COLUMN] /\ left in [LEFT, LEFT] /\ row_term in [ROW, ROW] /\ all in [ALL, ALL] /\
  %roundings
  -> direction_error - |direction - all| >= 0 /\ w_error - |direction - all| >= 0 }
