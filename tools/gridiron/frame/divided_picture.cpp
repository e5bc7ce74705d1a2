// Divided picture. SPDX-License-Identifier: Apache-2.0
#include "divided_picture.h"

#include <cstddef>
#include <utility>

#include "base/ranks.h"
#include "base/value_bytes.h"
#include "files/output_target.h"
#include "files/png_file.h"

namespace gridiron::tool {
namespace {

// A rank has so many bands at a time.
constexpr std::uint64_t kBandsAtOnce = 16;

// The bands that a rank encodes in a round of all ranks; none after its last.
std::vector<std::uint32_t> bands_of_round(std::uint64_t round, std::uint32_t rank, std::uint32_t band_count) {
  std::vector<std::uint32_t> bands;
  for (std::uint64_t k = round * kBandsAtOnce; k < (round + 1) * kBandsAtOnce; ++k) {
    const std::uint64_t band = piece_of_rank(k, rank, ranks().count());
    if (band < band_count) bands.push_back(static_cast<std::uint32_t>(band));
  }
  return bands;
}

void add_rows(ByteWriter& writer, const PngRows& rows) {
  writer.add(rows.width);
  writer.add(rows.is_last);
  writer.add_all(rows.rows);
  writer.add_all(rows.above);
}

// Rows that another process has sent.
struct SentRows {
  PngRows rows;
  std::vector<std::uint32_t> pixels, above;
};

SentRows take_rows(ByteReader& reader) {
  SentRows sent;
  reader.take(sent.rows.width);
  reader.take(sent.rows.is_last);
  reader.take(sent.pixels);
  reader.take(sent.above);
  sent.rows.rows = sent.pixels;
  sent.rows.above = sent.above;
  return sent;
}

void take_band(ByteReader& reader, PngBand& band) {
  reader.take(band.bytes);
  reader.take(band.adler);
  reader.take(band.raw_bytes);
}

}  // namespace

std::vector<std::byte> encode_divided(const Picture<std::uint32_t>& picture, const std::filesystem::path& path,
                                      std::uint32_t threads) {
  Ranks& all = ranks();
  if (all.count() == 1) return encode_picture(picture, path, threads);
  const std::uint32_t band_count = has_ending(path, ".pfm") ? 1 : png_band_count(picture.width, picture.height);
  ByteWriter head;
  head.add(band_count);
  Bytes bytes = head.take();
  all.broadcast(bytes);
  if (band_count == 1) return encode_picture(picture, path, threads);

  std::vector<PngBand> bands(band_count);
  for (std::uint64_t round = 0;; ++round) {
    std::uint32_t helpers = 0;
    for (std::uint32_t rank = 1; rank < all.count(); ++rank) {
      const std::vector<std::uint32_t> theirs = bands_of_round(round, rank, band_count);
      if (theirs.empty()) continue;
      ++helpers;
      ByteWriter writer;
      for (const std::uint32_t band : theirs) add_rows(writer, png_rows_of_band(picture, band));
      all.tell(rank, writer.take());
    }
    const std::vector<std::uint32_t> own = bands_of_round(round, 0, band_count);
    std::vector<PngBand> encoded =
        encode_png_bands(own.size(), threads, [&](std::size_t i) { return png_rows_of_band(picture, own[i]); });
    for (std::size_t i = 0; i < own.size(); ++i) bands[own[i]] = std::move(encoded[i]);
    if (own.empty() && helpers == 0) return join_png_bands(picture.width, picture.height, std::move(bands));
    for (; helpers > 0; --helpers) {
      const RankMessage message = all.wait_message();
      ByteReader reader(message.bytes);
      for (const std::uint32_t band : bands_of_round(round, message.rank, band_count)) take_band(reader, bands[band]);
    }
  }
}

void encode_for_first(std::uint32_t threads) {
  Ranks& all = ranks();
  Bytes head;
  all.broadcast(head);
  const auto band_count = ByteReader(head).take<std::uint32_t>();
  if (band_count == 1) return;
  for (std::uint64_t round = 0;; ++round) {
    std::vector<SentRows> sent(bands_of_round(round, all.rank(), band_count).size());
    if (sent.empty()) return;
    {
      const Bytes message = all.hear();
      ByteReader reader(message);
      for (SentRows& rows : sent) rows = take_rows(reader);
    }
    ByteWriter writer;
    for (const PngBand& band :
         encode_png_bands(sent.size(), threads, [&sent](std::size_t i) { return sent[i].rows; })) {
      writer.add(band.bytes);
      writer.add(band.adler);
      writer.add(band.raw_bytes);
    }
    all.tell_first(writer.take());
  }
}

}  // namespace gridiron::tool
