// Second pass of a build: codes runs of triangles, drops those without an area, and sorts each run. Triangles are also
// written as records, so that later passes find all of one in 48 bytes; in the order of the run's codes where the store
// holds the records of a run, so that neighbours lie side by side.
// Memory: the pass's store. Threads: one core. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/build/passes/build_plan.h>
#include <gridiron/build/passes/pass_sort.h>
#include <gridiron/build/passes/pass_tools.h>
#include <gridiron/build/passes/record_stream.h>
#include <gridiron/build/tree/tree_box.h>
#include <gridiron/build/tree/tree_curve.h>
#include <gridiron/build/tree/tree_order.h>

#include <bit>
#include <cstddef>

namespace gridiron {

// Words of a vertex and of a line.
inline constexpr std::uint32_t kVertexWords = kVertexBytes / 4, kLineWords = kLineBytes / 4;

/// Records on their way.
template <class Layout>
using RecordChunks = VertexTriangle[4][Layout::kChunkTriangles];

/// Records of a run that are not sorted: there is nothing to keep.
template <class Layout, bool kSorts = Layout::kSortsRecords>
struct RunRecords {
  alignas(128) RecordChunks<Layout> sent;
};
/// Records of a run, to be sorted.
template <class Layout>
struct RunRecords<Layout, true> {
  alignas(128) VertexTriangle all[Layout::kRunTriangles];
};

/// What sorting a run takes when its vertices are not needed any more.
template <class Layout>
struct RunSort {
  alignas(128) TreeKey spare[Layout::kRunTriangles];
  alignas(128) RecordChunks<Layout> sent;
  alignas(16) std::uint32_t counts[kSortCounts<Layout::kDigitBits>];
};

/// A line of vertices that is in the store. A quadword, as a core looks up and stores no less.
struct alignas(16) HeldLine {
  std::uint32_t number;  // + 1; 0: none
  std::uint32_t user;    // the last chunk that asked for it
  std::uint32_t reserved[2];
};
static_assert(sizeof(HeldLine) == 16);

template <class Layout>
struct CodesStore {
  static constexpr std::uint32_t kCorners = 3 * Layout::kChunkTriangles;
  static constexpr std::size_t kLoneBytes = window_bytes<Vec3>(1);
  static constexpr std::size_t kLoneRoom = static_cast<std::size_t>(kCorners) * kLoneBytes;
  static constexpr std::uint32_t kPartWindow = 16;

  // Lines of vertices, each at its number modulo theirs, so that one that ends in the next line does so here too.
  union {
    alignas(128) std::byte lines[Layout::kCacheLines][kLineBytes];
    RunSort<Layout> sort;
  };
  std::byte lone[2][kLoneRoom];  // vertices that found no place there
  alignas(128) std::byte indices[2][window_bytes<UVec3>(Layout::kIndexWindow)];
  RunRecords<Layout> records;
  alignas(128) TreeKey keys[Layout::kRunTriangles];
  alignas(128) std::uint32_t samples[kMostRunSamples];
  alignas(128) RunPart part;
  alignas(128) std::byte vertex_parts[2 * window_bytes<CornerBox>(kPartWindow)];
  alignas(16) HeldLine held[Layout::kCacheLines];
  alignas(16) std::uint32_t corners[2][kCorners];  // of a chunk's triangles: bytes from lines on
};

/// Codes runs of triangles, one after another.
template <class Layout, class P>
class RunCoder {
 public:
  RunCoder(BuildTransfers<P>& transfers, CodesStore<Layout>& store, const BuildPlan& plan, const TreeCurve& curve)
      : transfers_(transfers), store_(store), plan_(plan), curve_(curve) {
    const std::uint64_t bytes = plan.input.vertex_count * std::uint64_t{kVertexBytes};
    whole_lines_ = static_cast<std::uint32_t>(bytes / kLineBytes);
    rest_bytes_ = round_up(static_cast<std::uint32_t>(bytes % kLineBytes), std::uint32_t{kPortableGranuleBytes});
  }

