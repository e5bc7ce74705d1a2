// SIMD lanes: W floats that go through the same operations. The kernel chooses W; the choice changes no pixel, as every
// operation is the IEEE one in each lane. Source: GCC vector extensions. Memory: values. Threads: any.
// All functions are always inlined, so that files built for a wide ISA leave no function behind for baseline ones.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>

#if defined(__AVX512F__) || defined(__AVX2__) || defined(__SSE2__)
#include <immintrin.h>
#elif defined(__ARM_NEON)
#include <arm_neon.h>
#endif

#define GRIDIRON_INLINE inline __attribute__((always_inline))
#define GRIDIRON_INLINE_LAMBDA __attribute__((always_inline))
/// For code that several instantiations share: one copy saves local store.
#define GRIDIRON_OUTLINE __attribute__((noinline))
/// The same for code that hardly ever runs: optimised for size.
#define GRIDIRON_RARE __attribute__((noinline, cold))

namespace gridiron {

/// An enumeration that lies in the local store.
template <class Enumeration>
using Stored = Enumeration;

/// The compiler's vector types: W floats or ints, W / 2 doubles, longs or half vectors; ...Memory may alias plain
/// arrays.
template <int W>
struct LaneVectors;
template <>
struct LaneVectors<4> {
  typedef float FloatVector __attribute__((vector_size(16)));
  typedef std::int32_t IntVector __attribute__((vector_size(16)));
  typedef double DoubleVector __attribute__((vector_size(16)));
  typedef std::int64_t LongVector __attribute__((vector_size(16)));
  typedef std::int32_t HalfIntVector __attribute__((vector_size(8)));
  typedef float FloatMemory __attribute__((vector_size(16), may_alias));
  typedef std::int32_t IntMemory __attribute__((vector_size(16), may_alias));
  typedef float HalfFloatMemory __attribute__((vector_size(8), may_alias));
  typedef std::int32_t HalfIntMemory __attribute__((vector_size(8), may_alias));
  typedef std::uint16_t HalvesMemory __attribute__((vector_size(8), may_alias));
};
template <>
struct LaneVectors<8> {
  typedef float FloatVector __attribute__((vector_size(32)));
  typedef std::int32_t IntVector __attribute__((vector_size(32)));
  typedef double DoubleVector __attribute__((vector_size(32)));
  typedef std::int64_t LongVector __attribute__((vector_size(32)));
  typedef std::int32_t HalfIntVector __attribute__((vector_size(16)));
  typedef float FloatMemory __attribute__((vector_size(32), may_alias));
  typedef std::int32_t IntMemory __attribute__((vector_size(32), may_alias));
  typedef float HalfFloatMemory __attribute__((vector_size(16), may_alias));
  typedef std::int32_t HalfIntMemory __attribute__((vector_size(16), may_alias));
  typedef std::uint16_t HalvesMemory __attribute__((vector_size(16), may_alias));
};
template <>
struct LaneVectors<16> {
  typedef float FloatVector __attribute__((vector_size(64)));
  typedef std::int32_t IntVector __attribute__((vector_size(64)));
  typedef double DoubleVector __attribute__((vector_size(64)));
  typedef std::int64_t LongVector __attribute__((vector_size(64)));
  typedef std::int32_t HalfIntVector __attribute__((vector_size(32)));
  typedef float FloatMemory __attribute__((vector_size(64), may_alias));
  typedef std::int32_t IntMemory __attribute__((vector_size(64), may_alias));
  typedef float HalfFloatMemory __attribute__((vector_size(32), may_alias));
  typedef std::int32_t HalfIntMemory __attribute__((vector_size(32), may_alias));
  typedef std::uint16_t HalvesMemory __attribute__((vector_size(32), may_alias));
};

/// W truth values; bit i of bits() = lane i.
template <int W>
struct LaneMask {
  typename LaneVectors<W>::IntVector v;

