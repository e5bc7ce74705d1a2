# core/gridiron/engine/tree/tile_triangles.h: kNearError, of the value of 1 / t at the offset, in every way that a pixel
# comes by it. For fixed roundings this is linear in nx, ny and nw over the rounded volume, and `most_near` in their
# magnitudes: nw / volume is 1, the others are 0; steps are in tile_near_step.g. 2 e are left on each side for what
# comparisons round and for the distance by which rounded t surely differ: see the README. What `relative` and w_error
# take is a matter of their own. SPDX-License-Identifier: Apache-2.0
%source core/gridiron/engine/tree/tile_triangles.h
%constant kNearError inline constexpr float kNearError = {};
%proves kNearError least 0.810

%line const Float inverse = Float(1.0f) / volume;
%line const Float near_x = nx * inverse, near_y = ny * inverse, near_w = nw * inverse;
%round inverse = 1 / volume
%round near_w = nw * inverse
%line const Float most_near = L::bounded_sum(L::abs(near_x) + L::abs(near_y), reach, L::abs(near_w));
%line const Float near_error = most_near * (relative * Float(kSecondOrder) + Float(kNearError + 2.0f * tile.w_error));
%round most_near = 0 * 0 + size(near_w)
%round error = most_near * (0 + (kNearError + 0))
%line const Float near_value = near_w - near_error, near_span = near_error + near_error;
%define near_error = error
%round near_value = near_w - near_error

# The steps are 0. draw_triangle(): 16, 8, 4 lanes and one, see tile_edge_value.g.
%source core/gridiron/engine/tree/tile_tracer.h
%line start[k] = L::bounded_sum(x[k], column, kLanes > kBlockWidth ? L::bounded_sum(y[k], row, value[k]) : value[k]);
%line return L::bounded_sum(x[k], column, L::bounded_sum(y[k], row, start[k]));
%line for (int k = 0; k < 4; ++k) value[k] = L::bounded_sum(drawn.x[k], Float(kBlockStep), value[k]);
%line for (int k = 0; k < 4; ++k) row[k] = L::bounded_sum(drawn.y[k], Float(kBlockStep), row[k]);
%line for (int k = kCovered ? 3 : 0; k < 4; ++k) value[k] = value[k] + f.step[k];
# What decides, by the sign.
%line ahead[group] = value[3] - Float::load(stored + group * kLanes);
%line possible[group] = L::words_of(ahead[group] + f.near_span);
%line surely[group] = L::words_of(ahead[group] - old_span);
%round start_16 = 0 + (0 + near_value)
%round at_16 = 0 + (0 + start_16)
%round block_16 = ((((at_16 + 0) + 0) + 0) + 0) + 0
%round block_8 = (((at_16 + 0) + 0) + 0) + 0
%round start_4 = 0 + near_value
%round at_4 = 0 + (0 + start_4)
%round block_4 = (((((at_4 + 0) + 0) + 0) + 0) + 0) + 0
%line for (int k = kCovered ? 3 : 0; k < 4; ++k) value[k] = value[k] + f.x[k];
%line for (int k = kCovered ? 3 : 0; k < 4; ++k) line[k] = line[k] + f.y[k];
%round at_1 = 0 + (0 + near_value)
%round pixel_1 = ((((((at_1 + 0) + 0) + 0) + 0) + 0) + 0) + 0
# draw_tiny().
%line left[3] = L::bounded_sum(function(kNearX), x, L::bounded_sum(function(kNearY), y, function(kNearValue)));
%line value[3] = value[3] + function(kNearX);
%line left[3] = left[3] + function(kNearY);
%round tiny = (((((0 + (0 + near_value)) + 0) + 0) + 0) + 0)
# draw_many_blocks(): the greatest value of a block, with the span.
%line most[k] = (L::max(f.x[k], zero) + L::max(f.y[k], zero)) * last + f.value[k];
%line most[3] = most[3] + f.near_span;
%line across[k][group] = kGroupRows > 1 ? L::bounded_sum(f.x[k], x, f.y[k] * y) : f.x[k] * x;
%line for (int k = 0; k < 4; ++k) down[k] = L::bounded_sum(f.y[k], line, most[k]);
%line Int none = L::words_of((across[3][group] + down[3]) - Float::load(memory_.least_near + base));
%define near_span = 2 * near_error
%round many = (0 + 0) + (0 + (((0 + 0) * 3 + near_value) + near_span))
# TileHits::near_of(): an open pixel.
%source core/gridiron/engine/tree/tile_hits.h
%line return functions[kNearX][lane] * x + (functions[kNearY][lane] * y + functions[kNearValue][lane]);
%round open = 0 + (0 + near_value)
# set_up_group(): all hidden.
%source core/gridiron/engine/tree/tile_triangles.h
%line return L::bounded_sum(L::abs(along_x), x1, L::bounded_sum(L::abs(along_y), y1, value));
%line Int none = L::words_of(most_in_box(near_value, near_x, near_y) + near_span - least);
%round in_box = (0 + (0 + near_value)) + near_span

%define left_over = 0x2p-23 * most_near

{ nw / volume in [1, 1] /\ |nw| in [1, 1] /\ |volume| in [1, 1] /\
  %roundings
  -> near_error - |block_16 - exact_block_16| - left_over >= 0 /\ near_error - |block_8 - exact_block_8| - left_over >= 0 /\
     near_error - |block_4 - exact_block_4| - left_over >= 0 /\ near_error - |pixel_1 - exact_pixel_1| - left_over >= 0 /\
     near_error - |tiny - exact_tiny| - left_over >= 0 /\
     near_error - |open - exact_open| - left_over >= 0 /\
     near_error - |many - exact_many| - left_over >= 0 /\ near_error - |in_box - exact_in_box| - left_over >= 0 }
