# core/gridiron/engine/tree/tile_hits.h: what decide() stores of an exact hit, and clear() of t_far. 1 / t is above what is
# stored and below what the span adds, by 2 e: e for what comparisons round, e for the distance by which rounded t surely
# differ. t is rounded, t_far is not. Only ratios count: the exact t is 1, and so is the
# unit, a power of two. SPDX-License-Identifier: Apache-2.0
%source core/gridiron/engine/tree/tile_hits.h
%constant kLess const float exact = (1.0f / (t * eye_->unit)) * (1.0f - {});
%constant kSpan take(block, pixel, lane, stored, stored * {});
%line const float farthest = frame_->t_far * eye_->unit;
%constant kFloor floor_ = farthest < 0x1p60f ? (1.0f / farthest) * (1.0f - {}) : 0.0f;
%constant kFloorSpan const Float none(floor_), span(floor_ * {}), zero(0.0f);
%proves kLess least 0.313
%proves kSpan least 0.329
%proves kFloor least 0.126
%proves kFloorSpan least 0.282

%round t = 1 * 1
%define less = 1 - kLess
%round near = (1 / t) * less
%round span = near * kSpan
%define floor_share = 1 - kFloor
%round floor = (1 / 1) * floor_share
%round floor_span = floor * kFloorSpan

{ %roundings
  -> 1 - 0x2p-23 - near >= 0 /\ near + span - 1 - 0x2p-23 >= 0 /\
     1 - 0x2p-23 - floor >= 0 /\ floor + floor_span - 1 - 0x2p-23 >= 0 }
