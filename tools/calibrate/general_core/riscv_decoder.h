// Instructions of riscv64 as the general core's: RV64GC without atomics' order, as a compiler makes them, and vectors
// of 128 bits. Memory: none. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "core_model.h"

namespace gridiron::general_core {

inline constexpr std::uint8_t kFloatRegister = 32;   ///< float register 0 is this number
inline constexpr std::uint8_t kVectorRegister = 64;  ///< the same of vector registers

/// slti zero, zero, n. @returns n of a mark.
[[nodiscard]] constexpr std::optional<std::uint32_t> mark_of(std::uint32_t code) {
  if ((code & 0xFFFFF) != 0x02013) return std::nullopt;
  return code >> 20;
}

namespace detail {

constexpr std::uint8_t field(std::uint32_t code, int shift, std::uint32_t mask = 31) {
  return static_cast<std::uint8_t>(code >> shift & mask);
}
constexpr std::uint8_t float_field(std::uint32_t code, int shift) {
  return static_cast<std::uint8_t>(kFloatRegister + field(code, shift));
}

constexpr Instruction decode_float(std::uint32_t code) {
  const std::uint8_t rd = field(code, 7), rs1 = field(code, 15);
  const std::uint8_t fd = float_field(code, 7), f1 = float_field(code, 15), f2 = float_field(code, 20);
  switch (code >> 27) {
    case 0x03:
      return {Kind::kDivide, fd, {f1, f2, 0}};
    case 0x0B:
      return {Kind::kRoot, fd, {f1, 0, 0}};
    case 0x08:  // between float and double
      return {(code >> 25 & 3) == 1 ? Kind::kWiden : Kind::kFloat, fd, {f1, 0, 0}};
    case 0x14:
      return {Kind::kFloat, rd, {f1, f2, 0}};  // compare
    case 0x18:
      return {Kind::kConvert, rd, {f1, 0, 0}};
    case 0x1A:
      return {Kind::kConvert, fd, {rs1, 0, 0}};
    case 0x1C:  // move to a fixed register, or class
      return {Kind::kThroughMemory, rd, {f1, 0, 0}};
    case 0x1E:
      return {Kind::kThroughMemory, fd, {rs1, 0, 0}};
    default:
      return {Kind::kFloat, fd, {f1, f2, 0}};
  }
}

constexpr std::uint8_t vector_field(std::uint32_t code, int shift) {
  return static_cast<std::uint8_t>(kVectorRegister + field(code, shift));
}
// Whether loads and stores of float registers are of vectors.
constexpr bool is_of_vector(std::uint32_t code) {
  const std::uint8_t width = field(code, 12, 7);
  return width == 0 || width > 4;
}

// The vector registers have no way to the others but through memory. A number beside a vector is one that was brought
// there before a loop.
constexpr Instruction decode_vector(std::uint32_t code) {
  enum : std::uint8_t { kFloats = 1, kToScalar = 2, kNumber = 4, kFloat = 5, kToVector = 6, kLength = 7 };
  const std::uint8_t form = field(code, 12, 7), vd = vector_field(code, 7), vs1 = vector_field(code, 15),
                     vs2 = vector_field(code, 20);
  const std::uint32_t function = code >> 26;
  const bool is_float = form == kFloats || form == kFloat;
  const bool is_scalar_move = function == 0x10;
  if (form == kLength) return {Kind::kWiden, 0, {}};  // lanes are what they are
  if (is_scalar_move && form == kFloats) return {Kind::kThroughMemory, float_field(code, 7), {vs2, 0, 0}};
  if (is_scalar_move && form == kToScalar) return {Kind::kThroughMemory, field(code, 7), {vs2, 0, 0}};
  if (is_scalar_move && form == kFloat) return {Kind::kThroughMemory, vd, {float_field(code, 15), 0, 0}};
  if (is_scalar_move && form == kToVector) return {Kind::kThroughMemory, vd, {field(code, 15), 0, 0}};
  if (function == 0x17 && (code >> 25 & 1) != 0 && form == kNumber) {
    return {Kind::kThroughMemory, vd, {field(code, 15), 0, 0}};  // a number in all lanes
  }
  if (is_float && function == 0x20) return {Kind::kDivide, vd, {vs1, vs2, 0}};
  return {is_float ? Kind::kFloat : Kind::kVector, vd, {form <= kToScalar ? vs1 : std::uint8_t{0}, vs2, 0}};
}

constexpr Instruction decode_long(std::uint32_t code) {
  const std::uint8_t rd = field(code, 7), rs1 = field(code, 15), rs2 = field(code, 20);
  const bool is_word = (code & 8) != 0;
  switch (code >> 2 & 31) {
    case 0x00:
      return {Kind::kLoad, rd, {rs1, 0, 0}};
    case 0x01:
      return {Kind::kLoad, is_of_vector(code) ? vector_field(code, 7) : float_field(code, 7), {rs1, 0, 0}};
    case 0x08:
      return {Kind::kStore, 0, {rs1, rs2, 0}};
    case 0x09:
      return {Kind::kStore, 0, {rs1, is_of_vector(code) ? vector_field(code, 7) : float_field(code, 20), 0}};
    case 0x0B:
      return {Kind::kLoad, rd, {rs1, rs2, 0}};  // atomic
    case 0x04:
    case 0x06:
      return {Kind::kFixed, rd, {rs1, 0, 0}};
    case 0x05:
    case 0x0D:
      return {Kind::kFixed, rd, {}};
    case 0x0C:
    case 0x0E:
      if (code >> 25 == 1) {
        if (field(code, 12, 7) >= 4) return {Kind::kFixedDivide, rd, {rs1, rs2, 0}};
        return {is_word ? Kind::kMultiply : Kind::kWideMultiply, rd, {rs1, rs2, 0}};
      }
      return {Kind::kFixed, rd, {rs1, rs2, 0}};
    case 0x10:
    case 0x11:
    case 0x12:
    case 0x13:  // a b + c
      return {
          Kind::kFloat, float_field(code, 7), {float_field(code, 15), float_field(code, 20), float_field(code, 27)}};
    case 0x14:
      return decode_float(code);
    case 0x15:
      return decode_vector(code);
    case 0x18:
      return {Kind::kBranch, 0, {rs1, rs2, 0}};
    case 0x19:
      return {rs1 == 1 || rs1 == 5 ? Kind::kJump : Kind::kFarJump, rd, {rs1, 0, 0}};
    case 0x1B:
      return {Kind::kJump, rd, {}};
    default:
      return {};  // fences, system calls
  }
}

// Of 16 bits.
constexpr Instruction decode_short(std::uint32_t code) {
  const std::uint8_t rd = field(code, 7), rs2 = field(code, 2);
  const auto small1 = static_cast<std::uint8_t>(8 + field(code, 7, 7)),
             small2 = static_cast<std::uint8_t>(8 + field(code, 2, 7));
  const auto float2 = static_cast<std::uint8_t>(kFloatRegister + small2);
  constexpr std::uint8_t kStack = 2;
  switch ((code & 3) << 3 | code >> 13) {
    case 0x00:
      return {Kind::kFixed, small2, {kStack, 0, 0}};
    case 0x01:
      return {Kind::kLoad, float2, {small1, 0, 0}};
    case 0x02:
    case 0x03:
      return {Kind::kLoad, small2, {small1, 0, 0}};
    case 0x05:
      return {Kind::kStore, 0, {small1, float2, 0}};
    case 0x06:
    case 0x07:
      return {Kind::kStore, 0, {small1, small2, 0}};
    case 0x08:
    case 0x09:
      return {Kind::kFixed, rd, {rd, 0, 0}};
    case 0x0A:
      return {Kind::kFixed, rd, {}};
    case 0x0B:
      return {Kind::kFixed, rd, {rd == kStack ? kStack : std::uint8_t{0}, 0, 0}};
    case 0x0C:
      return {Kind::kFixed, small1, {small1, field(code, 10, 3) == 3 ? small2 : std::uint8_t{0}, 0}};
    case 0x0D:
      return {Kind::kJump, 0, {}};
    case 0x0E:
    case 0x0F:
      return {Kind::kBranch, 0, {small1, 0, 0}};
    case 0x10:
      return {Kind::kFixed, rd, {rd, 0, 0}};
    case 0x11:
      return {Kind::kLoad, static_cast<std::uint8_t>(kFloatRegister + rd), {kStack, 0, 0}};
    case 0x12:
    case 0x13:
      return {Kind::kLoad, rd, {kStack, 0, 0}};
    case 0x14:
      if (rs2 != 0) return {Kind::kFixed, rd, {(code >> 12 & 1) != 0 ? rd : std::uint8_t{0}, rs2, 0}};
      return {rd == 1 || rd == 5 ? Kind::kJump : Kind::kFarJump,
              (code >> 12 & 1) != 0 ? std::uint8_t{1} : std::uint8_t{0},
              {rd, 0, 0}};
    case 0x15:
      return {Kind::kStore, 0, {kStack, static_cast<std::uint8_t>(kFloatRegister + rs2), 0}};
    case 0x16:
    case 0x17:
      return {Kind::kStore, 0, {kStack, rs2, 0}};
    default:
      return {};
  }
}

}  // namespace detail

/// @param code  the instruction's bytes, little-endian; of 16 bits where the lowest two are not both set.
[[nodiscard]] constexpr Instruction decode(std::uint32_t code, std::uint64_t address) {
  Instruction instruction = (code & 3) == 3 ? detail::decode_long(code) : detail::decode_short(code & 0xFFFF);
  instruction.address = address;
  return instruction;
}

}  // namespace gridiron::general_core
