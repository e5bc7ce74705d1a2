// PNG files: bands of rows, compressed by zlib if the build has it, else with the format's stored blocks.
// Source: PNG specification, third edition; RFC 1950 and RFC 1951. SPDX-License-Identifier: Apache-2.0
#include "png_file.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <iterator>
#include <limits>
#include <new>
#include <string>
#include <string_view>

#ifdef GRIDIRON_HAS_PNG
#define ZLIB_CONST  // the input of a stream
#include <zlib.h>
#endif

#include "base/failure.h"
#include "base/share_work.h"

namespace gridiron::tool {
namespace {

static_assert(std::endian::native == std::endian::little, "the bytes of a pixel are R, G, B, A");

constexpr std::size_t kPixelBytes = sizeof(std::uint32_t);
// The bytes of a file depend on it, so it is the same for every host and number of threads.
constexpr std::size_t kBandBytes = std::size_t{1} << 20;

constexpr std::array<std::uint32_t, 256> kCrcTable = [] {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t i = 0; i < table.size(); ++i) {
    std::uint32_t value = i;
    for (int bit = 0; bit < 8; ++bit) value = (value & 1u) != 0 ? 0xEDB88320u ^ (value >> 1) : value >> 1;
    table[i] = value;
  }
  return table;
}();

std::uint32_t crc_of(std::span<const std::byte> bytes) {
  std::uint32_t crc = 0xFFFFFFFFu;
  for (const std::byte byte : bytes) crc = kCrcTable[(crc ^ static_cast<std::uint32_t>(byte)) & 0xFFu] ^ (crc >> 8);
  return ~crc;
}

constexpr std::uint32_t kAdlerPrime = 65521;

// Adler-32 of zlib streams, over several calls.
class Adler {
 public:
  void add(std::span<const std::byte> bytes) {
    for (const std::byte byte : bytes) {
      low_ = (low_ + static_cast<std::uint32_t>(byte)) % kAdlerPrime;
      high_ = (high_ + low_) % kAdlerPrime;
    }
  }
  [[nodiscard]] std::uint32_t value() const { return high_ << 16 | low_; }

 private:
  std::uint32_t low_ = 1, high_ = 0;
};

// The Adler-32 of bytes and those that follow them. Each sum of the second begins with the sums of the first, not with
// 1 and 0: its low sum is larger by first_low - 1, and so are all the low sums that make its high one.
std::uint32_t join_adlers(std::uint32_t first, std::uint32_t second, std::uint64_t second_bytes) {
  const std::uint64_t more = (first & 0xFFFFu) + kAdlerPrime - 1;
  const std::uint64_t low = (more + (second & 0xFFFFu)) % kAdlerPrime;
  const std::uint64_t high =
      ((first >> 16) + (second >> 16) + second_bytes % kAdlerPrime * (more % kAdlerPrime)) % kAdlerPrime;
  return static_cast<std::uint32_t>(high << 16 | low);
}

void append_big_endian(std::vector<std::byte>& file, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) file.push_back(static_cast<std::byte>(value >> shift & 0xFFu));
}

void append_type(std::vector<std::byte>& file, std::string_view type) {
  for (const char letter : type) file.push_back(static_cast<std::byte>(letter));
}

void append_chunk(std::vector<std::byte>& file, std::string_view type, std::span<const std::byte> data) {
  append_big_endian(file, static_cast<std::uint32_t>(data.size()));
  const std::size_t begin = file.size();
  append_type(file, type);
  file.insert(file.end(), data.begin(), data.end());
  append_big_endian(file, crc_of(std::span(file).subspan(begin)));
}

std::size_t row_bytes_of(std::uint32_t width) {
  return 1 + width * kPixelBytes;  // the number of its filter, and its pixels
}

// An IDAT chunk without its length and data. A picture's first chunk begins the zlib stream.
std::vector<std::byte> begin_band(const PngRows& rows, std::byte stream_flags) {
  std::vector<std::byte> bytes;
  append_big_endian(bytes, 0);
  append_type(bytes, "IDAT");
  if (rows.above.empty()) bytes.insert(bytes.end(), {std::byte{0x78}, stream_flags});
  return bytes;
}

// Fills in the length of a chunk that has its data, and appends the CRC of its type and data.
template <class Crc>
void end_band(std::vector<std::byte>& bytes, Crc crc) {
  constexpr std::size_t kLengthBytes = 4, kTypeBytes = 4;
  const std::size_t length = bytes.size() - kLengthBytes - kTypeBytes;
  for (std::size_t i = 0; i < kLengthBytes; ++i) bytes[i] = static_cast<std::byte>(length >> (24 - 8 * i) & 0xFFu);
  append_big_endian(bytes, crc(std::span<const std::byte>(bytes).subspan(kLengthBytes)));
}

