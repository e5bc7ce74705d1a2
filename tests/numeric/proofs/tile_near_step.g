# core/gridiron/engine/tree/tile_triangles.h: kNearError, of the steps of 1 / t from row to row; the argument is that of
# tile_near_value.g. ny / volume is 1 over `reach`, the unit of rows, which no pixel exceeds: see tile_edge_step.g, also
# for columns. SPDX-License-Identifier: Apache-2.0
%source core/gridiron/engine/tree/tile_triangles.h
%constant kNearError inline constexpr float kNearError = {};
%proves kNearError least 0.861

%line const Float inverse = Float(1.0f) / volume;
%line const Float near_x = nx * inverse, near_y = ny * inverse, near_w = nw * inverse;
# The exact quotient, rounded twice.
%round inverse = quotient * 1
%round near_y = inverse * 1
%line const Float most_near = L::bounded_sum(L::abs(near_x) + L::abs(near_y), reach, L::abs(near_w));
%line const Float near_error = most_near * (relative * Float(kSecondOrder) + Float(kNearError + 2.0f * tile.w_error));
%round most_near = (0 + size(near_y)) * 1 + 0
%round error = most_near * (0 + (kNearError + 0))
%line const Float near_value = near_w - near_error, near_span = near_error + near_error;
%define near_error = error
%round near_value = 0 - near_error
%define f = near_y

# draw_triangle(), 16 and 8 lanes.
%source core/gridiron/engine/tree/tile_tracer.h
%line start[k] = L::bounded_sum(x[k], column, kLanes > kBlockWidth ? L::bounded_sum(y[k], row, value[k]) : value[k]);
%line return L::bounded_sum(x[k], column, L::bounded_sum(y[k], row, start[k]));
%line for (int k = 0; k < 4; ++k) row[k] = L::bounded_sum(drawn.y[k], Float(kBlockStep), row[k]);
%round start_16 = 0 + (f * row + near_value)
%round at_16 = 0 + (f * line + start_16)
%round block_1 = at_16 + exactly(f * step)
%round block_2 = block_1 + exactly(f * step)
%round block_3 = block_2 + exactly(f * step)
%round block_4 = block_3 + exactly(f * step)
%round block_5 = block_4 + exactly(f * step)
%line if constexpr (kGroups > 1) step[k] = kLanes > kBlockWidth ? y[k] * Float(float(kLanes) / kBlockWidth) : y[k];
%line for (int k = kCovered ? 3 : 0; k < 4; ++k) value[k] = value[k] + f.step[k];
%round group_8 = block_3 + exactly(f * half)
# 4 lanes.
%round start_4 = 0 + near_value
%round at_4 = 0 + (f * line + start_4)
%round row_1 = at_4 + exactly(f * step)
%round row_2 = row_1 + exactly(f * step)
%round row_3 = row_2 + exactly(f * step)
%round group_1 = row_3 + exactly(f * quarter)
%round group_2 = group_1 + exactly(f * quarter)
%round group_3 = group_2 + exactly(f * quarter)
# One lane, draw_pixels(): of two blocks the lower one, three rows and three columns on.
%line for (int k = kCovered ? 3 : 0; k < 4; ++k) value[k] = value[k] + f.x[k];
%line for (int k = kCovered ? 3 : 0; k < 4; ++k) line[k] = line[k] + f.y[k];
%round at_1 = 0 + (f * line + near_value)
%round next_1 = at_1 + exactly(f * step)
%round line_1 = next_1 + exactly(f * quarter)
%round line_2 = line_1 + exactly(f * quarter)
%round line_3 = line_2 + exactly(f * quarter)
%round pixel_1 = ((line_3 + 0) + 0) + 0
# draw_tiny().
%line left[3] = L::bounded_sum(function(kNearX), x, L::bounded_sum(function(kNearY), y, function(kNearValue)));
%line value[3] = value[3] + function(kNearX);
%line left[3] = left[3] + function(kNearY);
%round left_0 = 0 + (f * line + near_value)
%round left_1 = left_0 + exactly(f * quarter)
%round left_2 = left_1 + exactly(f * quarter)
%round tiny = (left_2 + 0) + 0
# draw_many_blocks(): the greatest value of a block, with the span. Places are those of tile_edge_blocks.g.
%line most[k] = (L::max(f.x[k], zero) + L::max(f.y[k], zero)) * last + f.value[k];
%line most[3] = most[3] + f.near_span;
%line across[k][group] = kGroupRows > 1 ? L::bounded_sum(f.x[k], x, f.y[k] * y) : f.x[k] * x;
%line for (int k = 0; k < 4; ++k) down[k] = L::bounded_sum(f.y[k], line, most[k]);
%line Int none = L::words_of((across[3][group] + down[3]) - Float::load(memory_.least_near + base));
%define near_span = 2 * near_error
%round most_3 = ((0 + exactly(f * first)) * last + near_value) + near_span
%round across = 0 + f * deeper
%round down = f * upper + most_3
%round many = across + down
# TileHits::near_of(): an open pixel.
%source core/gridiron/engine/tree/tile_hits.h
%line return functions[kNearX][lane] * x + (functions[kNearY][lane] * y + functions[kNearValue][lane]);
%round open = 0 + (f * line + near_value)
# set_up_group(): all hidden.
%source core/gridiron/engine/tree/tile_triangles.h
%line return L::bounded_sum(L::abs(along_x), x1, L::bounded_sum(L::abs(along_y), y1, value));
%line Int none = L::words_of(most_in_box(near_value, near_x, near_y) + near_span - least);
%round in_box = (0 + (f * line + near_value)) + near_span