  /// Errors: kBadIndex.
  [[nodiscard]] Status code(std::uint32_t run) {
    const std::uint64_t first = std::uint64_t{run} * plan_.run_triangles, rest = plan_.input.triangle_count - first;
    const std::uint32_t count = rest < plan_.run_triangles ? static_cast<std::uint32_t>(rest) : plan_.run_triangles;
    const std::uint32_t chunks = (count + kChunk - 1) / kChunk;
    bounds_ = FourBoxes::none();
    all_codes_ = Lanes<4>::Int::splat(0);
    same_codes_ = Lanes<4>::Int::splat(~0u);
    kept_ = 0;
    // What the run before has left is not used: transfers of an item depend on nothing but the item.
    clock_ = 2;
    for (HeldLine& line : store_.held) line = {};
    const auto chunk_count = [count](std::uint32_t chunk) {
      return count - chunk * kChunk < kChunk ? count - chunk * kChunk : kChunk;
    };
    GRIDIRON_TRY(get_indices(first, count, 0));
    for (std::uint32_t chunk = 0; chunk < chunks; ++chunk) {
      GRIDIRON_TRY(ask_for_corners(first, count, chunk, chunk_count(chunk)));
      if (chunk > 0) GRIDIRON_TRY(take(first, chunk - 1, chunk_count(chunk - 1)));
      ++clock_;
    }
    GRIDIRON_TRY(take(first, chunks - 1, chunk_count(chunks - 1)));
    GRIDIRON_TRY(finish(run));
    return wait_for(transfers_, kFirstOutputTag, 6);
  }

 private:
  static constexpr std::uint32_t kChunk = Layout::kChunkTriangles;
  static constexpr std::uint32_t kLines = Layout::kCacheLines;
  static constexpr std::uint8_t kIndexTag = kFirstMacroTag, kCornerTag = kFirstTriangleTag;  // and the next
  static constexpr std::uint8_t kKeysTag = kFirstOutputTag + 4, kPartTag = kKeysTag + 1;     // records: four before
  static_assert(Layout::kIndexWindow % kChunk == 0 && kChunk % 4 == 0);

  [[nodiscard]] Window<UVec3> index_window(std::uint64_t first, std::uint32_t window) {
    return {store_.indices[window % 2], plan_.input.triangles, first + std::uint64_t{window} * Layout::kIndexWindow};
  }
  [[nodiscard]] Status get_indices(std::uint64_t first, std::uint32_t count, std::uint32_t window) {
    const std::uint32_t begin = window * Layout::kIndexWindow;
    if (begin >= count) return Status::kOk;
    const std::uint32_t rest = count - begin;
    return index_window(first, window)
        .get(transfers_, rest < Layout::kIndexWindow ? rest : Layout::kIndexWindow,
             static_cast<std::uint8_t>(kIndexTag + window % 2));
  }

