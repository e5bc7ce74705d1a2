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
%line const auto turned = [&](Float a) GRIDIRON_INLINE_LAMBDA { return L::floats_of(L::words_of(a) ^ sign); };
%line const Float value = turned(L::bounded_difference(x[i], y[next], y[i], x[next])) + edge_error;
%round value = (x_i * y_k - y_i * x_k) + edge_error

# The steps are 0. draw_triangle(), 16 lanes: six blocks in a row or a column.
%source core/gridiron/engine/tree/tile_tracer.h
%line static constexpr std::uint32_t kFewBlocks = kLanes == 16 ? 6 : kLanes == 1 ? 2 : 4;
%line start[k] = L::bounded_sum(x[k], column, kLanes > kBlockWidth ? L::bounded_sum(y[k], row, value[k]) : value[k]);
%line return L::bounded_sum(x[k], column, L::bounded_sum(y[k], row, start[k]));
%line for (int k = 0; k < 4; ++k) value[k] = L::bounded_sum(drawn.x[k], Float(kBlockStep), value[k]);
%line for (int k = 0; k < 4; ++k) row[k] = L::bounded_sum(drawn.y[k], Float(kBlockStep), row[k]);
%round start_16 = 0 + (0 + value)
%round at_16 = 0 + (0 + start_16)
%round block_16 = ((((at_16 + 0) + 0) + 0) + 0) + 0
# 8 lanes: four blocks, one step to the second group.
%line for (int k = kCovered ? 3 : 0; k < 4; ++k) value[k] = value[k] + f.step[k];
%round block_8 = (((at_16 + 0) + 0) + 0) + 0
# What decides, by the sign.
%line possible[group] = possible[group] | L::words_of(inside[group]);
%line if constexpr (!kCovered) surely[group] = surely[group] | L::words_of(inside[group] - f.edge_span);
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
%line const std::uint32_t met = ~L::sign_bits(L::words_of(least)) & columns[column] & lines[row];
%round tiny = (((((0 + (0 + value)) + 0) + 0) + 0) + 0)
# draw_many_blocks(): what it skips, and what it takes to be covered.
%line most[k] = (L::max(f.x[k], zero) + L::max(f.y[k], zero)) * last + f.value[k];
%line least[k] = (L::min(f.x[k], zero) + L::min(f.y[k], zero)) * last + f.value[k];
%line across[k][group] = kGroupRows > 1 ? L::bounded_sum(f.x[k], x, f.y[k] * y) : f.x[k] * x;
%line for (int k = 0; k < 3; ++k) covers[k] = (most[k] - least[k]) + f.edge_span;
%line for (int k = 0; k < 4; ++k) down[k] = L::bounded_sum(f.y[k], line, most[k]);
%line const Float value = across[k][group] + down[k];
%line none = none | L::words_of(value);
%line partial = partial | L::words_of(value - covers[k]);
%round most = (0 + 0) * 3 + value
%round least = (0 + 0) * 3 + value
%round many = (0 + 0) + (0 + most)
%define edge_span = 2 * edge_error
%round covered = many - ((most - least) + edge_span)
# set_up_group(): no pixel of the box.
%source core/gridiron/engine/tree/tile_triangles.h
%line return L::bounded_sum(L::abs(along_x), x1, L::bounded_sum(L::abs(along_y), y1, value));
%line none = none | L::words_of(most_in_box(value, edge_x, edge_y));
%round in_box = 0 + (0 + value)

{ |x_i| <= 1 /\ |y_i| <= 1 /\ |x_k| <= 1 /\ |y_k| <= 1 /\
  %roundings
  -> edge_error - |block_16 - exact_block_16| >= 0 /\ edge_error - |block_8 - exact_block_8| >= 0 /\
     edge_error - |block_4 - exact_block_4| >= 0 /\ edge_error - |pixel_1 - exact_pixel_1| >= 0 /\
     edge_error - |tiny - exact_tiny| >= 0 /\ edge_error - |many - exact_many| >= 0 /\
     edge_error - |covered - exact_covered| >= 0 /\
     edge_error - |in_box - exact_in_box| >= 0 }
