# core/gridiron/ray/distance.h, distances_of(): the 2^-50 of relative_error, for what rounds in quotient and interval.
# The exact distance N / D is between `low` and `high`. numerator_part is the numerator's bound over its size,
# denominator_part the denominator's; errors are at most `half` of them (distance_numerator.g,
# distance_denominator.g), h and k their shares. Only ratios count: rounded numerator and denominator are 1. Times the
# exact denominator, all is linear in the parts but for one product with `low` or `high`, which is near 1 there. So
# the corners of the triangle `relative` < 2^-10 are enough. SPDX-License-Identifier: Apache-2.0
%source core/gridiron/ray/edges_and_distance.cpp
%constant kRounding setup.relative_error = plane.volume_error / magnitude(plane.volume) + {};
%proves kRounding least 0.502
%unit 0x1p-52
%cases NUMERATOR DENOMINATOR
%case 0 0
%case 0x1.01p-10 0
%case 0 0x1.01p-10

%line setup.relative_error_per_t = double{dir_max} * plane.normal_error / magnitude(plane.volume);
%round relative_error = numerator_part / 1 + kRounding
%round relative_error_per_t = 1 * denominator_part / 1
%source core/gridiron/ray/distance.h
%line const Double quotient = Double(setup.numerator) / denominator;
%line const Double relative = quotient * Double(setup.relative_error_per_t) + Double(setup.relative_error);
%line const Long sure = (low == high) & (pattern >= 0x00800000) & (pattern <= 0x7F7FFFFF) & (relative < 0x1p-10);
%line const Long low = ((quotient - quotient * relative).pattern() + kHalfStep) >> 29;
%line const Long high = ((quotient + quotient * relative).pattern() + kHalfStep) >> 29;
%round quotient = 1 / 1
%round relative = quotient * relative_error_per_t + relative_error
%round low = quotient - quotient * relative
%round high = quotient + quotient * relative
%define N = 1 + h * half * numerator_part

{ |h| <= 1 /\ |k| <= 1 /\ half in [0x0.83p0, 0x0.83p0] /\ near_one in [0x0.FFp0, 0x1.01p0] /\
  numerator_part in [NUMERATOR, NUMERATOR] /\ denominator_part in [DENOMINATOR, DENOMINATOR] /\
  %roundings
  -> N - low - k * half * denominator_part * near_one >= 0 /\ high + k * half * denominator_part * near_one - N >= 0 }
