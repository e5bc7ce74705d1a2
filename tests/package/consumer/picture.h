// What the examples do with a finished plane: a hash to compare it by, a PPM file to look at it.
// Memory: std::string of the file. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/frame/frame_setup.h>

#include <cinttypes>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <span>
#include <string>

/// @returns the word of pixel (x, y), y = 0 on top, of a plane as cores leave it: whole tiles, one after the other.
inline std::uint32_t pixel_at(const gridiron::FrameSettings& settings, std::span<const std::byte> plane,
                              std::uint32_t x, std::uint32_t y) {
  std::uint32_t word = 0;
  const std::uint64_t index = gridiron::output_plane_index(settings.width, settings.tile_width, x, y);
  std::memcpy(&word, plane.data() + index * sizeof word, sizeof word);
  return word;
}

/// @returns FNV-1a, 64 bits, of the pixels' bytes in rows; for the plane of colours what `gridiron render` prints.
inline std::uint64_t plane_hash(const gridiron::FrameSettings& settings, std::span<const std::byte> plane) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (std::uint32_t y = 0; y < settings.height; ++y) {
    for (std::uint32_t x = 0; x < settings.width; ++x) {
      const std::uint32_t word = pixel_at(settings, plane, x, y);
      for (std::uint32_t shift = 0; shift < 32; shift += 8) hash = (hash ^ (word >> shift & 0xFFu)) * 0x100000001b3u;
    }
  }
  return hash;
}

/// Prints `hash color` and, of a frame with a plane of distances, its hash too.
inline void print_hashes(const gridiron::FrameSettings& settings, std::span<const std::byte> color,
                         std::span<const std::byte> depth = {}) {
  std::printf("hash %016" PRIx64, plane_hash(settings, color));
  if (!depth.empty()) std::printf(" depth %016" PRIx64, plane_hash(settings, depth));
  std::printf("\n");
}

/// Writes the colours as a PPM file. @returns whether that worked.
inline bool write_ppm(const char* path, const gridiron::FrameSettings& settings, std::span<const std::byte> color) {
  std::string text = "P6\n" + std::to_string(settings.width) + " " + std::to_string(settings.height) + "\n255\n";
  for (std::uint32_t y = 0; y < settings.height; ++y) {
    for (std::uint32_t x = 0; x < settings.width; ++x) {
      const std::uint32_t rgba = pixel_at(settings, color, x, y);
      for (std::uint32_t shift = 0; shift < 24; shift += 8) text += static_cast<char>(rgba >> shift & 0xFFu);
    }
  }
  std::FILE* file = std::fopen(path, "wb");
  if (file == nullptr) return false;
  const bool is_written = std::fwrite(text.data(), 1, text.size(), file) == text.size();
  return std::fclose(file) == 0 && is_written;
}
