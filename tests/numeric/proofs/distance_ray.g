# core/gridiron/ray/edges_and_distance.cpp, distance_interval(): the 2^-49 for what rounds in quotient and interval.
# The exact distance N / D is between `low` and `high`. numerator_part is the numerator's bound over its size,
# denominator_part the denominator's; errors are at most `half` of them (distance_numerator.g,
# distance_denominator.g), h and k their shares. Only ratios count: rounded numerator and denominator are 1. Times the
# exact denominator, all is linear in the parts but for one product with `low` or `high`, which is near 1 there. So
# the corners of the triangle `error` < 2^-10 are enough. SPDX-License-Identifier: Apache-2.0
%source core/gridiron/ray/edges_and_distance.cpp
%constant kRounding (plane.volume_error + size * (double{dir_max} * plane.normal_error)) * magnitude(inverse) + {} * size;
%proves kRounding least 0.376
%unit 0x1p-52
%cases NUMERATOR DENOMINATOR
%case 0 0
%case 0x1.01p-10 0
%case 0 0x1.01p-10

%line const double inverse = 1.0 / denominator;
%line const double quotient = plane.volume * inverse;
%line if (!(size > 0.0 && error < 0x1p-10 * size)) return {0.0, static_cast<double>(kInfinity)};
%line return {quotient - error, quotient + error};
# Groups do the same in lanes.
%source core/gridiron/engine/tree/ray_groups.h
%line const Double inverse = Double(1.0) / denominator, quotient = volume * inverse, size = L::abs(quotient);
%line const Double turn = size * (Double::load_floats(group.dir_max + first) * Double(normal_error));
%line const Double error = (volume_size * Double(kDistanceError) + turn) * L::abs(inverse) + Double(0x1p-49) * size;
%line const Long known = (Double(0.0) < size) & (error < Double(0x1p-10) * size);
%line const Long low = ((quotient - error).pattern() + kHalfStep) >> 29;
%line const Long high = ((quotient + error).pattern() + kHalfStep) >> 29;
%round inverse = 1 / 1
%round quotient = 1 * inverse
%round error = (numerator_part + size(quotient) * (1 * denominator_part)) * size(inverse) + kRounding * size(quotient)
%round low = quotient - error
%round high = quotient + error
%define N = 1 + h * half * numerator_part

{ |h| <= 1 /\ |k| <= 1 /\ half in [0x0.83p0, 0x0.83p0] /\ near_one in [0x0.FFp0, 0x1.01p0] /\
  numerator_part in [NUMERATOR, NUMERATOR] /\ denominator_part in [DENOMINATOR, DENOMINATOR] /\
  %roundings
  -> N - low - k * half * denominator_part * near_one >= 0 /\ high + k * half * denominator_part * near_one - N >= 0 }
