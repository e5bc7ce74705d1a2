// PLY reader, fed with bytes: ASCII and binary, polygons fanned, strips unrolled, all else skipped. See PlyReader.
// Source: G. Turk, "The PLY Polygon File Format", 1994. Memory: 8 KB by value; output in the caller's spans.
// Threads: one per reader. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/base/math.h>
#include <gridiron/io/ply_types.h>

#include <cstddef>
#include <cstdint>
#include <span>

namespace gridiron {

/// Why a call of feed() or finish() came back.
enum class PlyEvent : std::uint8_t {
  kNeedInput,  ///< every byte given was consumed: feed() more, or finish()
  kHeader,     ///< header() is valid; the place to give output memory
  kVertices,   ///< item_count vertices lie at the start of PlyOutput::vertices
  kTriangles,  ///< item_count triangles lie at the start of PlyOutput::triangles
  kEnd,        ///< all read, from finish() only
  kError,      ///< error() and position() are valid; nothing more is read
};

/// What one call of feed() or finish() did.
struct PlyStep {
  PlyEvent event = PlyEvent::kNeedInput;  ///< why it came back
  std::size_t consumed_bytes = 0;  ///< of the bytes given; the next call continues behind them
  std::uint64_t first_item = 0;    ///< index of the batch's first vertex or triangle in the input
  std::size_t item_count = 0;      ///< size of the batch
};

/// Where batches go. An empty span: these items are checked and counted, and not kept.
struct PlyOutput {
  std::span<Vec3> vertices;    ///< x y z as the input has them
  std::span<UVec3> triangles;  ///< indices of vertices

  /// Of the same vertices: empty, or as many places as `vertices`. Not written where the header declares none. A value
  /// that is not finite is 0; as everywhere, a number is checked whether it is kept or not.
  std::span<Vec3> normals{};  ///< nx ny nz as the input has them, of any length
  std::span<Vec3> colors{};   ///< red green blue, 0..1: bytes / 255, 16-bit values / 65535, others clamped
};

/// Reads one PLY input that arrives in pieces of any size.
///
///     PlyReader reader;
///     loop: step = reader.feed(rest of the piece), until kNeedInput; at the end of the input reader.finish(), until
///     kEnd.
///
/// A batch is reported when its span is full and at the end of an element, so that all events, errors and positions are
/// the same for every way of cutting the input. The next call overwrites the batch. Without output the reader is a
/// counting pass with the same checks: what counts without error reads without error. Indices are checked against the
/// header's vertex count, so that faces may come before vertices.
///
/// A polygon (v0 v1 v2 ...) becomes (v0 v1 v2) (v0 v2 v3) ...; a strip (v0 v1 v2 v3 ...) becomes (v0 v1 v2) (v2 v1 v3)
/// ..., every other triangle turned, with the same side in front; -1 starts a new strip. Polygons with fewer than three
/// corners become nothing. An ASCII body has its rows on lines of their own, or stands on one line as a whole.
/// In a binary file one line feed after the carriage return of end_header belongs to the header, unless the first line
/// ended with a carriage return alone.
///
/// A read error is the caller's: it stops feeding and does not call finish().
/// Cost: linear in the bytes; bounded work between events for bounded pieces.
class PlyReader {
 public:
  /// A reader of one input, before its first byte.
  explicit PlyReader(const PlyConfig& config = {});

  /// Sets where the next batches go, from the start of the spans. Allowed before the first feed() and after any event
  /// other than kNeedInput; batches must be empty, which they are then. The spans must stay valid.
  void set_output(const PlyOutput& output) { output_ = output; }

  /// Reads on. Call again with what was not consumed until the event is kNeedInput. After kError: kError again.
  [[nodiscard]] PlyStep feed(std::span<const std::byte> bytes);

  /// Tells the end of the input. Call until the event is kEnd or kError; consumed_bytes is 0.
  [[nodiscard]] PlyStep finish();

  /// Valid from kHeader on.
  [[nodiscard]] const PlyHeader& header() const { return header_; }
  /// What was read so far.
  [[nodiscard]] const PlyCounts& counts() const { return counts_; }
  /// Valid from kError on.
  [[nodiscard]] PlyError error() const { return error_; }
  /// Where the error is.
  [[nodiscard]] const PlyPosition& position() const { return position_; }

