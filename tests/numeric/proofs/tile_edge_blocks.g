# core/gridiron/engine/tree/tile_triangles.h: kTileEdgeError, of an edge's step from row to row where blocks are looked
# at in lanes; the argument is that of tile_edge_step.g, which covers columns too. Lanes may have several rows of
# blocks, `deeper` below the first of them, which may be above the box: it is at `upper`. Three pixels are a `share` of
# R.
# SPDX-License-Identifier: Apache-2.0
%source core/gridiron/engine/tree/tile_triangles.h
%constant kTileEdgeError inline constexpr float kTileEdgeError = {};
%proves kTileEdgeError least 0.941
# With more than four blocks R is at least 2.5 + 3. A block begins at most R above the offset and at most R - 3 below
# it. Two rows of blocks in lanes reach one above the box: 4 pixels. Four are in 16 lanes, in tiles of 4 by 4 blocks,
# where more than six are looked at: of two rows, so that the first one of the lanes is at most 13 above the offset,
# with R at least 7.5; or of three, at most 9.5 above with R at least 5.5, 10 with 6, 11 with 7. Where `deeper` is 12
# and R below 6.5, it is three, and the last one begins at most 3 below the offset. So the cases are: `deeper` is at
# most 8; it is 12, with R at least 6.5; the same with R below. A step is positive or negative.
%cases DEEPER SHARE RISES FALLS GREATEST LEAST
%case 0x1.75p0 0x0.8BBp0 1 0 1 1
%case 0x1.75p0 0x0.8BBp0 0 1 1 1
%case 0x1.D9p0 0x0.763p0 1 0 1 1
%case 0x1.D9p0 0x0.763p0 0 1 1 1
%case 0x1.18p1 0x0.8BBp0 1 0 1 0x0.81p0
%case 0x1.18p1 0x0.8BBp0 0 1 0x0.81p0 1

%line const Float size = L::bounded_sum(reach, most_w, L::max(most_x, most_y));
%line (size + moved) * (moved * Float(kCornerFactor) + size * Float(kTileEdgeError)) + Float(kLeastEdgeError);
%round size_p = 0 * 0 + 1
%round size_w = 1 * 1 + 0
%round error_p = (size_p + 0) * (0 * 0 + size_w * kTileEdgeError) + 0
%round error_w = (size_w + 0) * (0 * 0 + size_p * kTileEdgeError) + 0
%define edge_error = (error_p + error_w) / 2
%round value = 0 + edge_error
%line const auto turned = [&](Float a) GRIDIRON_INLINE_LAMBDA { return L::floats_of(L::words_of(a) ^ sign); };
%line const Float edge_y = turned(L::bounded_difference(w[i], x[next], x[i], w[next]));
%round edge_y = w_i * x_k - x_i * w_k
%define f = edge_y
%line (edge_error + edge_error).store(memory.functions[kEdgeSpan]);
%define edge_span = 2 * edge_error

# draw_many_blocks(): a block's greatest value, and by what the least one is below it.
%source core/gridiron/engine/tree/tile_tracer.h
%line static constexpr std::uint32_t kFewBlocks = kLanes == 16 ? 6 : kLanes == 1 ? 2 : 4;
%line most[k] = (L::max(f.x[k], zero) + L::max(f.y[k], zero)) * last + f.value[k];
%line least[k] = (L::min(f.x[k], zero) + L::min(f.y[k], zero)) * last + f.value[k];
%line across[k][group] = kGroupRows > 1 ? L::bounded_sum(f.x[k], x, f.y[k] * y) : f.x[k] * x;
%line for (int k = 0; k < 3; ++k) covers[k] = (most[k] - least[k]) + f.edge_span;
%line for (std::uint32_t by = by0 - by0 % kGroupRows; by <= by1; by += kGroupRows) {
%line for (int k = 0; k < 4; ++k) down[k] = L::bounded_sum(f.y[k], line, most[k]);
%line const Float value = across[k][group] + down[k];
%line none = none | L::words_of(value);
%line partial = partial | L::words_of(value - covers[k]);
%define last = 3
%define first = share / 3 * rises
%define second = share / 3 * falls
%round most = (0 + exactly(f * first)) * last + value
%round least = (0 + exactly(f * second)) * last + value
%round across = 0 + f * deeper
%round slope = f * upper
%round down = slope + most
%round many = across + down
%round gap = most - least
%round covers = gap + edge_span
%round covered = many - covers
# In exact arithmetic, apart from the error.
%define true_many = exact_edge_y * (upper + deeper + share * rises) + edge_error
%define true_covered = exact_edge_y * (upper + deeper + share * falls) - edge_error

{ |w_i| <= 1 /\ |x_i| <= 1 /\ |w_k| <= 1 /\ |x_k| <= 1 /\
  share in [0, SHARE] /\ rises in [RISES, RISES] /\ falls in [FALLS, FALLS] /\
  |deeper| <= DEEPER /\ |upper| <= 0x1.Cp0 /\ |upper + share * rises| <= 0x1.Cp0 /\
  |upper + deeper + share * rises| <= GREATEST /\ |upper + deeper + share * falls| <= LEAST /\
  %roundings
  -> edge_error - |many - true_many| >= 0 /\ edge_error - |covered - true_covered| >= 0 }

exact_most -> f * (share * rises) + edge_error;
exact_least -> f * (share * falls) + edge_error;
most - least -> f * (share * (rises - falls)) + (most - exact_most) - (least - exact_least);
slope + most -> f * (upper + share * rises) + edge_error + (slope - exact_slope) + (most - exact_most);
exact_down -> f * (upper + share * rises) + edge_error;
across + down -> f * (upper + deeper + share * rises) + edge_error + (across - exact_across) + (down - exact_down);
exact_many -> f * (upper + deeper + share * rises) + edge_error;
exact_gap -> f * (share * (rises - falls));
exact_covers -> f * (share * (rises - falls)) + edge_span;
many - covers -> f * (upper + deeper + share * falls) - edge_error + (many - exact_many) - (covers - exact_covers);
exact_covered -> f * (upper + deeper + share * falls) - edge_error;
many - true_many -> (many - exact_many) + (f - exact_edge_y) * (upper + deeper + share * rises);
covered - exact_covered ->
  (covered - (many - covers)) + (many - (across + down)) + (across - exact_across) + (down - (slope + most)) +
  (slope - exact_slope) - (covers - (gap + edge_span)) - (gap - (most - least)) + (least - exact_least);
covered - true_covered -> (covered - exact_covered) + (f - exact_edge_y) * (upper + deeper + share * falls);