#ifdef GRIDIRON_HAS_PNG

// Each function writes the rest of a row that its filter leaves: the bytes of the first pixel, which has none to its
// left, and then the others in a loop that compilers vectorise. `row`, `above` and `out` have the bytes of the pixels.
void filter_sub(const std::uint8_t* row, std::uint8_t* out, std::size_t count) {
  for (std::size_t i = 0; i < kPixelBytes; ++i) out[i] = row[i];
  for (std::size_t i = kPixelBytes; i < count; ++i) out[i] = static_cast<std::uint8_t>(row[i] - row[i - kPixelBytes]);
}

void filter_up(const std::uint8_t* row, const std::uint8_t* above, std::uint8_t* out, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) out[i] = static_cast<std::uint8_t>(row[i] - above[i]);
}

void filter_paeth(const std::uint8_t* row, const std::uint8_t* above, std::uint8_t* out, std::size_t count) {
  const auto absolute = [](std::int16_t value) { return static_cast<std::int16_t>(value < 0 ? -value : value); };
  for (std::size_t i = 0; i < kPixelBytes; ++i) out[i] = static_cast<std::uint8_t>(row[i] - above[i]);
  for (std::size_t i = kPixelBytes; i < count; ++i) {
    const std::uint8_t left = row[i - kPixelBytes], up = above[i], corner = above[i - kPixelBytes];
    // Distances of left + up - corner to each of the three. The nearest one predicts; left, then up if equal.
    const auto to_left = static_cast<std::int16_t>(up - corner);
    const auto to_up = static_cast<std::int16_t>(left - corner);
    const std::int16_t far_left = absolute(to_left), far_up = absolute(to_up),
                       far_corner = absolute(static_cast<std::int16_t>(to_left + to_up));
    std::uint8_t predicted = far_up <= far_corner ? up : corner;
    predicted = far_left <= std::min(far_up, far_corner) ? left : predicted;
    out[i] = static_cast<std::uint8_t>(row[i] - predicted);
  }
}

// The sum of the bytes' distances to 0 on their circle: the less, the better a filtered row usually compresses.
std::uint64_t sum_of_distances(const std::uint8_t* bytes, std::size_t count) {
  constexpr std::size_t kPiece = std::size_t{1} << 16;  // its sum has 32 bits
  std::uint64_t sum = 0;
  for (std::size_t begin = 0; begin < count; begin += kPiece) {
    const std::size_t end = std::min(begin + kPiece, count);
    std::uint32_t piece = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const int value = static_cast<std::int8_t>(bytes[i]);
      piece += static_cast<std::uint32_t>(value < 0 ? -value : value);
    }
    sum += piece;
  }
  return sum;
}

// Filters rows one by one, each by that of three filters whose sum is the least. Rows as they are hardly ever win, and
// averages (filter 3) make most rendered pictures larger, because rows that change their filter often repeat less.
class RowFilter {
 public:
  explicit RowFilter(std::uint32_t width) : count_(width * kPixelBytes) {
    for (Candidate& candidate : candidates_) candidate.bytes.resize(1 + count_);
    candidates_[0].bytes[0] = 2;  // Up comes first: what it leaves of a row that repeats is 0, which ends the search
    candidates_[1].bytes[0] = 1;  // Sub
    candidates_[2].bytes[0] = 4;  // Paeth
  }

  // @returns the number of the filter and the filtered bytes, until the next call.
  std::span<const std::uint8_t> filter(const std::uint32_t* pixels, const std::uint32_t* pixels_above) {
    const auto* row = reinterpret_cast<const std::uint8_t*>(pixels);
    const auto* above = reinterpret_cast<const std::uint8_t*>(pixels_above);
    const Candidate* best = nullptr;
    for (Candidate& candidate : candidates_) {
      std::uint8_t* const out = candidate.bytes.data() + 1;
      switch (candidate.bytes[0]) {
        case 1:
          filter_sub(row, out, count_);
          break;
        case 2:
          filter_up(row, above, out, count_);
          break;
        default:
          filter_paeth(row, above, out, count_);
          break;
      }
      candidate.sum = sum_of_distances(out, count_);
      if (best == nullptr || candidate.sum < best->sum) best = &candidate;
      if (best->sum == 0) break;
    }
    return best->bytes;
  }

