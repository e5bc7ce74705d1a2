// Model stream: what the child of an import sends through its pipe, written and checked. Counts come first, then the
// arrays; the reader takes memory for what has arrived, never for what is announced.
// Memory: owns what it returns. Threads: one. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <stdexcept>
#include <string>

#include "import/model_import.h"

namespace gridiron::tool {

/// Thrown by the reader, and by the child for what it cannot read: a reason in words.
class ImportError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Takes bytes, all of them. @returns false if they cannot be taken.
using ByteSink = std::function<bool(std::span<const std::byte>)>;
/// Fills the span. @returns false at the end of the bytes.
using ByteSource = std::function<bool(std::span<std::byte>)>;

/// Writes a model. @returns false if the sink refused bytes.
[[nodiscard]] bool write_model(const ImportedModel& model, const ByteSink& sink);

/// Writes why there is no model. @returns false if the sink refused bytes.
[[nodiscard]] bool write_reason(const std::string& reason, const ByteSink& sink);

/// Reads a model and checks every count, index and number.
///
/// @param most_bytes  of all arrays. Errors: ImportError, with the reason that was sent, or "its answer is damaged:
/// ..."
[[nodiscard]] ImportedModel read_model(const ByteSource& source, std::uint64_t most_bytes);

}  // namespace gridiron::tool