 private:
  enum class Stage : std::uint8_t { kMagic, kHeaderLine, kHeaderComment, kHeaderFeed, kBody, kTrailer, kDone, kFailed };
  enum class Type : std::uint8_t { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat32, kFloat64, kNone };
  enum class Role : std::uint8_t { kSkip, kX, kY, kZ, kFaceIndices, kStripIndices };
  enum class Kind : std::uint8_t { kOther, kVertex, kFace, kStrip };

  static constexpr std::uint8_t kAttributes = 6, kNoAttribute = 6;  // nx ny nz red green blue

  struct Text {
    std::uint16_t begin = 0;  // in names_
    std::uint16_t bytes = 0;
  };
  struct Property {
    Text name;
    Type count_type = Type::kNone;  // kNone: a scalar
    Type type = Type::kNone;
    Role role = Role::kSkip;
    std::uint8_t attribute = kNoAttribute;  // of a vertex, skipped unless there is a place for it: 0..5
  };
  struct Element {
    std::uint64_t row_count = 0;
    std::uint64_t byte_offset = 0;  // of its header line
    std::uint32_t line = 0;  // saturates
    Text name;
    std::uint16_t first_property = 0;
    std::uint16_t property_count = 0;
    Kind kind = Kind::kOther;
  };
  struct Word {
    std::uint64_t byte_offset = 0;
    std::uint16_t begin = 0;  // in text_
    std::uint16_t bytes = 0;
  };
  // Byte layout of a row, as far as the header fixes it. For the quick loops over whole rows.
  struct RowLayout {
    std::uint32_t stride_bytes = 0;  // vertices and skipped rows: the row; faces: the row of a triangle; 0: not fixed
    std::uint32_t offset_bytes[3] = {};  // vertices: x y z; faces: [0] the list's count
    Type types[3] = {};
    bool all_float = false;
    std::uint32_t attribute_offset_bytes[kAttributes] = {};
    Type attribute_types[kAttributes] = {};
  };
  static constexpr std::size_t kWordCapacity = 5;  // property list <count> <type> <name>

  static std::uint32_t type_bytes(Type type);
  static bool is_floating(Type type) { return type == Type::kFloat32 || type == Type::kFloat64; }
  static bool in_range(Type type, std::int64_t value);

  PlyStep run(const std::byte* bytes, std::size_t count, bool at_end);
  bool fail(PlyError error, std::uint64_t byte_offset, std::uint64_t line, std::uint32_t element);
  bool fail_in_row(PlyError error, std::uint64_t byte_offset);
  bool fail_at_word(PlyError error, std::size_t word);

  // Header. The functions that return bool return false after an error.
  bool header_byte(char c, std::uint64_t byte_offset);
  bool header_ends_early();
  bool end_line();
  void end_word();
  bool word_is(std::size_t word, const char* expected) const;
  Type type_from(std::size_t word) const;
  bool require_words(std::size_t count);
  bool format_line();
  bool element_line();
  bool property_line();
  bool end_header();
  bool keep_name(std::size_t word, Text& name);
  bool same_name(Text name, std::size_t word) const;
  Role role_of(std::size_t word, Kind kind) const;
  std::uint8_t attribute_of(std::size_t word, Kind kind) const;
  bool check_element(std::uint32_t element);
  void note_attributes(const Element& element);

  // Body.
  void begin_element(std::uint32_t element);
  void lay_out_rows();
  void end_property();
  void end_rows(std::uint64_t count);
  void flush_batch();
  bool ascii_body(const char* text, std::size_t count, std::size_t& used, bool at_end);
  bool ascii_trailer(const char* text, std::size_t count, std::size_t& used);
  bool skip_blanks(const char* text, std::size_t count, std::size_t& used);
  bool token_begins(std::uint64_t byte_offset, bool row_start);
  bool token(const char* text, std::size_t bytes, std::uint64_t byte_offset);
  bool binary_body(const std::byte* bytes, std::size_t count, std::size_t& used);
  std::size_t quick_rows(const std::byte* bytes, std::size_t row_count);
  std::size_t quick_vertices(const std::byte* bytes, std::size_t row_count);
  template <bool kSwap>
  std::size_t quick_float_vertices(const std::byte* bytes, std::size_t row_count);
  template <bool kSwap, class Count>
  std::size_t quick_faces(const std::byte* bytes, std::size_t row_count);
  void quick_attributes(const std::byte* bytes, std::size_t row_count, std::size_t first_item);
  std::uint64_t load_bits(const std::byte* bytes, Type type) const;
  bool binary_value(std::uint64_t bits, Type type, std::uint64_t byte_offset);
  bool list_count(std::int64_t count, std::uint64_t byte_offset);
  bool coordinate(std::uint32_t float_bits, std::uint64_t byte_offset);
  bool index(std::int64_t value, std::uint64_t byte_offset);
  [[nodiscard]] bool is_kept(const Property& property) const;
  static float attribute_value(std::uint64_t bits, Type type, std::uint8_t attribute);
  void keep_attributes(std::size_t item);
  bool emit_triangle(const UVec3& triangle, std::uint64_t byte_offset);
  [[nodiscard]] std::size_t room(std::size_t span_items, std::size_t wanted) const;
  [[nodiscard]] const Property& current_property() const {
    return properties_[elements_[element_].first_property + property_];
  }