  [[nodiscard]] GRIDIRON_INLINE std::uint32_t bits() const {
#if defined(__AVX2__)
    if constexpr (W == 8) return static_cast<std::uint32_t>(_mm256_movemask_ps(reinterpret_cast<__m256>(v)));
#endif
#if defined(__SSE2__)
    if constexpr (W == 4) return static_cast<std::uint32_t>(_mm_movemask_ps(reinterpret_cast<__m128>(v)));
#endif
    std::uint32_t result = 0;
    for (int i = 0; i < W; ++i) result |= (static_cast<std::uint32_t>(v[i]) & 1u) << i;
    return result;
  }
  friend GRIDIRON_INLINE LaneMask operator|(LaneMask a, LaneMask b) {
    return {a.v | b.v};
  }
  friend GRIDIRON_INLINE LaneMask operator&(LaneMask a, LaneMask b) {
    return {a.v & b.v};
  }
};

#if defined(__AVX512F__)
/// With AVX-512 truth values live in mask registers.
template <>
struct LaneMask<16> {
  __mmask16 m;
  [[nodiscard]] GRIDIRON_INLINE std::uint32_t bits() const { return m; }
  friend GRIDIRON_INLINE LaneMask operator|(LaneMask a, LaneMask b) {
    return {static_cast<__mmask16>(static_cast<unsigned>(a.m) | static_cast<unsigned>(b.m))};
  }
  friend GRIDIRON_INLINE LaneMask operator&(LaneMask a, LaneMask b) {
    return {static_cast<__mmask16>(static_cast<unsigned>(a.m) & static_cast<unsigned>(b.m))};
  }
};
#endif

/// Vectors of W lanes. W = 4 (chips), 8, 16 (hosts); 16 is meant for files compiled with AVX-512.
template <int W>
struct Lanes {
  static constexpr int kCount = W;
  static constexpr std::uint32_t kAllBits = (W == 32) ? ~0u : ((1u << W) - 1u);

  using FloatVector = typename LaneVectors<W>::FloatVector;
  using IntVector = typename LaneVectors<W>::IntVector;
  using DoubleVector = typename LaneVectors<W>::DoubleVector;
  using LongVector = typename LaneVectors<W>::LongVector;
  using HalfIntVector = typename LaneVectors<W>::HalfIntVector;
  using FloatMemory = typename LaneVectors<W>::FloatMemory;
  using IntMemory = typename LaneVectors<W>::IntMemory;
  using HalfFloatMemory = typename LaneVectors<W>::HalfFloatMemory;
  using HalfIntMemory = typename LaneVectors<W>::HalfIntMemory;

  using Mask = LaneMask<W>;

  enum class Order : std::uint8_t { kLess, kLessEqual };
  template <Order kOrder>
  [[nodiscard]] static GRIDIRON_INLINE Mask compare(FloatVector a, FloatVector b) {
#if defined(__AVX512F__)
    if constexpr (W == 16) {
      return {_mm512_cmp_ps_mask(__m512(a), __m512(b), kOrder == Order::kLess ? _CMP_LT_OQ : _CMP_LE_OQ)};
    } else
#endif
    {
      if constexpr (kOrder == Order::kLess) return {a < b};
      return {a <= b};
    }
  }

  /// W floats.
  struct Float {
    FloatVector v;

    Float() = default;
    GRIDIRON_INLINE explicit Float(FloatVector vector) : v(vector) {}
    /// The same value in every lane (x - 0 is x, the sign of zero included).
    GRIDIRON_INLINE explicit Float(float value) : v(value - FloatVector{}) {}

    /// @param source  W floats, aligned to 4 * W bytes.
    [[nodiscard]] static GRIDIRON_INLINE Float load(const float* source) {
      return Float(*reinterpret_cast<const FloatMemory*>(source));
    }
    GRIDIRON_INLINE void store(float* target) const { *reinterpret_cast<FloatMemory*>(target) = v; }

    friend GRIDIRON_INLINE Float operator+(Float a, Float b) { return Float(a.v + b.v); }
    friend GRIDIRON_INLINE Float operator-(Float a, Float b) { return Float(a.v - b.v); }
    friend GRIDIRON_INLINE Float operator*(Float a, Float b) { return Float(a.v * b.v); }
    friend GRIDIRON_INLINE Float operator/(Float a, Float b) { return Float(a.v / b.v); }
    friend GRIDIRON_INLINE Float operator-(Float a) { return Float(-a.v); }
    friend GRIDIRON_INLINE Mask operator<(Float a, Float b) { return compare<Order::kLess>(a.v, b.v); }
    friend GRIDIRON_INLINE Mask operator>(Float a, Float b) { return compare<Order::kLess>(b.v, a.v); }
    friend GRIDIRON_INLINE Mask operator<=(Float a, Float b) { return compare<Order::kLessEqual>(a.v, b.v); }
    friend GRIDIRON_INLINE Mask operator>=(Float a, Float b) { return compare<Order::kLessEqual>(b.v, a.v); }
  };