  // Finds or asks for the corners of a chunk. The chunk before it has not been taken yet.
  [[nodiscard]] Status ask_for_corners(std::uint64_t first, std::uint32_t run_count, std::uint32_t chunk,
                                       std::uint32_t count) {
    const std::uint32_t begin = chunk * kChunk, window = begin / Layout::kIndexWindow;
    if (begin % Layout::kIndexWindow == 0) {
      GRIDIRON_TRY(get_indices(first, run_count, window + 1));
      GRIDIRON_TRY(transfers_.wait(static_cast<std::uint8_t>(kIndexTag + window % 2)));
    }
    const auto* const indices =
        reinterpret_cast<const std::uint32_t*>(index_window(first, window).elements() + begin % Layout::kIndexWindow);
    std::uint32_t* const corners = store_.corners[chunk % 2];
    const std::uint32_t vertex_count = plan_.input.vertex_count;
    transfers_.add_work(BuildWork::kCorner, 3 * count);
    using L = Lanes<4>;
    for (std::uint32_t i = 0; i < 3 * count; i += 4) {
      const L::Int index = L::Int::load(indices + i);
      const std::uint32_t rest = 3 * count - i, there = rest < 4 ? (1u << rest) - 1u : std::uint32_t{15};
      if (((index < L::Int::splat(vertex_count)).bits() & ~L::sign_bits(index) & there) != there) {
        return Status::kBadIndex;
      }
      const L::Int words = (index << 1) + index, lines = words >> 5;
      static_assert(kVertexWords == 3 && kLineWords == 32);
      // Of those that end in the next line none is taken to be here.
      const std::uint32_t outer =
          (L::Int::splat(kLineWords - kVertexWords) < (words & L::Int::splat(kLineWords - 1))).bits();
      ((words & L::Int::splat(kLines * kLineWords - 1)) << 2).store(corners + i);
      const L::Float numbers = L::floats_of(lines + L::Int::splat(1)), clock = L::floats_of(L::Int::splat(clock_));
      const L::Int quads[4] = {L::words_of(L::shuffle_quads<0, 4, 4, 4>(numbers, clock)),
                               L::words_of(L::shuffle_quads<1, 4, 4, 4>(numbers, clock)),
                               L::words_of(L::shuffle_quads<2, 4, 4, 4>(numbers, clock)),
                               L::words_of(L::shuffle_quads<3, 4, 4, 4>(numbers, clock))};
      for (std::uint32_t k = 0; k < 4 && k < rest; ++k) {
        const auto line = static_cast<std::uint32_t>(lines[static_cast<int>(k)]);
        auto* const held = reinterpret_cast<std::uint32_t*>(&store_.held[line % kLines]);
        const auto number = static_cast<std::uint32_t>(L::Int::load(held)[0]);
        // One branch for both.
        if (((number ^ (line + 1)) | (outer >> k & 1u)) == 0) {
          quads[k].store(held);
        } else {
          GRIDIRON_TRY(ask_for(indices[i + k], chunk, i + k));
          transfers_.charge_to(BuildWork::kCorner);
        }
      }
    }
    return Status::kOk;
  }
  // Asks for the lines of a vertex that are not here.
  [[nodiscard]] GRIDIRON_OUTLINE Status ask_for(std::uint32_t index, std::uint32_t chunk, std::uint32_t corner) {
    transfers_.add_work(BuildWork::kMissedCorner);
    const std::uint32_t word = (index << 1) + index;
    const std::uint32_t first = word / kLineWords, last = (word + kVertexWords - 1) / kLineWords;
    std::uint32_t& place = store_.corners[chunk % 2][corner];
    if (first == last) {
      // It is not here. This chunk or the one before may need what is in its place.
      if (store_.held[first % kLines].user + 1 >= clock_) return ask_for_lone(index, chunk, corner);
      place = word % (kLines * kLineWords) * 4;
      return get_line(first, chunk);
    }
    // Of the last place the next one is not behind.
    const auto is_here = [this](std::uint32_t line) { return store_.held[line % kLines].number == line + 1; };
    const auto is_taken = [&](std::uint32_t line) {
      return !is_here(line) && store_.held[line % kLines].user + 1 >= clock_;
    };
    if (is_taken(first) || is_taken(last) || last % kLines < first % kLines) return ask_for_lone(index, chunk, corner);
    place = word % (kLines * kLineWords) * 4;
    for (const std::uint32_t line : {first, last}) {
      if (is_here(line)) {
        store_.held[line % kLines].user = clock_;
      } else {
        GRIDIRON_TRY(get_line(line, chunk));
      }
    }
    return Status::kOk;
  }
  // Gets a line of vertices that is not here.
  [[nodiscard]] GRIDIRON_INLINE Status get_line(std::uint32_t line, std::uint32_t chunk) {
    const std::uint32_t slot = line % kLines;
    words_quad(line + 1, clock_, 0, 0).store(&store_.held[slot].number);
    const std::uint32_t bytes = line < whole_lines_ ? std::uint32_t{kLineBytes} : rest_bytes_;
    return transfers_.get(store_.lines[slot], plan_.input.vertices.offset_by(std::uint64_t{line} * kLineBytes), bytes,
                          corner_tag(chunk));
  }
  [[nodiscard]] static std::uint8_t corner_tag(std::uint32_t chunk) {
    return static_cast<std::uint8_t>(kCornerTag + chunk % 2);
  }
  [[nodiscard]] Status ask_for_lone(std::uint32_t index, std::uint32_t chunk, std::uint32_t corner) {
    std::byte* const buffer = store_.lone[chunk % 2] + corner * CodesStore<Layout>::kLoneBytes;
    const Window<Vec3> window(buffer, plan_.input.vertices, index);
    store_.corners[chunk % 2][corner] =
        static_cast<std::uint32_t>(reinterpret_cast<const std::byte*>(window.elements()) - store_bytes());
    return window.get(transfers_, 1, corner_tag(chunk));
  }