 private:
  struct Candidate {
    std::vector<std::uint8_t> bytes;
    std::uint64_t sum = 0;
  };
  std::size_t count_;
  std::array<Candidate, 3> candidates_;
};

// A deflate stream without zlib's head and end, whose output is appended to `out`.
class Deflater {
 public:
  explicit Deflater(std::vector<std::byte>& out) : out_(out), buffer_(std::size_t{1} << 16) {
    // On rendered pictures the default strategy makes smaller files than Z_FILTERED, in the same time. Level 5 and
    // below make files larger than libpng's.
    constexpr int kLevel = 6, kRawWindowBits = -15, kMemoryLevel = 8;
    require(deflateInit2(&stream_, kLevel, Z_DEFLATED, kRawWindowBits, kMemoryLevel, Z_DEFAULT_STRATEGY));
  }
  Deflater(const Deflater&) = delete;
  Deflater& operator=(const Deflater&) = delete;
  ~Deflater() { deflateEnd(&stream_); }

  void add(std::span<const std::uint8_t> bytes, int flush) {
    stream_.next_in = bytes.data();
    stream_.avail_in = static_cast<uInt>(bytes.size());
    do {
      stream_.next_out = buffer_.data();
      stream_.avail_out = static_cast<uInt>(buffer_.size());
      const int code = deflate(&stream_, flush);
      if (code != Z_BUF_ERROR && code != Z_STREAM_END) require(code);  // Z_BUF_ERROR: there was nothing left to do
      const std::span made = std::as_bytes(std::span(buffer_)).first(buffer_.size() - stream_.avail_out);
      out_.insert(out_.end(), made.begin(), made.end());
    } while (stream_.avail_out == 0);
  }

 private:
  void require(int code) {
    if (code == Z_OK) return;
    if (code == Z_MEM_ERROR) throw std::bad_alloc();
    throw Failure(ExitCode::kBadInput, std::string("cannot encode the picture: zlib: ") +
                                           (stream_.msg != nullptr ? stream_.msg : zError(code)));
  }

  std::vector<std::byte>& out_;
  std::vector<Bytef> buffer_;
  z_stream stream_{};
};

#endif

template <class EncodeBand>
std::vector<PngBand> encode_bands(std::size_t count, std::uint32_t threads,
                                  const std::function<PngRows(std::size_t band)>& rows_of, EncodeBand encode_band) {
  std::vector<PngBand> bands(count);
  share_work(threads, count, [&](std::size_t band) { bands[band] = encode_band(rows_of(band)); });
  return bands;
}

template <class EncodeBand>
std::vector<std::byte> encode_whole(const Picture<std::uint32_t>& picture, std::uint32_t threads,
                                    EncodeBand encode_band) {
  const auto rows_of = [&picture](std::size_t band) {
    return png_rows_of_band(picture, static_cast<std::uint32_t>(band));
  };
  const std::uint32_t count = png_band_count(picture.width, picture.height);
  return join_png_bands(picture.width, picture.height, encode_bands(count, threads, rows_of, encode_band));
}

}  // namespace

std::uint32_t png_band_rows(std::uint32_t width) {
  return static_cast<std::uint32_t>(std::max(kBandBytes / row_bytes_of(width), std::size_t{1}));
}

std::uint32_t png_band_count(std::uint32_t width, std::uint32_t height) {
  return (height - 1) / png_band_rows(width) + 1;
}

PngRows png_rows_of_band(const Picture<std::uint32_t>& picture, std::uint32_t band) {
  const std::size_t width = picture.width;
  const std::uint32_t band_rows = png_band_rows(picture.width);
  const std::uint32_t first = band * band_rows, left = picture.height - first;
  const std::uint32_t count = std::min(band_rows, left);
  const std::span pixels(picture.pixels);
  PngRows rows{.width = picture.width, .rows = pixels.subspan(first * width, count * width)};
  if (first != 0) rows.above = pixels.subspan((first - 1) * width, width);
  rows.is_last = count == left;
  return rows;
}