  /// W signed integers.
  struct Int {
    IntVector v;
    /// The same word in every lane.
    [[nodiscard]] static GRIDIRON_INLINE Int splat(std::uint32_t word) {
      return {IntVector{} + static_cast<std::int32_t>(word)};
    }
    /// @param source  W words, aligned to 4 * W bytes.
    [[nodiscard]] static GRIDIRON_INLINE Int load(const std::uint32_t* source) {
      return {*reinterpret_cast<const IntMemory*>(source)};
    }
    [[nodiscard]] GRIDIRON_INLINE std::int32_t operator[](int lane) const { return v[lane]; }
    GRIDIRON_INLINE void store(std::uint32_t* target) const { *reinterpret_cast<IntMemory*>(target) = v; }
    friend GRIDIRON_INLINE Int operator+(Int a, Int b) { return {a.v + b.v}; }
    friend GRIDIRON_INLINE Int operator|(Int a, Int b) { return {a.v | b.v}; }
    friend GRIDIRON_INLINE Int operator&(Int a, Int b) { return {a.v & b.v}; }
    friend GRIDIRON_INLINE Int operator^(Int a, Int b) { return {a.v ^ b.v}; }
    friend GRIDIRON_INLINE Int operator<<(Int a, int count) { return {a.v << count}; }
    friend GRIDIRON_INLINE Int operator>>(Int a, int count) { return {a.v >> count}; }
    /// Each lane by a number of its own.
    friend GRIDIRON_INLINE Int operator>>(Int a, Int counts) { return {a.v >> counts.v}; }
    friend GRIDIRON_INLINE Mask operator<(Int a, Int b) {
#if defined(__AVX512F__)
      if constexpr (W == 16)
        return {_mm512_cmplt_epi32_mask(__m512i(a.v), __m512i(b.v))};
      else
#endif
        return {a.v < b.v};
    }
  };
  /// W / 2 integers of 64 bits. Comparisons give -1 in the lanes where they hold, else 0.
  struct Long {
    LongVector v;
    friend GRIDIRON_INLINE Long operator+(Long a, std::int64_t b) { return {a.v + b}; }
    friend GRIDIRON_INLINE Long operator-(Long a, std::int64_t b) { return {a.v - b}; }
    friend GRIDIRON_INLINE Long operator>>(Long a, int count) { return {a.v >> count}; }
    friend GRIDIRON_INLINE Long operator&(Long a, Long b) { return {a.v & b.v}; }
    friend GRIDIRON_INLINE Long operator~(Long a) { return {~a.v}; }
    friend GRIDIRON_INLINE Long operator==(Long a, Long b) { return {a.v == b.v}; }
    friend GRIDIRON_INLINE Long operator>=(Long a, std::int64_t b) { return {a.v >= b}; }
    friend GRIDIRON_INLINE Long operator<=(Long a, std::int64_t b) { return {a.v <= b}; }
  };
  /// W / 2 doubles.
  struct Double {
    DoubleVector v;

    GRIDIRON_INLINE explicit Double(DoubleVector vector) : v(vector) {}
    GRIDIRON_INLINE explicit Double(double value) : v(value - DoubleVector{}) {}
    /// @param source  W / 2 floats, aligned to 2 * W bytes.
    [[nodiscard]] static GRIDIRON_INLINE Double load_floats(const float* source) {
      return Double(__builtin_convertvector(*reinterpret_cast<const HalfFloatMemory*>(source), DoubleVector));
    }
    /// The 64 bits of each lane.
    [[nodiscard]] GRIDIRON_INLINE Long pattern() const { return {reinterpret_cast<LongVector>(v)}; }

    friend GRIDIRON_INLINE Double operator+(Double a, Double b) { return Double(a.v + b.v); }
    friend GRIDIRON_INLINE Double operator-(Double a, Double b) { return Double(a.v - b.v); }
    friend GRIDIRON_INLINE Double operator*(Double a, Double b) { return Double(a.v * b.v); }
    friend GRIDIRON_INLINE Double operator/(Double a, Double b) { return Double(a.v / b.v); }
    friend GRIDIRON_INLINE Long operator<(Double a, double b) { return {a.v < b}; }
    friend GRIDIRON_INLINE Long operator<(Double a, Double b) { return {a.v < b.v}; }
  };

  /// Lane `lane` of a.
  [[nodiscard]] static GRIDIRON_INLINE float lane(Float a, std::uint32_t lane) {
    return a.v[lane];
  }
  /// Rounded towards zero. Precondition: the values fit.
  [[nodiscard]] static GRIDIRON_INLINE Int truncate(Float a) {
    return {__builtin_convertvector(a.v, IntVector)};
  }
  /// The words of floats.
  [[nodiscard]] static GRIDIRON_INLINE Int words_of(Float a) {
    return {reinterpret_cast<IntVector>(a.v)};
  }
  /// The floats that words are.
  [[nodiscard]] static GRIDIRON_INLINE Float floats_of(Int a) {
    return Float(reinterpret_cast<FloatVector>(a.v));
  }
  [[nodiscard]] static GRIDIRON_INLINE Float to_float(Int a) {
    return Float(__builtin_convertvector(a.v, FloatVector));
  }
  /// Stores the low halves of W / 2 integers of 64 bits as the patterns of floats, aligned to 2 * W bytes.
  static GRIDIRON_INLINE void store_patterns(Long patterns, float* target) {
    *reinterpret_cast<HalfIntMemory*>(target) = __builtin_convertvector(patterns.v, HalfIntVector);
  }

