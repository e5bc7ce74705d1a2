# core/gridiron/engine/tree/tile_triangles.h: kTileEdgeError, of an edge's value at the offset, in every way that a pixel
# comes by it. For fixed roundings the value at a pixel is linear in products of one coordinate of either corner. With P
# the largest |x| or |y|, R W the farthest pixel times the largest |w|: two products go into the value, each at most P P,
# two into a step of a pixel (tile_edge_step.g), each at most P W. `size` is P + R W, its square has P P once and P R W
# twice, once for columns and once for rows. So two products of 1 must be within kTileEdgeError times two sizes of 1.
# What `moved` takes is a matter of its own (tile_corner.g). SPDX-License-Identifier: Apache-2.0
%source core/gridiron/engine/tree/tile_triangles.h
%constant kTileEdgeError inline constexpr float kTileEdgeError = {};
%proves kTileEdgeError least 0.801

%line const Float size = L::bounded_sum(reach, most_w, L::max(most_x, most_y));
%line (size + moved) * (moved * Float(kCornerFactor) + size * Float(kTileEdgeError)) + Float(kLeastEdgeError);
%round size = 0 * 0 + 1
%round error = (size + 0) * (0 * 0 + size * kTileEdgeError) + 0
# The value has the error, rounded once for all.
%define edge_error = error
%line const Float value = L::turn_by(volume, x[i] * y[next] - y[i] * x[next]) + edge_error;
%round value = (x_i * y_k - y_i * x_k) + edge_error

# The steps are 0. draw_triangle(), 16 lanes: six blocks in a row or a column.
%source core/gridiron/engine/tree/tile_tracer.h
%line static constexpr std::uint32_t kFewBlocks = kLanes == 16 ? 6 : kLanes == 1 ? 2 : 4;
%line start[k] = L::bounded_sum(x[k], column, kLanes > kBlockWidth ? L::bounded_sum(y[k], row, value[k]) : value[k]);
%line return L::bounded_sum(x[k], column, L::bounded_sum(y[k], row, start[k]));
%line for (int k = 0; k < 4; ++k) value[k] = value[k] + right[k];
%line for (int k = 0; k < 4; ++k) row[k] = row[k] + down[k];
%round start_16 = 0 + (0 + value)
%round at_16 = 0 + (0 + start_16)
%round block_16 = ((((at_16 + 0) + 0) + 0) + 0) + 0
# 8 lanes: four blocks, one step to the second group.
%line for (int k = kCovered ? 3 : 0; k < 4; ++k) value[k] = value[k] + f.step[k];
%round block_8 = (((at_16 + 0) + 0) + 0) + 0
# 4 lanes: a sum less in start[], four blocks, three steps.
%round start_4 = 0 + value
%round at_4 = 0 + (0 + start_4)
%round block_4 = (((((at_4 + 0) + 0) + 0) + 0) + 0) + 0
# One lane, draw_pixels(): two blocks, three rows and three columns on.
%line for (int k = kCovered ? 3 : 0; k < 4; ++k) value[k] = value[k] + f.x[k];
%line for (int k = kCovered ? 3 : 0; k < 4; ++k) line[k] = line[k] + f.y[k];
%round at_1 = 0 + (0 + value)
%round pixel_1 = ((((((at_1 + 0) + 0) + 0) + 0) + 0) + 0) + 0
# draw_tiny().
%line L::bounded_sum(function(kEdgeX + k), x, L::bounded_sum(function(kEdgeY + k), y, function(kEdgeValue + k)));
%line for (std::uint32_t k = 0; k < 3; ++k) value[k] = value[k] + function(kEdgeX + k);
%line for (std::uint32_t k = 0; k < 3; ++k) left[k] = left[k] + function(kEdgeY + k);
%round tiny = (((((0 + (0 + value)) + 0) + 0) + 0) + 0)
# draw_many_blocks(): what it skips, and what it takes to be covered.
%line most[k] = (L::max(f.x[k], zero) + L::max(f.y[k], zero)) * last + f.value[k];
%line if (k < 3) least[k] = (L::min(f.x[k], zero) + L::min(f.y[k], zero)) * last + f.value[k];
%line met = met & (along + most[k] > Float(0.0f));
%line covered = covered & (along + least[k] > f.edge_span);
%round many = 0 + (0 + value)
# set_up_group(): no pixel of the box.
%source core/gridiron/engine/tree/tile_triangles.h
%line return value + L::max(along_x * x0, along_x * x1) + L::max(along_y * y0, along_y * y1);
%round in_box = value + 0 + 0

{ |x_i| <= 1 /\ |y_i| <= 1 /\ |x_k| <= 1 /\ |y_k| <= 1 /\
  %roundings
  -> edge_error - |block_16 - exact_block_16| >= 0 /\ edge_error - |block_8 - exact_block_8| >= 0 /\
     edge_error - |block_4 - exact_block_4| >= 0 /\ edge_error - |pixel_1 - exact_pixel_1| >= 0 /\
     edge_error - |tiny - exact_tiny| >= 0 /\ edge_error - |many - exact_many| >= 0 /\
     edge_error - |in_box - exact_in_box| >= 0 }
