// Words. SPDX-License-Identifier: Apache-2.0
#include "words.h"

#include <cstdio>
#include <iterator>

namespace gridiron::tool {

// Without a default the compiler names a missing value.
const char* words_of(Status status) {
  switch (status) {
    case Status::kOk:
      return "no error";
    case Status::kTransferSize:
      return "transfer of a forbidden size (0, too large, or not a multiple of 16 bytes)";
    case Status::kTransferAlignment:
      return "transfer between misaligned or incongruent addresses";
    case Status::kTransferBoundary:
      return "transfer across a boundary of main memory that the machine forbids";
    case Status::kTransferTag:
      return "transfer with a tag that the machine does not have";
    case Status::kTransferQueueFull:
      return "more transfers pending than the machine's queue holds";
    case Status::kTransferLocalRange:
      return "transfer outside the core's local store";
    case Status::kTransferMainRange:
      return "transfer outside the main memory that may be read or written";
    case Status::kTransferOverlap:
      return "transfer that overlaps a pending one, or a source changed before its wait";
    case Status::kTransferFailed:
      return "transfer that failed";
    case Status::kTransferTimedOut:
      return "transfer that did not end in time";
    case Status::kTransferPending:
      return "transfer that was never waited for";
    case Status::kBadAccess:
      return "load or store of bytes that must not be touched";
    case Status::kBadFrame:
      return "frame record with a wrong magic, version, size or range";
    case Status::kBadImage:
      return "damaged scene image";
    case Status::kUnsupportedImage:
      return "scene image that this local store or accuracy cannot use";
    case Status::kUnsupportedFrame:
      return "frame that this build or this host cannot render (lanes, packet width, buffers, mode; with "
             "effects out of 64 KB also distances)";
    case Status::kAborted:
      return "stopped before the end";
    case Status::kDeadline:
      return "deadline passed between two tiles";
    case Status::kIncompleteFrame:
      return "picture with a part that no core wrote";
    case Status::kMissingEffect:
      return "the scene calls for an effect that this renderer was built without";
    case Status::kSpillTooSmall:
      return "less main memory for rays that wait than the scene's depth of recursion requires";
    case Status::kMemoryTooSmall:
      return "memory smaller than the counted need";
    case Status::kTooManyTriangles:
      return "more triangles or references than 32-bit counts can address";
    case Status::kNoTriangles:
      return "no triangle of non-zero area";
    case Status::kBadVertex:
      return "vertex coordinate that is no number between -2^120 and 2^120";
    case Status::kBadIndex:
      return "triangle that names a vertex, material or normal that does not exist";
    case Status::kBadParameter:
      return "parameter outside its range";
    case Status::kBadEffects:
      return "light, material, normal, texel or count of a scene outside its range";
  }
  return "unknown status";
}

// The reader's own table is the only one of these words.
const char* words_of(PlyError error) {
  return ply_error_reason(error);
}

std::string word_of(TriangleFormat format) {
  switch (format) {
    case TriangleFormat::kVertices:
      return "vertices";
    case TriangleFormat::kProjection:
      return "projection";
    case TriangleFormat::kLattice:
      return "lattice";
  }
  return "unknown";
}

std::string words_of_bytes(std::uint64_t bytes) {
  constexpr const char* kUnits[] = {"bytes", "KB", "MB", "GB", "TB"};
  if (bytes < 1024) return std::to_string(bytes) + " bytes";
  double amount = static_cast<double>(bytes);
  std::size_t unit = 0;
  while (amount >= 1024.0 && unit + 1 < std::size(kUnits)) {
    amount /= 1024.0;
    ++unit;
  }
  char text[32];
  std::snprintf(text, sizeof text, "%.1f %s", amount, kUnits[unit]);
  return text;
}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t kMostBytes = 64;
  constexpr char kDigits[] = "0123456789abcdef";
  std::string quoted(1, '\'');
  for (const char letter : text.substr(0, kMostBytes)) {
    const auto byte = static_cast<unsigned char>(letter);
    if (byte >= ' ' && byte < 0x7F) {
      quoted.push_back(letter);
    } else {
      quoted.append("\\x").append(1, kDigits[byte >> 4]).append(1, kDigits[byte & 15]);
    }
  }
  if (text.size() > kMostBytes) quoted.append("...");
  quoted.push_back('\'');
  return quoted;
}

std::string in_csv(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
  std::string quoted = "\"";
  for (const char letter : text) quoted.append(letter == '"' ? 2 : 1, letter);
  return quoted + "\"";
}

std::string words_of_count(std::uint64_t count) {
  const std::string digits = std::to_string(count);
  std::string words;
  for (std::size_t place = 0; place < digits.size(); ++place) {
    if (place != 0 && (digits.size() - place) % 3 == 0) words.push_back(',');
    words.push_back(digits[place]);
  }
  return words;
}

std::string words_of_count(std::uint64_t count, const char* noun) {
  return words_of_count(count).append(" ").append(noun).append(count == 1 ? "" : "s");
}

}  // namespace gridiron::tool
