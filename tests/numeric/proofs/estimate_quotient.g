# core/gridiron/ray/distance.h: the factor 2.25 of kUncertain. Where numerator and denominator are at least kUncertain
# times the size of which kFloatError is their error, their quotient is within kEstimateError of the exact one. Only
# ratios count: the rounded numerator and denominator are 1. N and D are the exact ones, h and k the shares of the
# uncertainty; kUncertain is rounded once when multiplied. SPDX-License-Identifier: Apache-2.0
%source core/gridiron/ray/packet.h
%constant kEstimateError inline constexpr float kEstimateError = {};
%source core/gridiron/ray/distance.h
%constant kCharge inline constexpr float kUncertain = kFloatError * {} / kEstimateError;
%proves kCharge least 0.892
%line const auto is_close = denominator > setups.least_denominator;
%line Float t = setups.numerator / denominator;
%define N = 1 + h * kEstimateError / kCharge
%define D = 1 + k * kEstimateError / kCharge
%round t = 1 / 1

{ |h| <= 0x1.000008p0 /\ |k| <= 0x1.000008p0 /\
  %roundings
  -> kEstimateError - |(t - N / D) / (N / D)| >= 0 }