PngBand encode_stored_png_band(const PngRows& rows) {
  constexpr std::size_t kMostBlockBytes = 65535;
  const std::size_t row_bytes = row_bytes_of(rows.width);
  const std::size_t row_count = rows.rows.size() / rows.width;

  // Each row is a filter byte, 0, and its pixels.
  std::vector<std::byte> raw(row_bytes * row_count);
  for (std::size_t row = 0; row < row_count; ++row) {
    std::memcpy(raw.data() + row * row_bytes + 1, rows.rows.data() + row * rows.width, row_bytes - 1);
  }
  Adler adler;
  adler.add(raw);

  PngBand band{.bytes = begin_band(rows, std::byte{0x01}), .adler = adler.value(), .raw_bytes = raw.size()};
  band.bytes.reserve(raw.size() + raw.size() / 4096 + 64);
  for (std::span<const std::byte> left = raw; !left.empty();) {
    const std::size_t block_bytes = std::min(left.size(), kMostBlockBytes);
    const auto length = static_cast<std::uint32_t>(block_bytes);
    band.bytes.push_back(std::byte{rows.is_last && block_bytes == left.size()});
    for (const std::uint32_t half : {length, ~length}) {
      band.bytes.push_back(static_cast<std::byte>(half & 0xFFu));
      band.bytes.push_back(static_cast<std::byte>(half >> 8 & 0xFFu));
    }
    band.bytes.insert(band.bytes.end(), left.begin(), left.begin() + static_cast<std::ptrdiff_t>(block_bytes));
    left = left.subspan(block_bytes);
  }
  end_band(band.bytes, crc_of);
  return band;
}

#ifdef GRIDIRON_HAS_PNG
PngBand encode_png_band(const PngRows& rows) {
  const std::size_t width = rows.width, row_count = rows.rows.size() / width;
  const std::vector<std::uint32_t> no_row(rows.above.empty() ? width : 0);
  const std::uint32_t* above = rows.above.empty() ? no_row.data() : rows.above.data();

  PngBand band{.bytes = begin_band(rows, std::byte{0x9C}), .raw_bytes = row_bytes_of(rows.width) * row_count};
  RowFilter filter(rows.width);
  Deflater deflater(band.bytes);
  for (std::size_t row = 0; row < row_count; ++row) {
    const std::uint32_t* const pixels = rows.rows.data() + row * width;
    const std::span<const std::uint8_t> filtered = filter.filter(pixels, above);
    band.adler = static_cast<std::uint32_t>(adler32_z(band.adler, filtered.data(), filtered.size()));
    // A band ends at a whole byte, so that the next one can follow it.
    deflater.add(filtered, row + 1 < row_count ? Z_NO_FLUSH : rows.is_last ? Z_FINISH : Z_SYNC_FLUSH);
    above = pixels;
  }
  end_band(band.bytes, [](std::span<const std::byte> bytes) {
    const auto* data = reinterpret_cast<const Bytef*>(bytes.data());
    return static_cast<std::uint32_t>(crc32_z(0, data, bytes.size()));
  });
  band.bytes.shrink_to_fit();
  return band;
}
#else
PngBand encode_png_band(const PngRows& rows) {
  return encode_stored_png_band(rows);
}
#endif

std::vector<std::byte> join_png_bands(std::uint32_t width, std::uint32_t height, std::vector<PngBand> bands) {
  std::size_t band_bytes = 0;
  for (const PngBand& band : bands) band_bytes += band.bytes.size();
  std::vector<std::byte> file;
  file.reserve(band_bytes + 128);

  append_big_endian(file, 0x89504E47u);  // 0x89 PNG
  append_big_endian(file, 0x0D0A1A0Au);
  std::vector<std::byte> header;
  append_big_endian(header, width);
  append_big_endian(header, height);
  constexpr std::byte kRgba8[] = {std::byte{8}, std::byte{6}, std::byte{0}, std::byte{0}, std::byte{0}};
  header.insert(header.end(), std::begin(kRgba8), std::end(kRgba8));
  append_chunk(file, "IHDR", header);

  std::uint32_t adler = 1;
  for (PngBand& band : bands) {
    file.insert(file.end(), band.bytes.begin(), band.bytes.end());
    adler = join_adlers(adler, band.adler, band.raw_bytes);
    std::vector<std::byte>().swap(band.bytes);
  }
  std::vector<std::byte> stream_end;
  append_big_endian(stream_end, adler);
  append_chunk(file, "IDAT", stream_end);
  append_chunk(file, "IEND", {});
  return file;
}

std::vector<PngBand> encode_png_bands(std::size_t count, std::uint32_t threads,
                                      const std::function<PngRows(std::size_t band)>& rows_of) {
  return encode_bands(count, threads, rows_of, encode_png_band);
}

std::vector<std::byte> encode_png(const Picture<std::uint32_t>& picture, std::uint32_t threads) {
  return encode_whole(picture, threads, encode_png_band);
}

std::vector<std::byte> encode_stored_png(const Picture<std::uint32_t>& picture) {
  return encode_whole(picture, 1, encode_stored_png_band);
}

}  // namespace gridiron::tool