# In exact arithmetic, apart from the error.
%define true_block_5 = exact_near_y * (line + row + 5 * step) - near_error
%define true_group_8 = exact_near_y * (line + row + 3 * step + half) - near_error
%define true_group_3 = exact_near_y * (line + 3 * step + 3 * quarter) - near_error
%define true_pixel_1 = exact_near_y * (line + step + 3 * quarter) - near_error
%define true_tiny = exact_near_y * (line + 2 * quarter) - near_error
%define true_open = exact_near_y * (line) - near_error
%define true_many = exact_near_y * (upper + deeper + first * last) + near_error
%define true_in_box = exact_near_y * (line) + near_error
%define left_over = 0x2p-23 * most_near

{ quotient in [1, 1] /\
  |row| <= 1 /\ |line| <= 1 /\ |line + row| <= 1 /\ |line + row + step| <= 1 /\ |line + row + 2 * step| <= 1 /\
  |line + row + 3 * step| <= 1 /\ |line + row + 4 * step| <= 1 /\ |line + row + 5 * step| <= 1 /\
  |line + row + 3 * step + half| <= 1 /\
  |line + step| <= 1 /\ |line + 2 * step| <= 1 /\ |line + 3 * step| <= 1 /\ |line + 3 * step + quarter| <= 1 /\
  |line + 3 * step + 2 * quarter| <= 1 /\ |line + 3 * step + 3 * quarter| <= 1 /\ |line + quarter| <= 1 /\
  |line + 2 * quarter| <= 1 /\ |line + step + quarter| <= 1 /\ |line + step + 2 * quarter| <= 1 /\
  |line + step + 3 * quarter| <= 1 /\ last in [3, 3] /\ first in [0, 1] /\
  |first * last| <= 0x0.8BBp0 /\ |upper| <= 0x1.Cp0 /\ |upper + first * last| <= 0x1.Cp0 /\ |deeper| <= 0x1.18p1 /\
  |upper + deeper + first * last| <= 1 /\
  %roundings
  -> near_error - |block_5 - true_block_5| - left_over >= 0 /\
     near_error - |group_8 - true_group_8| - left_over >= 0 /\
     near_error - |group_3 - true_group_3| - left_over >= 0 /\
     near_error - |pixel_1 - true_pixel_1| - left_over >= 0 /\
     near_error - |tiny - true_tiny| - left_over >= 0 /\
     near_error - |open - true_open| - left_over >= 0 /\
     near_error - |many - true_many| - left_over >= 0 /\
     near_error - |in_box - true_in_box| - left_over >= 0 }