  // Makes records and keys of a chunk's triangles.
  [[nodiscard]] Status take(std::uint64_t first, std::uint32_t chunk, std::uint32_t count) {
    GRIDIRON_TRY(transfers_.wait(corner_tag(chunk)));
    const std::uint64_t chunk_first = first + chunk * kChunk;
    VertexTriangle* records = nullptr;
    std::uint32_t key_first = chunk * kChunk;  // ids of keys: places in the run, or of records
    if constexpr (Layout::kSortsRecords) {
      records = store_.records.all + chunk * kChunk;
    } else {
      records = store_.records.sent[chunk % 4];
      key_first = static_cast<std::uint32_t>(chunk_first);
      GRIDIRON_TRY(transfers_.wait(record_tag(chunk)));
    }
    const std::uint32_t* const places = store_.corners[chunk % 2];
    transfers_.add_work(BuildWork::kCodedGroup, (count + 3) / 4);
    for (std::uint32_t i = 0; i < count; i += 4) {
      CornerQuads corners[4];
      for (std::uint32_t k = 0; k < 4; ++k) {
        const std::uint32_t j = i + k < count ? i + k : count - 1;
        corners[k] = {corner_at(places[3 * j]), corner_at(places[3 * j + 1]), corner_at(places[3 * j + 2])};
      }
      const std::uint32_t there = count - i < 4 ? (1u << (count - i)) - 1u : std::uint32_t{15};
      const FourTriangles triangles = FourTriangles::of(corners);
      const CornerQuad areas = areas_of(triangles);
      for (std::uint32_t k = 0; k < 4 && i + k < count; ++k) {
        write_record(corners[k], static_cast<std::uint32_t>(chunk_first) + i + k, lane_of(areas, static_cast<int>(k)),
                     records[i + k]);
      }
      take_four(triangles, key_first + i, there);
    }
    if constexpr (Layout::kSortsRecords) return Status::kOk;
    return put_records(records, chunk_first, count, record_tag(chunk));
  }
  [[nodiscard]] Status put_records(const VertexTriangle* records, std::uint64_t place, std::uint32_t count,
                                   std::uint8_t tag) {
    return transfers_.put(records, plan_.raw_records.offset_by(place * sizeof(VertexTriangle)),
                          count * static_cast<std::uint32_t>(sizeof(VertexTriangle)), tag);
  }
  [[nodiscard]] static std::uint8_t record_tag(std::uint32_t chunk) {
    return static_cast<std::uint8_t>(kFirstOutputTag + chunk % 4);
  }
  // Writes the records of a sorted run.
  [[nodiscard]] Status send_records(std::uint32_t run, const TreeKey* sorted) {
    for (std::uint32_t chunk = 0; chunk * kChunk < kept_; ++chunk) {
      const std::uint32_t begin = chunk * kChunk, count = kept_ - begin < kChunk ? kept_ - begin : kChunk;
      VertexTriangle* const sent = store_.sort.sent[chunk % 4];
      GRIDIRON_TRY(transfers_.wait(record_tag(chunk)));
      transfers_.add_work(BuildWork::kSortedRecord, count);
      const auto copy = [&](std::uint32_t i, auto group) GRIDIRON_INLINE_LAMBDA {
        for (std::uint32_t k = 0; k < group.value; ++k) {
          const TreeKey key = sorted[begin + i + k];
          const VertexTriangle& record = store_.records.all[key.id()];
          copy_record(record, with_code(third_quad(record), key.code()), sent[i + k]);
        }
      };
      for_each_group(count, copy);
      GRIDIRON_TRY(put_records(sent, std::uint64_t{run} * plan_.run_triangles + begin, count, record_tag(chunk)));
    }
    return Status::kOk;
  }
  [[nodiscard]] GRIDIRON_INLINE CornerQuad corner_at(std::uint32_t place) const {
    // Not the word behind it, which may be under way.
    return quad_of(*reinterpret_cast<const Vec3*>(store_bytes() + place));
  }
  // Places of corners count from here: from the first line.
  [[nodiscard]] GRIDIRON_INLINE const std::byte* store_bytes() const {
    static_assert(offsetof(CodesStore<Layout>, lines) == 0);
    return reinterpret_cast<const std::byte*>(&store_);
  }
  // Until it is in its final place, a record has the triangle's area in the place of its first reserved word, and where
  // runs have sorted records its code in the second.
  static GRIDIRON_INLINE void write_record(const CornerQuads& corners, std::uint32_t id, float area,
                                           VertexTriangle& record) {
    using L = Lanes<4>;
    auto* const words = reinterpret_cast<float*>(&record);
    const CornerQuad a = corners.a, b = corners.b, c = corners.c;
    const L::Int end = words_quad(0, std::bit_cast<std::uint32_t>(area), 0, id);
    const L::Float cz = L::shuffle_quads<2, 3, 3, 3>(c);  // the last lane is 0
    L::shuffle_quads<0, 1, 2, 4>(a, b).store(words);
    L::shuffle_quads<1, 2, 4, 5>(b, c).store(words + 4);
    L::floats_of(L::words_of(cz) | end).store(words + 8);
  }
  GRIDIRON_INLINE void take_four(const FourTriangles& triangles, std::uint32_t first, std::uint32_t there) {
    const std::uint32_t kept = triangles.with_area() & there;
    FourBoxes boxes = triangles.boxes();
    const Lanes<4>::Int codes = curve_.codes_of(boxes);
    all_codes_ = all_codes_ | codes;
    same_codes_ = same_codes_ & codes;
    if (kept == 15u) {
      TreeKey::store_four(codes, first, store_.keys + kept_);
      kept_ += 4;
    } else {
      for (int lane = 0; lane < 4; ++lane) {
        if ((kept >> lane & 1u) == 0) continue;
        store_.keys[kept_++] =
            TreeKey::of(static_cast<std::uint32_t>(codes[lane]), first + static_cast<std::uint32_t>(lane));
      }
      boxes.keep(kept);
    }
    bounds_.add(boxes);
  }

