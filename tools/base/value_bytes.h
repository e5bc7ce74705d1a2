// Values as bytes, for messages between processes of one program: no versions, no byte order.
// Memory: std::vector; a reader borrows its bytes. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "failure.h"

namespace gridiron::tool {

using Bytes = std::vector<std::byte>;

template <class Value>
inline constexpr bool kIsSpan = false;
template <class Value>
inline constexpr bool kIsSpan<std::span<Value>> = true;

/// What another process can use.
template <class Value>
concept PlainValue = std::is_trivially_copyable_v<Value> && !std::is_pointer_v<Value> && !kIsSpan<Value>;

class ByteWriter {
 public:
  template <PlainValue Value>
  void add(const Value& value) {
    const auto bytes = std::as_bytes(std::span(&value, 1));
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  }

  /// Adds values and their number.
  template <PlainValue Value>
  void add_all(std::span<const Value> values) {
    add(std::uint64_t{values.size()});
    const auto bytes = std::as_bytes(values);
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
  }
  template <PlainValue Value>
  void add(const std::vector<Value>& values) {
    add_all(std::span<const Value>(values));
  }
  void add(const std::string& text) { add_all(std::span<const char>(text)); }

  [[nodiscard]] std::size_t size() const { return bytes_.size(); }
  [[nodiscard]] Bytes take() { return std::exchange(bytes_, {}); }

 private:
  Bytes bytes_;
};

/// Takes values in the order in which they were added. Errors: Failure (kCheckFailed) if there are too few bytes.
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

  template <PlainValue Value>
  void take(Value& value) {
    const std::span<const std::byte> bytes = take_bytes(1, sizeof(Value));
    std::memcpy(static_cast<void*>(&value), bytes.data(), sizeof(Value));
  }
  template <PlainValue Value>
  [[nodiscard]] Value take() {
    Value value{};
    take(value);
    return value;
  }

  template <PlainValue Value>
  void take(std::vector<Value>& values) {
    const auto count = take<std::uint64_t>();
    const std::span<const std::byte> bytes = take_bytes(count, sizeof(Value));
    values.resize(static_cast<std::size_t>(count));
    if (count != 0) std::memcpy(static_cast<void*>(values.data()), bytes.data(), bytes.size());
  }
  void take(std::string& text) {
    const std::span<const std::byte> bytes = take_bytes(take<std::uint64_t>(), 1);
    text.assign(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  }

  /// @returns the next values' bytes in place.
  [[nodiscard]] std::span<const std::byte> take_bytes(std::uint64_t count, std::size_t value_bytes = 1) {
    if (count > bytes_.size() / value_bytes) {
      throw Failure(ExitCode::kCheckFailed, "a message between processes of this command is too short");
    }
    const std::span<const std::byte> taken = bytes_.first(static_cast<std::size_t>(count) * value_bytes);
    bytes_ = bytes_.subspan(taken.size());
    return taken;
  }

  [[nodiscard]] bool is_empty() const { return bytes_.empty(); }

 private:
  std::span<const std::byte> bytes_;
};

}  // namespace gridiron::tool