  /// a < b ? a : b, also of NaN and zeros.
  [[nodiscard]] static GRIDIRON_INLINE Float min(Float a, Float b) {
#if defined(__AVX512F__)
    if constexpr (W == 16)
      return Float(FloatVector(_mm512_maskz_min_ps(static_cast<__mmask16>(kAllBits), __m512(a.v), __m512(b.v))));
    else
#endif
      return Float(a.v < b.v ? a.v : b.v);
  }
  /// a > b ? a : b, likewise.
  [[nodiscard]] static GRIDIRON_INLINE Float max(Float a, Float b) {
#if defined(__AVX512F__)
    if constexpr (W == 16)
      return Float(FloatVector(_mm512_maskz_max_ps(static_cast<__mmask16>(kAllBits), __m512(a.v), __m512(b.v))));
    else
#endif
      return Float(a.v > b.v ? a.v : b.v);
  }
  /// Whether wide lanes have a bounded_sum() that rounds once.
  static constexpr bool kRoundsOnce =
#if defined(__AVX512F__)
      W == 16 ||
#endif
#if defined(__FMA__)
      W == 8 ||
#endif
      false;
  /// a b + c with two roundings, or with one where that is one instruction: for values with a bound of their error,
  /// never for what must have the same bits everywhere. How many pairs a filter leaves to exact tests can depend on it;
  /// GRIDIRON_TWO_ROUNDINGS makes it the same on Arm as elsewhere.
  [[nodiscard]] static GRIDIRON_INLINE Float bounded_sum(Float a, Float b, Float c) {
#if defined(__AVX512F__)
    if constexpr (W == 16) return Float(FloatVector(_mm512_fmadd_ps(__m512(a.v), __m512(b.v), __m512(c.v))));
#endif
#if defined(__FMA__)
    if constexpr (W == 8) return Float(FloatVector(_mm256_fmadd_ps(__m256(a.v), __m256(b.v), __m256(c.v))));
#endif
#if defined(__ARM_NEON) && defined(__aarch64__) && !defined(GRIDIRON_TWO_ROUNDINGS)
    if constexpr (W == 4) return Float(FloatVector(vfmaq_f32(float32x4_t(c.v), float32x4_t(a.v), float32x4_t(b.v))));
#endif
    return a * b + c;
  }
  /// a b - c d, with one rounding less if bounded_sum() rounds once.
  [[nodiscard]] static GRIDIRON_INLINE Float bounded_difference(Float a, Float b, Float c, Float d) {
    if constexpr (kRoundsOnce) return bounded_sum(a, b, -(c * d));
    return a * b - c * d;
  }
  [[nodiscard]] static GRIDIRON_INLINE Float abs(Float a) {
    const IntVector magnitude = reinterpret_cast<IntVector>(a.v) & 0x7FFFFFFF;
    return Float(reinterpret_cast<FloatVector>(magnitude));
  }
  [[nodiscard]] static GRIDIRON_INLINE Double abs(Double a) {
    const LongVector magnitude = reinterpret_cast<LongVector>(a.v) & 0x7FFFFFFFFFFFFFFF;
    return Double(reinterpret_cast<DoubleVector>(magnitude));
  }
  /// The larger of two magnitudes. A NaN of one of them may be lost.
  [[nodiscard]] static GRIDIRON_INLINE Float larger_size(Float a, Float b) {
#if defined(__AVX512DQ__)
    if constexpr (W == 16) {
      constexpr int kLargerMagnitude = 3, kPositive = 2 << 2;
      return Float(FloatVector(_mm512_maskz_range_ps(static_cast<__mmask16>(kAllBits), __m512(a.v), __m512(b.v),
                                                     kLargerMagnitude | kPositive)));
    } else
#endif
      return max(abs(a), abs(b));
  }
  /// Square roots, correctly rounded.
  [[nodiscard]] static GRIDIRON_INLINE Float square_root(Float a) {
    for (int i = 0; i < W; ++i) a.v[i] = __builtin_sqrtf(a.v[i]);
    return a;
  }
  /// Lane i of the result is a[i] where mask[i], else b[i].
  [[nodiscard]] static GRIDIRON_INLINE Float select(Mask mask, Float a, Float b) {
#if defined(__AVX512F__)
    if constexpr (W == 16)
      return Float(FloatVector(_mm512_mask_blend_ps(mask.m, __m512(b.v), __m512(a.v))));
    else
#endif
      return Float(mask.v ? a.v : b.v);
  }
  [[nodiscard]] static GRIDIRON_INLINE Int select(Mask mask, Int a, Int b) {
    const Float chosen =
        select(mask, Float(reinterpret_cast<FloatVector>(a.v)), Float(reinterpret_cast<FloatVector>(b.v)));
    return {reinterpret_cast<IntVector>(chosen.v)};
  }
  /// The words so many bytes behind `base`, which are aligned to 4 bytes: of std::uint32_t or float.
  template <class Word>
  [[nodiscard]] static GRIDIRON_INLINE Int gather(const Word* base, Int bytes) {
    static_assert(sizeof(Word) == 4);
#if defined(__AVX512F__)
    if constexpr (W == 16) {
      return {IntVector(_mm512_mask_i32gather_epi32(_mm512_setzero_si512(), static_cast<__mmask16>(kAllBits),
                                                    __m512i(bytes.v), base, 1))};
    }
#endif
#if defined(__AVX2__)
    if constexpr (W == 8) {
      return {IntVector(_mm256_i32gather_epi32(reinterpret_cast<const int*>(base), __m256i(bytes.v), 1))};
    }
#endif
    Int result;
    for (int i = 0; i < W; ++i) result.v[i] = std::bit_cast<std::int32_t>(base[bytes.v[i] / 4]);
    return result;
  }
  /// Stores `value` in the lanes of the mask. @param target  W words, aligned to 4 * W bytes.
  static GRIDIRON_INLINE void store_where(Mask mask, std::uint32_t value, std::uint32_t* target) {
    *reinterpret_cast<IntMemory*>(target) = select(mask, Int::splat(value), Int::load(target)).v;
  }
  /// Stores each quad of lanes, aligned to 16 bytes, `stride` words behind the one before.
  static GRIDIRON_INLINE void store_quads(Int a, std::uint32_t* target, std::uint32_t stride) {
#if defined(__AVX512F__)
    if constexpr (W == 16) {
      // With masks, as the compiler warns of what is behind the plain ones.
      const __m512i v = __m512i(a.v);
      _mm_store_si128(reinterpret_cast<__m128i*>(target), _mm512_maskz_extracti32x4_epi32(0xFF, v, 0));
      _mm_store_si128(reinterpret_cast<__m128i*>(target + stride), _mm512_maskz_extracti32x4_epi32(0xFF, v, 1));
      _mm_store_si128(reinterpret_cast<__m128i*>(target + 2 * stride), _mm512_maskz_extracti32x4_epi32(0xFF, v, 2));
      _mm_store_si128(reinterpret_cast<__m128i*>(target + 3 * stride), _mm512_maskz_extracti32x4_epi32(0xFF, v, 3));
      return;
    }
#endif
    using Quad = typename LaneVectors<4>::IntMemory;
    const auto store = [&](int i, typename LaneVectors<4>::IntVector quad) GRIDIRON_INLINE_LAMBDA {
      *reinterpret_cast<Quad*>(target + static_cast<std::uint32_t>(i) * stride) = quad;
    };
    if constexpr (W == 4) {
      store(0, a.v);
    } else {
      store(0, __builtin_shufflevector(a.v, a.v, 0, 1, 2, 3));
      store(1, __builtin_shufflevector(a.v, a.v, 4, 5, 6, 7));
      if constexpr (W == 16) {
        store(2, __builtin_shufflevector(a.v, a.v, 8, 9, 10, 11));
        store(3, __builtin_shufflevector(a.v, a.v, 12, 13, 14, 15));
      }
    }
  }
  static GRIDIRON_INLINE void store_quads(Float a, float* target, std::uint32_t stride) {
    store_quads(Int{reinterpret_cast<IntVector>(a.v)}, reinterpret_cast<std::uint32_t*>(target), stride);
  }
  /// Lanes whose word is `value`. @param words  W words, aligned to 4 * W bytes.
  [[nodiscard]] static GRIDIRON_INLINE Mask equal(std::uint32_t value, const std::uint32_t* words) {
    const IntVector loaded = Int::load(words).v, wanted = Int::splat(value).v;
#if defined(__AVX512F__)
    if constexpr (W == 16)
      return {_mm512_cmpeq_epi32_mask(__m512i(loaded), __m512i(wanted))};
    else
#endif
      return {loaded == wanted};
  }
  /// Stores the lanes whose bit is set, in order. @param target  room for W words, aligned to 4 bytes; those behind
  /// the ones stored are undefined.
  static GRIDIRON_INLINE void compress(Int a, std::uint32_t bits, std::uint32_t* target) {
#if defined(__AVX512F__)
    if constexpr (W == 16) {
      _mm512_storeu_si512(target, _mm512_maskz_compress_epi32(static_cast<__mmask16>(bits), __m512i(a.v)));
      return;
    }
#endif
#if defined(__AVX2__) && defined(__BMI2__)
    if constexpr (W == 8) {
      // The numbers of the lanes that stay, a byte each.
      const std::uint64_t stay = _pdep_u64(bits, 0x0101010101010101u) * 0xFFu;
      const std::uint64_t numbers = _pext_u64(0x0706050403020100u, stay);
      const __m256i places = _mm256_cvtepu8_epi32(_mm_cvtsi64_si128(static_cast<long long>(numbers)));
      _mm256_storeu_si256(reinterpret_cast<__m256i*>(target), _mm256_permutevar8x32_epi32(__m256i(a.v), places));
      return;
    }
#endif
#if defined(__ARM_NEON) || defined(__SSSE3__)
    if constexpr (W == 4) {
      // Bytes of the words that stay, by bits.
      static constexpr auto kPatterns = [] {
        struct {
          std::uint8_t bytes[16][16];
        } patterns{};
        for (std::uint32_t set = 0; set < 16; ++set) {
          std::uint32_t words = 0;
          for (std::uint32_t word = 0; word < 4; ++word) {
            if ((set >> word & 1u) == 0) continue;
            for (std::uint32_t byte = 0; byte < 4; ++byte) {
              patterns.bytes[set][4 * words + byte] = static_cast<std::uint8_t>(4 * word + byte);
            }
            ++words;
          }
        }
        return patterns;
      }();
      const std::uint8_t* const pattern = kPatterns.bytes[bits];
#if defined(__ARM_NEON)
      vst1q_u8(reinterpret_cast<std::uint8_t*>(target), vqtbl1q_u8(uint8x16_t(a.v), vld1q_u8(pattern)));
#else
      const __m128i loaded = _mm_loadu_si128(reinterpret_cast<const __m128i*>(pattern));
      _mm_storeu_si128(reinterpret_cast<__m128i*>(target), _mm_shuffle_epi8(__m128i(a.v), loaded));
#endif
      return;
    }
#endif
    std::uint32_t count = 0;
    for (int i = 0; i < W; ++i) {
      target[count] = static_cast<std::uint32_t>(a.v[i]);
      count += bits >> i & 1u;
    }
  }
  /// Which lanes go behind `count` words that are there: bit i for lane i. Precondition: count < W.
  struct Packing {
    std::uint32_t bits, count;
  };
  /// Puts lanes behind words, in order. @param target  room for 2 W words, aligned to 4 W bytes; those behind the last
  /// are undefined.
  static GRIDIRON_INLINE void append(const Packing& packing, Int a, std::uint32_t* target) {
    compress(a, packing.bits, target + packing.count);
  }
  /// Copies 16 bytes. @tparam Quad  of this size and alignment.
  template <class Quad>
  static GRIDIRON_INLINE void copy_quad(const Quad& source, Quad& target) {
    static_assert(sizeof(Quad) == 16);
    target = source;
  }
  /// Bit i is the sign of lane i.
  [[nodiscard]] static GRIDIRON_INLINE std::uint32_t sign_bits(Int a) {
#if defined(__AVX2__)
    if constexpr (W == 8) return static_cast<std::uint32_t>(_mm256_movemask_ps(reinterpret_cast<__m256>(a.v)));
#endif
#if defined(__SSE2__)
    if constexpr (W == 4) return static_cast<std::uint32_t>(_mm_movemask_ps(reinterpret_cast<__m128>(a.v)));
#endif
    return (a < Int::splat(0)).bits();
  }
  /// Mask with lane i set where bit i is.
  [[nodiscard]] static GRIDIRON_INLINE Mask mask_from_bits(std::uint32_t bits) {
#if defined(__AVX512F__)
    if constexpr (W == 16) {
      return {static_cast<__mmask16>(bits)};
    } else
#endif
    {
      IntVector lane_bit;
      for (int i = 0; i < W; ++i) lane_bit[i] = 1 << i;
      return {(lane_bit & static_cast<std::int32_t>(bits)) != 0};
    }
  }
  /// Bit i = the sign of lane i, W / 2 lanes.
  [[nodiscard]] static GRIDIRON_INLINE std::uint32_t half_bits(Long a) {
    const LongVector v = a.v;
#if defined(__AVX512DQ__)
    if constexpr (W == 16) return _mm512_movepi64_mask(__m512i(v));
#endif
#if defined(__AVX2__)
    if constexpr (W == 8) return static_cast<std::uint32_t>(_mm256_movemask_pd(reinterpret_cast<__m256d>(v)));
#endif
#if defined(__SSE2__)
    if constexpr (W == 4) return static_cast<std::uint32_t>(_mm_movemask_pd(reinterpret_cast<__m128d>(v)));
#endif
    std::uint32_t result = 0;
    for (int i = 0; i < W / 2; ++i) {
      const std::int64_t lane = v[i];
      result |= (lane < 0 ? 1u : 0u) << i;
    }
    return result;
  }
  /// W whole numbers of 16 bits. @param source  W of them, aligned to 2 * W bytes.
  [[nodiscard]] static GRIDIRON_INLINE Float load_halves(const std::uint16_t* source) {
    using Halves = typename LaneVectors<W>::HalvesMemory;
    return Float(__builtin_convertvector(*reinterpret_cast<const Halves*>(source), FloatVector));
  }
  /// Reciprocals with a relative error below 2^-12 if they are normal; the same bits on every target.
  ///
  /// The complement of the bit pattern is linear between powers of two and within e0 = 0.0506 of 1 / a. With r this
  /// first value and e = 1 - |a| r, |e| <= e0, the error of r (1 + e + e^2) is e0^3 < 2^-12.9. If a is not normal, or
  /// above 2^125, the result is arbitrary.
  [[nodiscard]] static GRIDIRON_INLINE Float reciprocal_estimate(Float a) {
    const IntVector bits = reinterpret_cast<IntVector>(a.v);
    const IntVector sign = bits & static_cast<std::int32_t>(0x80000000u);
    const IntVector pattern = 0x7EF311C7 - (bits & 0x7FFFFFFF);
    const Float size = abs(a);
    const Float first(reinterpret_cast<FloatVector>(pattern));
    const Float error = Float(1.0f) - size * first;
    const Float better = first + first * (error + error * error);
    return Float(reinterpret_cast<FloatVector>(reinterpret_cast<IntVector>(better.v) | sign));
  }
  /// W / 4 quads of lanes, each loaded from four floats at sources[quad], aligned to 16 bytes.
  [[nodiscard]] static GRIDIRON_INLINE Float load_quads(const float* const* sources) {
    using Quad = typename LaneVectors<4>::FloatMemory;
    const auto quad = [&](int i) { return LaneVectors<4>::FloatVector(*reinterpret_cast<const Quad*>(sources[i])); };
    if constexpr (W == 4) {
      return Float(quad(0));
    } else {
#if defined(__AVX512F__)
      // Insertions from memory: no shuffles.
      if constexpr (W == 16) {
        __m512 all = _mm512_castps128_ps512(__m128(quad(0)));
        all = _mm512_insertf32x4(all, __m128(quad(1)), 1);
        all = _mm512_insertf32x4(all, __m128(quad(2)), 2);
        return Float(FloatVector(_mm512_insertf32x4(all, __m128(quad(3)), 3)));
      }
#endif
      const auto low = __builtin_shufflevector(quad(0), quad(1), 0, 1, 2, 3, 4, 5, 6, 7);
      if constexpr (W == 8) {
        return Float(low);
      } else {
        const auto high = __builtin_shufflevector(quad(2), quad(3), 0, 1, 2, 3, 4, 5, 6, 7);
        return Float(__builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15));
      }
    }
  }
  /// Four floats in every quad of lanes. @param source  aligned to 16 bytes.
  [[nodiscard]] static GRIDIRON_INLINE Float repeat_quad(const float* source) {
    static constexpr unsigned kQuads = W / 4;
    const float* sources[kQuads];
    for (const float*& quad : sources) quad = source;
    return load_quads(sources);
  }
  /// Quad i of lanes is source[i].
  [[nodiscard]] static GRIDIRON_INLINE Float splat_quads(const float* source) {
    Float result(source[0]);
    if constexpr (W >= 8) {
      for (int i = 4; i < W; ++i) result.v[i] = source[i / 4];
    }
    return result;
  }
  /// Rearranges each quad of lanes alike: indices 0..3 pick from a's quad, 4..7 from b's.
  template <int I0, int I1, int I2, int I3>
  [[nodiscard]] static GRIDIRON_INLINE Float shuffle_quads(Float a, Float b) {
    constexpr auto at = [](int quad, int i) { return i < 4 ? 4 * quad + i : W + 4 * quad + i - 4; };
    if constexpr (W == 4) {
      return Float(__builtin_shufflevector(a.v, b.v, I0, I1, I2, I3));
    } else if constexpr (W == 8) {
      return Float(__builtin_shufflevector(a.v, b.v, at(0, I0), at(0, I1), at(0, I2), at(0, I3), at(1, I0), at(1, I1),
                                           at(1, I2), at(1, I3)));
    } else {
      return Float(__builtin_shufflevector(a.v, b.v, at(0, I0), at(0, I1), at(0, I2), at(0, I3), at(1, I0), at(1, I1),
                                           at(1, I2), at(1, I3), at(2, I0), at(2, I1), at(2, I2), at(2, I3), at(3, I0),
                                           at(3, I1), at(3, I2), at(3, I3)));
    }
  }
  template <int I0, int I1, int I2, int I3>
  [[nodiscard]] static GRIDIRON_INLINE Float shuffle_quads(Float a) {
    return shuffle_quads<I0, I1, I2, I3>(a, a);
  }
  /// a with its sign flipped in the lanes of the mask.
  [[nodiscard]] static GRIDIRON_INLINE Float flip_sign(Mask mask, Float a) {
    return select(mask, -a, a);
  }
  /// a with its sign flipped in the lanes where `by` is negative, -0 included.
  [[nodiscard]] static GRIDIRON_INLINE Float turn_by(Float by, Float a) {
    const IntVector sign = reinterpret_cast<IntVector>(by.v) & static_cast<std::int32_t>(0x80000000u);
    return Float(reinterpret_cast<FloatVector>(reinterpret_cast<IntVector>(a.v) ^ sign));
  }
  /// Largest lane, smallest lane: halves against each other, four times for 16 lanes.
  [[nodiscard]] static GRIDIRON_INLINE float horizontal_max(Float a) {
    if constexpr (W == 16) a = max(a, swap_lanes<8>(a));
    if constexpr (W >= 8) a = max(a, swap_lanes<4>(a));
    a = max(a, swap_lanes<2>(a));
    return max(a, swap_lanes<1>(a)).v[0];
  }
  [[nodiscard]] static GRIDIRON_INLINE float horizontal_min(Float a) {
    if constexpr (W == 16) a = min(a, swap_lanes<8>(a));
    if constexpr (W >= 8) a = min(a, swap_lanes<4>(a));
    a = min(a, swap_lanes<2>(a));
    return min(a, swap_lanes<1>(a)).v[0];
  }
  /// Lane i of the result is lane i ^ Distance of a.
  template <int Distance>
  [[nodiscard]] static GRIDIRON_INLINE Float swap_lanes(Float a) {
    constexpr int d = Distance;
    if constexpr (W == 4) {
      return Float(__builtin_shufflevector(a.v, a.v, 0 ^ d, 1 ^ d, 2 ^ d, 3 ^ d));
    } else if constexpr (W == 8) {
      return Float(__builtin_shufflevector(a.v, a.v, 0 ^ d, 1 ^ d, 2 ^ d, 3 ^ d, 4 ^ d, 5 ^ d, 6 ^ d, 7 ^ d));
    } else {
      return Float(__builtin_shufflevector(a.v, a.v, 0 ^ d, 1 ^ d, 2 ^ d, 3 ^ d, 4 ^ d, 5 ^ d, 6 ^ d, 7 ^ d, 8 ^ d,
                                           9 ^ d, 10 ^ d, 11 ^ d, 12 ^ d, 13 ^ d, 14 ^ d, 15 ^ d));
    }
  }
};

