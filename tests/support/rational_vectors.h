// Vectors of rational numbers. Memory: heap. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include "numeric/exact_numbers.h"
#include "support/test_headers.h"

namespace gridiron::test {

using RationalPoint = std::array<Rational, 3>;

/// The exact numbers of a point of floats.
inline RationalPoint exact_point(const auto& p) {
  return {Rational(p[0]), Rational(p[1]), Rational(p[2])};
}

inline RationalPoint operator-(const RationalPoint& a, const RationalPoint& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

inline RationalPoint cross(const RationalPoint& a, const RationalPoint& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

inline Rational dot(const RationalPoint& a, const RationalPoint& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

inline Rational determinant(const RationalPoint& a, const RationalPoint& b, const RationalPoint& c) {
  return dot(a, cross(b, c));
}

}  // namespace gridiron::test
