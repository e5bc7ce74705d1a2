# core/gridiron/engine/tree/tile_hits.h: the 2^-9 of far. Whatever has a w above it is behind all hits: 1 / t is below
# least_near by 2 e, see tile_stored.g. Of boxes w is a lower bound; of corners it may be off by 2^-12 (kLeastSureW for
# tiles of 8 pixels), which needs no kSurelyFarther. w is t (1 + k), |k| at most 0.601 2^-9: see the README. least_near is
# 1. SPDX-License-Identifier: Apache-2.0
%source core/gridiron/engine/tree/tile_hits.h
%constant kFarther far_ = least_near_ > 0x1p-100f ? (1.0f / least_near_) * (1.0f + {}) : kFloatMax;
%proves kFarther least 0.730
%source core/gridiron/engine/tree/tile_triangles.h
%line const auto is_near = least_w > Float(error * kLeastSureW);  // else pixels cannot be told
%line const std::uint32_t hidden = (least_w * Float(kSurelyFarther) > Float(far)).bits() & is_near.bits();
%define share = 1 + kFarther
%round far = (1 / 1) * share
%round corner = far * 1

{ one in [1, 1] /\
  %roundings
  -> far / (1 + 0x0.9Ap-9) - 1 - 0x3p-23 >= 0 /\ corner * (1 - 0x1.01p-12) / (1 + 0x0.9Ap-9) - 1 - 0x3p-23 >= 0 }