/// Square root, correctly rounded as IEEE requires; the compiler's instruction, never a library call.
[[nodiscard]] GRIDIRON_INLINE float square_root(float value) {
  return __builtin_sqrtf(value);
}
[[nodiscard]] GRIDIRON_INLINE double square_root(double value) {
  return __builtin_sqrt(value);
}

/// |value|: clears the sign bit, no branch, no library call.
[[nodiscard]] GRIDIRON_INLINE float magnitude(float value) {
  return __builtin_fabsf(value);
}
[[nodiscard]] GRIDIRON_INLINE double magnitude(double value) {
  return __builtin_fabs(value);
}

/// Position of the lowest set bit. Precondition: there is one.
[[nodiscard]] GRIDIRON_INLINE std::uint32_t lowest_bit(std::uint32_t bits) {
  return static_cast<std::uint32_t>(__builtin_ctz(bits));
}
[[nodiscard]] GRIDIRON_INLINE std::uint32_t lowest_bit(std::uint64_t bits) {
  return static_cast<std::uint32_t>(__builtin_ctzll(bits));
}

/// Writes `value` to all of `target`.
template <class Word, std::uint32_t Count>
GRIDIRON_INLINE void fill_words(Word (&target)[Count], Word value) {
  for (Word& word : target) word = value;
}

/// Number of set bits.
[[nodiscard]] GRIDIRON_INLINE std::uint32_t count_bits(std::uint32_t bits) {
#if defined(__POPCNT__)
  return static_cast<std::uint32_t>(__builtin_popcount(bits));
#else
  bits -= (bits >> 1) & 0x55555555u;
  bits = (bits & 0x33333333u) + ((bits >> 2) & 0x33333333u);
  return (((bits + (bits >> 4)) & 0x0F0F0F0Fu) * 0x01010101u) >> 24;
#endif
}

}  // namespace gridiron
