# core/gridiron/ray/edges.h: half of kSubpacketErrorFactor covers the roundings of the linear form, as
# subpackets_near() evaluates it. `value` is at least the form at any pixel of a subpacket, value - span at most: t is
# the pixel's share of the three columns. max(per_column, 0) is at least t per_column, so q = t there; |per_column| is
# per_column or the opposite, and max(per_column, 0) - |per_column| is at most t per_column, so that q - s = t with q
# = 0 or 1. All is linear in first, per_column and per_row, |first| + x_last |per_column| + y_last |per_row| is at
# most 2 scale D, and x_last at least 13/2: one of them is 0 (place_outside.g), columns add up to 15/13 of x_last,
# rows round no more. SPDX-License-Identifier: Apache-2.0
%source core/gridiron/ray/edges.h
%constant kEdgeErrorFactor inline constexpr float kEdgeErrorFactor = {};
%constant kSubpacketErrorFactor inline constexpr float kSubpacketErrorFactor = {};
%proves kSubpacketErrorFactor least 0.938
%cases FIRST IN_SQUARE SQUARE STEP
%case 0x2.5p0 0 0 0x0.4EDp0
%case -0x2.5p0 0 0 0x0.4EDp0
%case 0 0x7.8p0 0 0x0.4EDp0
%case 0 0 0x7.8p0 0x0.4EDp0

%line static constexpr float kSubpacketSpan = kSubpacketWidth - 1.0f;
%line static constexpr float kSquareSpan = 2.0f * kSubpacketWidth - 1.0f;
%line const Float rise = rise_column + L::max(per_row, Float(0.0f));  // per pixel of a square's side
%line (first + rise * Float(kSquareSpan)).store(batch.first_square);
%line (rise * Float(kSubpacketSpan - kSquareSpan)).store(batch.square_to_subpacket);
%line ((L::abs(per_column) + L::abs(per_row)) * Float(kSubpacketSpan)).store(batch.subpacket_span);
%round rise = exactly(q * per_column) + 0
%round first_square = first + rise * 7
%round square_to_subpacket = -(rise * 4)
%round span = (exactly(s * per_column) + 0) * 3
%source core/gridiron/ray/subpackets.h
%line offset[edge] = Float(batch.first_square[lane] + batch.square_to_subpacket[lane]) +
%line (Float::load(kLanePlaces.subpacket_column) * Float(batch.per_column[lane]) +
%line Float::load(kLanePlaces.subpacket_row) * Float(batch.per_row[lane]));
%line const Float value = offset[edge] + Float(kSquareOrigins.column[square] * batch.per_column[lane] +
%line kSquareOrigins.row[square] * batch.per_row[lane]);
%line outside |= (value < limit[edge]).bits();
%line inside &= (value - span[edge] > -limit[edge]).bits();
%round offset = (first_square + square_to_subpacket) + (in_square * per_column + 0)
%round value = offset + (square * per_column + 0)
%round least = value - span

# |d|max cancels, but for its roundings.
%source core/gridiron/ray/edges.h
%line const Float error = scale * Float(kEdgeErrorFactor * packet.dir_max) + Float(kUnderflow * packet.range_factor);
%line (-(error * Float(packet.subpacket_widening))).store(batch.surely_outside);
%round size_a = 1 + 0 + 0
%round size_f = 1 + 0
%round scale = (size_a + 0) * size_f
%round error = scale * (kEdgeErrorFactor * 1) + 0
%source core/gridiron/ray/camera.h
%line packet.subpacket_widening = kSubpacketErrorFactor / kEdgeErrorFactor * (dir_bound / dir_max);
%define factor = kSubpacketErrorFactor / kEdgeErrorFactor
%round dir_bound = 1 + 0 + 0
%round widening = factor * (dir_bound / 1)
%round limit = error * widening

{ first in [FIRST, FIRST] /\ in_square in [IN_SQUARE, IN_SQUARE] /\ square in [SQUARE, SQUARE] /\
  per_column in [STEP, STEP] /\ q in [0, 1] /\ |s| <= 1 /\
  %roundings
  -> limit / 2 - |value - exact_value| >= 0 /\ limit / 2 - |least - exact_least| >= 0 }