  // Sorts the run and sends keys, samples and bounds on their way.
  [[nodiscard]] Status finish(std::uint32_t run) {
    std::uint32_t all = 0, same = ~0u;
    for (int lane = 0; lane < 4; ++lane) {
      all |= static_cast<std::uint32_t>(all_codes_[lane]);
      same &= static_cast<std::uint32_t>(same_codes_[lane]);
    }
    const bool is_in_spare =
        sort_run<1>(store_.keys, store_.sort.spare, kept_, Layout::kDigitBits,
                    static_cast<std::uint32_t>(width_of(all & ~same)), store_.sort.counts, transfers_);
    const TreeKey* const sorted = is_in_spare ? store_.sort.spare : store_.keys;
    if (kept_ > 0) {
      GRIDIRON_TRY(transfers_.put(
          sorted, plan_.run_keys.offset_by(std::uint64_t{run} * plan_.run_triangles * sizeof(TreeKey)),
          round_up(kept_ * static_cast<std::uint32_t>(sizeof(TreeKey)), kPortableGranuleBytes), kKeysTag));
    }
    if (run % plan_.sampled_runs == 0) {
      // In the middle of equal shares; of places behind the last key there is none.
      const std::uint32_t step = plan_.run_triangles / plan_.run_samples;
      std::uint32_t* const samples = store_.samples;
      for (std::uint32_t i = 0; i < plan_.run_samples; ++i) {
        const std::uint32_t place = i * step + step / 2;
        samples[i] = place < kept_ ? sorted[place].code() : kNoSample;
      }
      const std::uint64_t bytes = std::uint64_t{4} * plan_.run_samples;
      GRIDIRON_TRY(transfers_.put(samples, plan_.samples.offset_by(run / plan_.sampled_runs * bytes),
                                  static_cast<std::uint32_t>(bytes), kPartTag));
    }
    if constexpr (Layout::kSortsRecords) GRIDIRON_TRY(send_records(run, sorted));
    RunPart& part = store_.part;
    part.low[0] = bounds_.low.x, part.low[1] = bounds_.low.y, part.low[2] = bounds_.low.z;
    part.high[0] = bounds_.high.x, part.high[1] = bounds_.high.y, part.high[2] = bounds_.high.z;
    part.count = kept_;
    for (std::uint32_t& word : part.reserved) word = 0;
    return transfers_.put(&part, plan_.run_parts.offset_by(run * sizeof(RunPart)), sizeof(RunPart), kPartTag);
  }

