// Decimal text to numbers, correctly rounded, without tables, locale or libm.
// Memory: none kept; at most 400 bytes of stack. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace gridiron {

/// Longest text that parse_float and is_number accept; the status of longer text is kSyntax.
inline constexpr std::size_t kMaxDecimalBytes = 256;

/// Outcome of reading a piece of text.
enum class [[nodiscard]] DecimalStatus : std::uint8_t{
    kOk = 0,
    kSyntax,     ///< not a number of the grammar below
    kNotFinite,  ///< a spelling of NaN or infinity, or a number that rounds to an infinite float
    kRange,      ///< an integer that does not fit 64 bits (parse_integer only)
};

/// Reads [+-] digits [. digits] [e [+-] digits]; digits may be missing on one side of the point. No blanks around it.
///
/// @param text        text_bytes characters, need not end with NUL.
/// @param float_bits  IEEE 754 single nearest to the exact decimal value, ties to even, denormals included.
/// Errors: kSyntax, kNotFinite; float_bits is then unchanged.
/// Cost: linear in text_bytes; one or two double operations, or at most 27 steps of division of 1,280-bit integers if
/// the double lies too near the middle of two floats, the result is denormal, or the exponent is beyond 44.
DecimalStatus parse_float(const char* text, std::size_t text_bytes, std::uint32_t& float_bits);

/// Reads [+-] digits. Errors: kSyntax, kRange (value outside int64); value is then unchanged.
DecimalStatus parse_integer(const char* text, std::size_t text_bytes, std::int64_t& value);

/// @returns true for what parse_float accepts, of any magnitude, and for nan, nan(...), inf, infinity in any case.
[[nodiscard]] bool is_number(const char* text, std::size_t text_bytes);

/// Rounds an IEEE 754 double to the nearest single, ties to even, by integers. Too large becomes infinity, NaN stays
/// NaN.
[[nodiscard]] std::uint32_t float_bits_from_double_bits(std::uint64_t double_bits);

}  // namespace gridiron
