# core/gridiron/engine/tree/tile_projection.h: the 1.01 of direction_error and w_error. A component of a direction is
# rounded four times. For fixed roundings the error is linear in what is rounded, in exact arithmetic: column term,
# left, row term, all; one of them is 1, the others are 0. `off` has each of them where it is largest in the tile, also
# rounded: its magnitude is at least the exact one less the difference, which is linear again. Pixels' places are exact,
# multiples of 1/32. The rows' components are rounded too. SPDX-License-Identifier: Apache-2.0
%source core/gridiron/engine/tree/tile_projection.h
%decimal kShare eye.per_off = static_cast<float>({} * kFloatUnit / unit);
%proves kShare least 0.991
%cases COLUMN LEFT ROW ALL
%case 1 0 0 0
%case 0 1 0 0
%case 0 0 1 0
%case 0 0 0 1

%line const float left_x = static_cast<float>(x), top_y = static_cast<float>(y);
%line const float column0 = left_x * step_x, column1 = (left_x + wide) * step_x;
%line const float left = corner + column0, right = corner + column1;
%line const float top = top_y * step_y, bottom = (top_y + wide) * step_y;
%line const float ends = larger(larger(left + top, left + bottom), larger(right + top, right + bottom));
%line const float off = larger(column0, column1) + larger(left, right) + larger(top, bottom) + ends;
%round at_column = column_term * 1
%define at_sum = left + (at_column - column_term)
%round at_left = at_sum * 1
%round at_row = row_term * 1
%define at_both = all + ((at_left - left) + (at_row - row_term))
%round at_end = at_both * 1
%define least_column = column_term - |at_column - column_term|
%define least_left = left - |at_left - left|
%define least_row = row_term - |at_row - row_term|
%define least_end = all - |at_end - all|
%round off = ((least_column + least_left) + least_row) + least_end
%line for (int row = 0; row < 3; ++row) moved[row] += magnitude(tile.rows[row][axis]) * off;
%round component = one * 1
%round moved = ((0 + component * off) + 0) + 0
%line tile.direction_error = eye.per_off * ((moved[0] > moved[1] ? moved[0] : moved[1]) + span * moved[2]);
%line tile.w_error = eye.per_off * moved[2];
%define unit = 0x1p-23
%define share_of_unit = kShare * unit
%round per_off = share_of_unit * 1
# Of w's row there is one rounding more.
%round direction_error = per_off * (0 + 1 * moved)
%round w_error = per_off * moved
%source core/gridiron/ray/hits.h
%line return (Real(frame.corner[axis]) + x * Real(frame.step_x[axis])) + y * Real(frame.step_y[axis]);
%round column = column_term * 1
%define sum = left + (column - column_term)
%round rounded_left = sum * 1
%round row = row_term * 1
%define both = all + ((rounded_left - left) + (row - row_term))
%round direction = both * 1

{ column_term in [COLUMN, COLUMN] /\ left in [LEFT, LEFT] /\ row_term in [ROW, ROW] /\ all in [ALL, ALL] /\
  one in [1, 1] /\
  %roundings
  -> direction_error - |direction - all| >= 0 /\ w_error - |direction - all| >= 0 }
