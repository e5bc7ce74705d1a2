# core/gridiron/ray/packet.h: the factor 3 of kSurelyNearer and kSurelyBehind. A hit that merge_distances() takes for
# nearer or behind is so in exact arithmetic, if old t and the new quotient are within kEstimateError of the exact
# distances. Only ratios count: denominator and exact old distance are 1. Were the exact new distance 1 or more, the
# numerator, which is the quotient then, would be at least 1 - kEstimateError: not below `nearer`. Likewise for
# `behind`. SPDX-License-Identifier: Apache-2.0
%source core/gridiron/ray/packet.h
%constant kEstimateError inline constexpr float kEstimateError = {};
%constant kNearer inline constexpr float kSurelyNearer = 1.0f - {} * kEstimateError;
%constant kBehind inline constexpr float kSurelyBehind = 1.0f + {} * kEstimateError;
%proves kNearer least 0.668
%proves kBehind least 0.669
%source core/gridiron/ray/distance.h
%line const Float old_numerator = old_t * denominator;
%line (is_close & (setups.numerator < old_numerator * Float(kSurelyNearer))).bits() & hit & packet.estimates;
%line (is_close & (setups.numerator > old_numerator * Float(kSurelyBehind)));
%define old_t = 1 + h * kEstimateError
%define surely_nearer = 1 - kNearer * kEstimateError
%define surely_behind = 1 + kBehind * kEstimateError
%round old_numerator = old_t * 1
%round nearer = old_numerator * surely_nearer
%round behind = old_numerator * surely_behind

{ |h| <= 1 /\
  %roundings
  -> (1 - kEstimateError) - nearer >= 0 /\ behind - (1 + kEstimateError) >= 0 }
