# core/gridiron/engine/tree/leaf_test.h: the room of 2^-20 in judge() and least_t(), for what rounds after the bounds
# of `ahead` and `size`. A / S is the exact distance, A and S within the bounds of ahead and size, of which the sign
# is known.
# - beyond: if A <= S t, then ahead - ahead_error <= (size + turn) t: least_ahead is not above most_limit.
# - within: if A >= S t, then ahead + ahead_error >= (size - turn) t: most_ahead is not below least_limit.
# - least_t() is not above A / S, which is at least (ahead - ahead_error) / (size + turn).
# Only ratios count: the sums with turn, their products with t and ahead - ahead_error for least_t() are 1 before they
# round. Where least_ahead is negative, least_t() is below any hit. SPDX-License-Identifier: Apache-2.0
%source core/gridiron/engine/tree/leaf_test.h
%constant kBelow const Float least_limit = (size - turn) * t * Float(1.0f - {}),
%constant kAbove most_limit = (size + turn) * t * Float(1.0f + {});
%constant kFirst return L::select(size > turn, least_ahead / (size + turn) * Float(1.0f - {}), Float(-1.0f));
%proves kBelow least 0.501
%proves kAbove least 0.501
%proves kFirst least 0.501
%proves kWide least 0.751
%line const Float least_ahead = ahead - ahead_error, most_ahead = ahead + ahead_error;
%line const std::uint32_t beyond = (least_ahead > most_limit).bits() & sign_known;
%line in_reach & passed, in_reach & ~passed, (most_ahead < least_limit).bits() & in_front, least_ahead, size, turn};
%define above = 1 + kAbove
%define below = 1 - kBelow
%define first = 1 - kFirst
%round least_ahead = low - 0
%round most_limit = (1 + 0) * 1 * above
%round most_ahead = high + 0
%round least_limit = (1 - 0) * 1 * below
%round nearest_ahead = nearest - 0
%round least_t = nearest_ahead / (1 + 0) * first
# Wide lanes rule out first what is beyond a limit of which only `size` has the room; it is above turn. Sums round
# once.
%constant kWide const Float limit = sum(sum(size, Float(1.0f + {}), turn), q.t, Float(2.0f * kLeastAhead));
%line (sum(most, -wide_normal_error, ahead) > limit);
%define wide_above = 1 + kWide
%round wide_sum = fused(1, wide_above, turn)
%round wide_limit = fused(wide_sum, 1, 0)
%define wide_low = 1 + turn
%round wide_ahead = wide_low + 0

# Groups do the same.
%source core/gridiron/engine/tree/ray_groups.h
%line behind = (ahead - error) - (size + turn) * q.t * Float(1.0f + 0x1p-20f);
%line behind = sum(most, -error, ahead) - sum(sum(size, Float(1.0f + 0x1p-20f), turn), q.t, Float(2.0f * kLeastAhead));

{ turn in [0, 1] /\ low in [0, 1] /\ high in [1, 1] /\ nearest in [1, 1] /\
  %roundings
  -> most_limit - least_ahead >= 0 /\ most_ahead - least_limit >= 0 /\ nearest - least_t >= 0 /\
     wide_limit - wide_ahead >= 0 }

wide_limit - wide_ahead -> (wide_limit - exact_wide_limit) - (wide_ahead - exact_wide_ahead) + kWide;
