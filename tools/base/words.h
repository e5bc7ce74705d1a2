// Words: Status, PlyError, numbers and file text as they appear in messages.
// Memory: static text. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/records.h>
#include <gridiron/io/ply_types.h>
#include <gridiron/platform/status.h>

#include <cstdint>
#include <string>
#include <string_view>

namespace gridiron::tool {

/// @returns a phrase without capital or full stop; never nullptr.
[[nodiscard]] const char* words_of(Status status);
[[nodiscard]] const char* words_of(PlyError error);

/// @returns the format's name in --format.
[[nodiscard]] std::string word_of(TriangleFormat format);

/// @returns "12.3 MB" and similar; 1 MB = 2^20 bytes.
[[nodiscard]] std::string words_of_bytes(std::uint64_t bytes);

/// @returns text of a file for a message: in single quotes, cut to 64 bytes, unprintable bytes as \xNN.
[[nodiscard]] std::string in_quotes(std::string_view text);

/// @returns text as a field of CSV (RFC 4180): quoted where it has a comma, a quote or a line break.
[[nodiscard]] std::string in_csv(std::string_view text);

/// @returns "1,234,567".
[[nodiscard]] std::string words_of_count(std::uint64_t count);

/// @returns "1 core", "2 cores".
[[nodiscard]] std::string words_of_count(std::uint64_t count, const char* noun);

}  // namespace gridiron::tool