exact_at_16 -> f * (line + row) - near_error;
at_16 + (f * step) -> f * (line + row + step) - near_error + (at_16 - exact_at_16);
exact_block_1 -> f * (line + row + step) - near_error;
block_1 + (f * step) -> f * (line + row + 2 * step) - near_error + (block_1 - exact_block_1);
exact_block_2 -> f * (line + row + 2 * step) - near_error;
block_2 + (f * step) -> f * (line + row + 3 * step) - near_error + (block_2 - exact_block_2);
exact_block_3 -> f * (line + row + 3 * step) - near_error;
block_3 + (f * step) -> f * (line + row + 4 * step) - near_error + (block_3 - exact_block_3);
exact_block_4 -> f * (line + row + 4 * step) - near_error;
block_4 + (f * step) -> f * (line + row + 5 * step) - near_error + (block_4 - exact_block_4);
exact_block_5 -> f * (line + row + 5 * step) - near_error;
block_3 + (f * half) -> f * (line + row + 3 * step + half) - near_error + (block_3 - exact_block_3);
exact_group_8 -> f * (line + row + 3 * step + half) - near_error;
at_4 + (f * step) -> f * (line + step) - near_error + (at_4 - exact_at_4);
exact_row_1 -> f * (line + step) - near_error;
row_1 + (f * step) -> f * (line + 2 * step) - near_error + (row_1 - exact_row_1);
exact_row_2 -> f * (line + 2 * step) - near_error;
row_2 + (f * step) -> f * (line + 3 * step) - near_error + (row_2 - exact_row_2);
exact_row_3 -> f * (line + 3 * step) - near_error;
row_3 + (f * quarter) -> f * (line + 3 * step + quarter) - near_error + (row_3 - exact_row_3);
exact_group_1 -> f * (line + 3 * step + quarter) - near_error;
group_1 + (f * quarter) -> f * (line + 3 * step + 2 * quarter) - near_error + (group_1 - exact_group_1);
exact_group_2 -> f * (line + 3 * step + 2 * quarter) - near_error;
group_2 + (f * quarter) -> f * (line + 3 * step + 3 * quarter) - near_error + (group_2 - exact_group_2);
exact_group_3 -> f * (line + 3 * step + 3 * quarter) - near_error;
at_1 + (f * step) -> f * (line + step) - near_error + (at_1 - exact_at_1);
exact_next_1 -> f * (line + step) - near_error;
next_1 + (f * quarter) -> f * (line + step + quarter) - near_error + (next_1 - exact_next_1);
exact_line_1 -> f * (line + step + quarter) - near_error;
line_1 + (f * quarter) -> f * (line + step + 2 * quarter) - near_error + (line_1 - exact_line_1);
exact_line_2 -> f * (line + step + 2 * quarter) - near_error;
line_2 + (f * quarter) -> f * (line + step + 3 * quarter) - near_error + (line_2 - exact_line_2);
exact_line_3 -> f * (line + step + 3 * quarter) - near_error;
exact_pixel_1 -> f * (line + step + 3 * quarter) - near_error;
left_0 + (f * quarter) -> f * (line + quarter) - near_error + (left_0 - exact_left_0);
exact_left_1 -> f * (line + quarter) - near_error;
left_1 + (f * quarter) -> f * (line + 2 * quarter) - near_error + (left_1 - exact_left_1);
exact_left_2 -> f * (line + 2 * quarter) - near_error;
exact_tiny -> f * (line + 2 * quarter) - near_error;
exact_open -> f * (line) - near_error;
exact_most_3 -> f * (first * last) + near_error;
f * upper + most_3 -> f * (upper + first * last) + near_error + (most_3 - exact_most_3);
exact_down -> f * (upper + first * last) + near_error;
across + down -> f * (upper + deeper + first * last) + near_error + (across - exact_across) + (down - exact_down);
exact_many -> f * (upper + deeper + first * last) + near_error;
block_5 - true_block_5 -> (block_5 - exact_block_5) + (f - exact_near_y) * (line + row + 5 * step);
group_8 - true_group_8 -> (group_8 - exact_group_8) + (f - exact_near_y) * (line + row + 3 * step + half);
group_3 - true_group_3 -> (group_3 - exact_group_3) + (f - exact_near_y) * (line + 3 * step + 3 * quarter);
pixel_1 - true_pixel_1 -> (pixel_1 - exact_pixel_1) + (f - exact_near_y) * (line + step + 3 * quarter);
tiny - true_tiny -> (tiny - exact_tiny) + (f - exact_near_y) * (line + 2 * quarter);
open - true_open -> (open - exact_open) + (f - exact_near_y) * (line);
many - true_many -> (many - exact_many) + (f - exact_near_y) * (upper + deeper + first * last);
in_box - true_in_box -> (in_box - exact_in_box) + (f - exact_near_y) * (line);