  // Configuration, results.
  PlyConfig config_;
  PlyOutput output_;
  PlyHeader header_;
  PlyCounts counts_;
  PlyError error_ = PlyError::kNone;
  PlyPosition position_;

  // Where the reader is.
  Stage stage_ = Stage::kMagic;
  PlyEvent pending_ = PlyEvent::kNeedInput;  // an event to report before reading on
  std::uint64_t pending_first_ = 0;
  std::size_t pending_count_ = 0;
  std::uint64_t offset_ = 0;  // bytes consumed before the current piece; in the header: bytes consumed
  std::uint64_t line_ = 1;
  bool after_return_ = false;       // the last byte was a carriage return
  bool first_line_return_ = false;  // the first line ended with one; not yet known whether alone
  bool return_only_ = false;        // it did, alone
  std::uint8_t magic_bytes_ = 0;

  // The header's current line, then the ASCII token that a piece cut.
  char text_[kPlyTextBytes];
  std::uint16_t text_bytes_ = 0;
  bool in_word_ = false;
  std::uint16_t word_count_ = 0;  // saturates above kWordCapacity
  Word words_[kWordCapacity + 1];
  std::uint64_t token_offset_ = 0;

  // What the header declares.
  bool has_format_ = false;
  bool swap_bytes_ = false;
  std::uint32_t element_count_ = 0;
  std::uint32_t property_total_ = 0;
  std::uint32_t name_bytes_ = 0;
  Element elements_[kPlyElementCapacity];
  Property properties_[kPlyPropertyCapacity];
  char names_[kPlyNameBytes];

  // Place in the body.
  std::uint32_t element_ = 0;
  std::uint32_t property_ = 0;
  std::uint64_t row_ = 0;
  bool in_list_ = false;
  std::uint64_t list_left_ = 0;
  std::uint64_t skip_bytes_ = 0;  // rest of a value or list that nobody wants
  std::byte carry_[8];            // start of a binary value that a piece cut
  std::uint8_t carry_bytes_ = 0;
  RowLayout layout_;
  bool line_has_token_ = false;
  bool row_inside_line_ = false;  // a row started inside a line
  bool body_has_token_ = false;
  bool body_spans_lines_ = false;

  // The row being assembled.
  std::uint32_t coordinate_bits_[3] = {};
  float attributes_[kAttributes] = {};
  std::uint64_t corner_ = 0;  // corners of the polygon or strip so far
  std::uint32_t first_ = 0, previous_ = 0;
  std::size_t batch_ = 0;  // items waiting in the output span
};

/// Outcome of reading a whole input that lies in memory.
struct PlyResult {
  PlyError error = PlyError::kNone;  ///< kNone: the whole input was read
  PlyPosition position;  ///< where the error is
  PlyHeader header;      ///< what it announces
  PlyCounts counts;  ///< final where there is no error
};

/// Counts vertices and triangles of an input with all checks and no memory: the exact need of read_ply.
[[nodiscard]] PlyResult count_ply(std::span<const std::byte> input, const PlyConfig& config = {});

/// Reads a whole input. On success counts.vertices and counts.triangles places of the spans are written.
///
/// Errors: any PlyError; the spans then hold no usable mesh.
[[nodiscard]] PlyResult read_ply(std::span<const std::byte> input, std::span<Vec3> vertices, std::span<UVec3> triangles,
                                 const PlyConfig& config = {});

/// The same with normals and colours where the output has places for them and the header declares them.
///
/// Errors: kVertexSpanTooSmall too if there are places, but fewer than vertices.
[[nodiscard]] PlyResult read_ply(std::span<const std::byte> input, const PlyOutput& output,
                                 const PlyConfig& config = {});

}  // namespace gridiron
