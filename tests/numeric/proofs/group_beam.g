# core/gridiron/engine/tree/ray_groups.h: kGroupMargin. No point of a ray is outside a plane of its group's beam, nor
# beyond its bounds or its reach. Lower planes are shown, upper ones are mirror images; the least of all slopes, offsets
# and ends is below this ray's, and smaller ones round to smaller ones. At w a ray has u = start + m (w - away), and with
# `low` below m that is at least low w + (start - low away). So two claims are enough: the slope that planes take, at
# ahead = w - away, and the offset, with low as it is. For fixed roundings all is linear in starts and, times the slope,
# in places along w: one kind is 1, the others are 0. Powers of two bring slopes to 1. Of up and down one is the slope,
# the other is 0 and does not round. SPDX-License-Identifier: Apache-2.0
%source core/gridiron/engine/tree/ray_groups.h
%constant kGroupMargin inline constexpr float kGroupMargin = {}, kLeastGroupMargin = 0x1p-40f;
%proves kGroupMargin least 0.438
%cases START AWAY WAY SLOPE END FAR
%case 1 0 0 1 1 0
%case 0 1 0 1 0 1
%case 0 1 0 -1 0 1
%case 0 0 1 1 1 1
%case 0 0 1 -1 -1 1

# The slope: m is the exact one of d_u and d_w.
%line (Float(1.0f) / away).store(group.inverse[axis] + base);
%line const Float dir = load(group.dir[other], base), slope = dir * inverse[i];
%line low = low - magnitude(low) * kGroupMargin;
%round inverse = 1 / d_w
%round slope = d_u * inverse
%round taken = slope - size(slope) * kGroupMargin

# What a box that just touches the ray has, and the plane there.
%line const Float entry = (Float::load(near_side + base) - corner[2]) * turn,
%line exit = (Float::load(far_side + base) - corner[2]) * turn;
%line return L::max(L::bounded_sum(up[plane], first, L::bounded_sum(down[plane], last, offset[plane])), bound[plane]);
%line const Float beside_u = L::max(least(0) - (Float::load(node.high[axes.u] + base) - corner[0]),
%round ahead_w = w_ahead - corner_w
%round ahead_u = u_ahead - corner_u
%round least_ahead = taken * ahead_w + 0

# The offset, for a place where w is `away`.
%line const Float start = load(group.origin[other], base) - Float(corner);
%line const Float away = along[i] - Float(nearest), to_low = Float(low) * away, to_high = Float(high) * away;
%line const Float size = L::abs(starts[i]);
%line low_offsets = L::min(starts[i] - to_low - ((size + L::abs(to_low)) * Float(kGroupMargin) + Float(least_margin)),
%round start = o_u - corner_u
%round away = o_w - corner_w
%round to_low = low * away
%round offset = start - to_low - ((size(start) + size(to_low)) * kGroupMargin + 0)
%round start_w = w_start - corner_w
%round start_u = u_start - corner_u
%round least = low * start_w + offset

# Bounds, of a ray's start and of its end.
%line const Float far(0x1p100f), way = L::max(L::min(load(group.t, base) * dir, far), -far), end = start + way;
%line const Float margin = L::abs(start) * Float(kGroupMargin) + Float(least_margin);
%line const Float end_margin = (L::abs(start) + L::abs(way)) * Float(kGroupMargin) + Float(least_margin);
%line lowest = L::min(L::min(start - margin, end - end_margin), lowest);
%round way = t * d_u
%round end = start + way
%round lowest = end - ((size(start) + size(way)) * kGroupMargin + 0)
%round lowest_start = start - (size(start) * kGroupMargin + 0)
%round end_u = u_end - corner_u

# The reach.
%line const Float start = (Float::load(group.origin[axis] + base) - Float(beam.corner[2])) * Float(beam.turn);
%line const Float end = L::bounded_sum(t, L::abs(Float::load(group.dir[axis] + base)), start);
%line return L::horizontal_max(reach) * (1.0f + kGroupMargin) + kLeastReach;
%round reach = (t * d_w + away) * exactly(1 + kGroupMargin) + 0
%round end_w = w_end - corner_w

{ d_w in [1, 1] /\ d_u in [SLOPE, SLOPE] /\ low in [SLOPE, SLOPE] /\ t in [WAY, WAY] /\
  o_u - corner_u in [START, START] /\ o_w - corner_w in [AWAY, AWAY] /\
  u_ahead - corner_u in [SLOPE, SLOPE] /\ w_ahead - corner_w in [1, 1] /\
  u_start - corner_u in [START, START] /\ w_start - corner_w in [AWAY, AWAY] /\
  u_end - corner_u in [END, END] /\ w_end - corner_w in [FAR, FAR] /\
  %roundings
  -> ahead_u - least_ahead >= 0 /\ start_u - least >= 0 /\ start_u - lowest_start >= 0 /\ end_u - lowest >= 0 /\
     reach - end_w >= 0 }