  BuildTransfers<P>& transfers_;
  CodesStore<Layout>& store_;
  const BuildPlan& plan_;
  TreeCurve curve_;
  FourBoxes bounds_ = FourBoxes::none();
  Lanes<4>::Int all_codes_ = Lanes<4>::Int::splat(0), same_codes_ = all_codes_;  // bits that any, and that all have
  std::uint32_t kept_ = 0;
  std::uint32_t clock_ = 2;                         // chunks, plus two
  std::uint32_t whole_lines_ = 0, rest_bytes_ = 0;  // of vertices
};

/// The lattice of all triangles' middles, from the bounds of vertices.
template <class Layout, class P>
[[nodiscard]] Status find_curve(BuildTransfers<P>& transfers, CodesStore<Layout>& store, const BuildPlan& plan,
                                QuadBox& middles) {
  QuadBox vertices;
  GRIDIRON_TRY((for_each_window<CornerBox, CodesStore<Layout>::kPartWindow>(
      transfers, store.vertex_parts, plan.vertex_parts, 0, plan.vertex_items, kFirstMacroTag,
      [&](const CornerBox* parts, std::uint64_t, std::uint32_t count) {
        for (std::uint32_t i = 0; i < count; ++i) {
          vertices.low = Lanes<4>::min(parts[i].low, vertices.low);
          vertices.high = Lanes<4>::max(parts[i].high, vertices.high);
        }
        return Status::kOk;
      })));
  middles = {vertices.low + vertices.low, vertices.high + vertices.high};
  return Status::kOk;
}

/// Writes run_keys, samples, run_parts and raw_records. Items: runs. Errors: kBadIndex.
template <class Layout, class P>
[[nodiscard]] Status run_codes_pass(BuildTransfers<P>& transfers, CodesStore<Layout>& store, const BuildPlan& plan) {
  QuadBox middles;
  GRIDIRON_TRY(find_curve(transfers, store, plan, middles));
  RunCoder<Layout, P> coder(transfers, store, plan, TreeCurve(middles));
  return for_each_item(transfers, plan.run_count, [&](std::uint32_t run) { return coder.code(run); });
}

}  // namespace gridiron
