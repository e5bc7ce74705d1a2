# core/gridiron/engine/tree/tile_triangles.h: kTileEdgeError, of an edge's step from row to row, in every way that a
# pixel comes by it; the argument is that of tile_edge_value.g, with R as unit of rows: no pixel is farther from the
# offset, so that all values on the way are those of rows from -1 to 1. Steps from column to column take the same
# operations or fewer. Multiples of steps by powers of two are exact. SPDX-License-Identifier: Apache-2.0
%source core/gridiron/engine/tree/tile_triangles.h
%constant kTileEdgeError inline constexpr float kTileEdgeError = {};
%proves kTileEdgeError least 0.868

%line const Float size = L::bounded_sum(reach, most_w, L::max(most_x, most_y));
%line (size + moved) * (moved * Float(kCornerFactor) + size * Float(kTileEdgeError)) + Float(kLeastEdgeError);
# The square's P R W is the product of a P and an R W.
%round size_p = 0 * 0 + 1
%round size_w = 1 * 1 + 0
%round error_p = (size_p + 0) * (0 * 0 + size_w * kTileEdgeError) + 0
%round error_w = (size_w + 0) * (0 * 0 + size_p * kTileEdgeError) + 0
%line const auto turned = [&](Float a) GRIDIRON_INLINE_LAMBDA { return L::floats_of(L::words_of(a) ^ sign); };
%line const Float value = turned(L::bounded_difference(x[i], y[next], y[i], x[next])) + edge_error;
%define edge_error = (error_p + error_w) / 2
%round value = 0 + edge_error
%line const Float edge_y = turned(L::bounded_difference(w[i], x[next], x[i], w[next]));
%round edge_y = w_i * x_k - x_i * w_k
%define f = edge_y

# draw_triangle(), 16 and 8 lanes.
%source core/gridiron/engine/tree/tile_tracer.h
%line start[k] = L::bounded_sum(x[k], column, kLanes > kBlockWidth ? L::bounded_sum(y[k], row, value[k]) : value[k]);
%line return L::bounded_sum(x[k], column, L::bounded_sum(y[k], row, start[k]));
%line for (int k = 0; k < 4; ++k) row[k] = L::bounded_sum(drawn.y[k], Float(kBlockStep), row[k]);
%round start_16 = 0 + (f * row + value)
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
%round start_4 = 0 + value
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
%round at_1 = 0 + (f * line + value)
%round next_1 = at_1 + exactly(f * step)
%round line_1 = next_1 + exactly(f * quarter)
%round line_2 = line_1 + exactly(f * quarter)
%round line_3 = line_2 + exactly(f * quarter)
%round pixel_1 = ((line_3 + 0) + 0) + 0
# draw_tiny().
%line L::bounded_sum(function(kEdgeX + k), x, L::bounded_sum(function(kEdgeY + k), y, function(kEdgeValue + k)));
%line for (std::uint32_t k = 0; k < 3; ++k) value[k] = value[k] + function(kEdgeX + k);
%line for (std::uint32_t k = 0; k < 3; ++k) left[k] = left[k] + function(kEdgeY + k);
%round left_0 = 0 + (f * line + value)
%round left_1 = left_0 + exactly(f * quarter)
%round left_2 = left_1 + exactly(f * quarter)
%round tiny = (left_2 + 0) + 0
# Blocks in lanes, of draw_many_blocks(): tile_edge_blocks.g.
# set_up_group(): no pixel of the box.
%source core/gridiron/engine/tree/tile_triangles.h
%line return L::bounded_sum(L::abs(along_x), x1, L::bounded_sum(L::abs(along_y), y1, value));
%line none = none | L::words_of(most_in_box(value, edge_x, edge_y));
%round in_box = 0 + (f * line + value)
# In exact arithmetic, apart from the error.
%define true_block_5 = exact_edge_y * (line + row + 5 * step) + edge_error
%define true_group_8 = exact_edge_y * (line + row + 3 * step + half) + edge_error
%define true_group_3 = exact_edge_y * (line + 3 * step + 3 * quarter) + edge_error
%define true_pixel_1 = exact_edge_y * (line + step + 3 * quarter) + edge_error
%define true_tiny = exact_edge_y * (line + 2 * quarter) + edge_error
%define true_in_box = exact_edge_y * (line) + edge_error

{ |w_i| <= 1 /\ |x_i| <= 1 /\ |w_k| <= 1 /\ |x_k| <= 1 /\
  |row| <= 1 /\ |line| <= 1 /\ |line + row| <= 1 /\ |line + row + step| <= 1 /\ |line + row + 2 * step| <= 1 /\
  |line + row + 3 * step| <= 1 /\ |line + row + 4 * step| <= 1 /\ |line + row + 5 * step| <= 1 /\
  |line + row + 3 * step + half| <= 1 /\
  |line + step| <= 1 /\ |line + 2 * step| <= 1 /\ |line + 3 * step| <= 1 /\ |line + 3 * step + quarter| <= 1 /\
  |line + 3 * step + 2 * quarter| <= 1 /\ |line + 3 * step + 3 * quarter| <= 1 /\ |line + quarter| <= 1 /\
  |line + 2 * quarter| <= 1 /\ |line + step + quarter| <= 1 /\ |line + step + 2 * quarter| <= 1 /\
  |line + step + 3 * quarter| <= 1 /\
  %roundings
  -> edge_error - |block_5 - true_block_5| >= 0 /\ edge_error - |group_8 - true_group_8| >= 0 /\
     edge_error - |group_3 - true_group_3| >= 0 /\ edge_error - |pixel_1 - true_pixel_1| >= 0 /\
     edge_error - |tiny - true_tiny| >= 0 /\
     edge_error - |in_box - true_in_box| >= 0 }

exact_at_16 -> f * (line + row) + edge_error;
at_16 + (f * step) -> f * (line + row + step) + edge_error + (at_16 - exact_at_16);
exact_block_1 -> f * (line + row + step) + edge_error;
block_1 + (f * step) -> f * (line + row + 2 * step) + edge_error + (block_1 - exact_block_1);
exact_block_2 -> f * (line + row + 2 * step) + edge_error;
block_2 + (f * step) -> f * (line + row + 3 * step) + edge_error + (block_2 - exact_block_2);
exact_block_3 -> f * (line + row + 3 * step) + edge_error;
block_3 + (f * step) -> f * (line + row + 4 * step) + edge_error + (block_3 - exact_block_3);
exact_block_4 -> f * (line + row + 4 * step) + edge_error;
block_4 + (f * step) -> f * (line + row + 5 * step) + edge_error + (block_4 - exact_block_4);
exact_block_5 -> f * (line + row + 5 * step) + edge_error;
block_3 + (f * half) -> f * (line + row + 3 * step + half) + edge_error + (block_3 - exact_block_3);
exact_group_8 -> f * (line + row + 3 * step + half) + edge_error;
at_4 + (f * step) -> f * (line + step) + edge_error + (at_4 - exact_at_4);
exact_row_1 -> f * (line + step) + edge_error;
row_1 + (f * step) -> f * (line + 2 * step) + edge_error + (row_1 - exact_row_1);
exact_row_2 -> f * (line + 2 * step) + edge_error;
row_2 + (f * step) -> f * (line + 3 * step) + edge_error + (row_2 - exact_row_2);
exact_row_3 -> f * (line + 3 * step) + edge_error;
row_3 + (f * quarter) -> f * (line + 3 * step + quarter) + edge_error + (row_3 - exact_row_3);
exact_group_1 -> f * (line + 3 * step + quarter) + edge_error;
group_1 + (f * quarter) -> f * (line + 3 * step + 2 * quarter) + edge_error + (group_1 - exact_group_1);
exact_group_2 -> f * (line + 3 * step + 2 * quarter) + edge_error;
group_2 + (f * quarter) -> f * (line + 3 * step + 3 * quarter) + edge_error + (group_2 - exact_group_2);
exact_group_3 -> f * (line + 3 * step + 3 * quarter) + edge_error;
at_1 + (f * step) -> f * (line + step) + edge_error + (at_1 - exact_at_1);
exact_next_1 -> f * (line + step) + edge_error;
next_1 + (f * quarter) -> f * (line + step + quarter) + edge_error + (next_1 - exact_next_1);
exact_line_1 -> f * (line + step + quarter) + edge_error;
line_1 + (f * quarter) -> f * (line + step + 2 * quarter) + edge_error + (line_1 - exact_line_1);
exact_line_2 -> f * (line + step + 2 * quarter) + edge_error;
line_2 + (f * quarter) -> f * (line + step + 3 * quarter) + edge_error + (line_2 - exact_line_2);
exact_line_3 -> f * (line + step + 3 * quarter) + edge_error;
exact_pixel_1 -> f * (line + step + 3 * quarter) + edge_error;
left_0 + (f * quarter) -> f * (line + quarter) + edge_error + (left_0 - exact_left_0);
exact_left_1 -> f * (line + quarter) + edge_error;
left_1 + (f * quarter) -> f * (line + 2 * quarter) + edge_error + (left_1 - exact_left_1);
exact_left_2 -> f * (line + 2 * quarter) + edge_error;
exact_tiny -> f * (line + 2 * quarter) + edge_error;
block_5 - true_block_5 -> (block_5 - exact_block_5) + (f - exact_edge_y) * (line + row + 5 * step);
group_8 - true_group_8 -> (group_8 - exact_group_8) + (f - exact_edge_y) * (line + row + 3 * step + half);
group_3 - true_group_3 -> (group_3 - exact_group_3) + (f - exact_edge_y) * (line + 3 * step + 3 * quarter);
pixel_1 - true_pixel_1 -> (pixel_1 - exact_pixel_1) + (f - exact_edge_y) * (line + step + 3 * quarter);
tiny - true_tiny -> (tiny - exact_tiny) + (f - exact_edge_y) * (line + 2 * quarter);
in_box - true_in_box -> (in_box - exact_in_box) + (f - exact_edge_y) * (line);
