// Decimal parsing against the C library's, which rounds correctly, and against hand-made corner cases.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/io/decimal.h>

#include "support/test_headers.h"

namespace gridiron {
namespace {

std::string hex(std::uint32_t bits) {
  char text[16];
  std::snprintf(text, sizeof text, "%08x", bits);
  return text;
}

// Compares with strtof; true where equal, so that loops can count and stop.
::testing::AssertionResult agrees(const std::string& text) {
  const float wanted = std::strtof(text.c_str(), nullptr);
  std::uint32_t bits = 0x12345678u;
  const DecimalStatus status = parse_float(text.data(), text.size(), bits);
  if (std::isinf(wanted)) {
    if (status == DecimalStatus::kNotFinite && bits == 0x12345678u) return ::testing::AssertionSuccess();
    return ::testing::AssertionFailure() << text << ": expected kNotFinite, got " << hex(bits);
  }
  if (status == DecimalStatus::kOk && bits == std::bit_cast<std::uint32_t>(wanted)) {
    return ::testing::AssertionSuccess();
  }
  return ::testing::AssertionFailure() << text << ": status " << static_cast<int>(status) << ", " << hex(bits)
                                       << " instead of " << hex(std::bit_cast<std::uint32_t>(wanted));
}

std::string exact(double value) {
  char text[400];
  std::snprintf(text, sizeof text, "%.170g", value);  // every digit of a double with at most 25 bits
  return text;
}

double middle_above(std::uint32_t float_bits) {
  const float low = std::bit_cast<float>(float_bits);
  if (float_bits == 0x7F7FFFFFu) return 0x1.FFFFFFp127;
  const float high = std::bit_cast<float>(float_bits + 1);
  return (static_cast<double>(low) + static_cast<double>(high)) / 2;
}

constexpr std::uint32_t kSeed = 20240607;

class Random {
 public:
  explicit Random(std::uint32_t seed) : generator_(seed) {}
  std::uint32_t operator()() { return static_cast<std::uint32_t>(generator_()); }

 private:
  std::mt19937 generator_;
};

TEST(Decimal, RandomFloatsInEveryUsualSpelling) {
  Random generator(kSeed);
  const char* const formats[] = {"%.9g", "%.6g", "%.7f", "%.8e", "%.17g", "%+.12E", "%.3f"};
  for (int i = 0; i < 300000; ++i) {
    const float value = std::bit_cast<float>(generator() & 0xFF7FFFFFu);  // never infinite
    char text[128];
    std::snprintf(text, sizeof text, formats[i % 7], static_cast<double>(value));
    ASSERT_TRUE(agrees(text)) << "case " << i;
  }
}

TEST(Decimal, RandomDigitsAndExponents) {
  Random generator(kSeed + 1);
  for (int i = 0; i < 300000; ++i) {
    std::string text = (generator() & 1) != 0 ? "-" : "";
    const std::uint32_t digits = 1 + generator() % (i % 10 == 0 ? 99 : 22);
    const std::uint32_t point = generator() % (digits + 1);
    for (std::uint32_t d = 0; d < digits; ++d) {
      if (d == point) text += '.';
      text += static_cast<char>('0' + generator() % 10);
    }
    if (generator() % 4 != 0) text.append("e").append(std::to_string(static_cast<int>(generator() % 110) - 60));
    ASSERT_TRUE(agrees(text)) << "case " << i;
  }
}

TEST(Decimal, MiddlesBetweenFloatsAndTheirNeighbours) {
  Random generator(kSeed + 2);
  for (int i = 0; i < 100000; ++i) {
    // Every fourth among the denormals, every eighth at the top.
    std::uint32_t bits = generator() & 0x7F7FFFFFu;
    if (i % 4 == 0) bits &= 0x00FFFFFFu;
    if (i % 8 == 1) bits |= 0x7F000000u;
    if (bits > 0x7F7FFFFFu) bits = 0x7F7FFFFFu;
    const double middle = middle_above(bits);
    const std::string text = exact(middle);
    ASSERT_TRUE(agrees(text)) << "case " << i;
    // A hair above: one more digit far behind the last. A hair below: the last digit one less.
    const std::size_t e = text.find('e');
    std::string above = text;
    const std::string tail = text.find('.') == std::string::npos ? ".0000000001" : "0000000001";
    above.insert(e == std::string::npos ? text.size() : e, tail);
    ASSERT_TRUE(agrees(above)) << "case " << i;
    std::string below = text;
    char& last = below[(e == std::string::npos ? text.size() : e) - 1];
    if (last >= '1' && last <= '9') {
      --last;
      ASSERT_TRUE(agrees(below)) << "case " << i;
    }
    // Doubles next to the middle, printed with 17 digits.
    for (const double near : {std::nextafter(middle, 0.0), std::nextafter(middle, 1e300)}) {
      char seventeen[64];
      std::snprintf(seventeen, sizeof seventeen, "%.17g", near);
      ASSERT_TRUE(agrees(seventeen)) << "case " << i;
    }
  }
}

TEST(Decimal, CornerCases) {
  const std::string nines(99, '9');
  const std::string zeros(200, '0');
  std::vector<std::string> texts = {nines,
                                    "0." + nines,
                                    nines + "e-99",
                                    nines + "e-140",
                                    nines + "e-60",
                                    "0." + zeros + "1e201",
                                    "1" + zeros + "e-200",
                                    "1" + zeros,
                                    "." + zeros + "123456789e200"};
  std::istringstream more(
      "0 -0 +0 1. .5 +.5e+1 1e5 1E+05 -1E-05 00012.50 1e400 -1e400 1e-400 0e400 0e99999999999999999999 "
      "1e99999999999999999999 1e-99999999999999999999 3.4028234663852886e38 3.4028235677973366e38 "
      "3.4028235677973367e38 1.17549435e-38 1.1754943508222874e-38 1.1754942807573643e-38 1.40129846432481707e-45 "
      "7.0064923216240853e-46 7.0064923216240854e-46 7.0064923216240862e-46 1e-46 16777217 16777219 "
      "9007199254740993 18446744073709551615 18446744073709551616 1e39 1e44 1e-44 1e45 12345e-45");
  for (std::string text; more >> text;) texts.push_back(text);
  for (const std::string& text : texts) EXPECT_TRUE(agrees(text));
}

TEST(Decimal, RefusesWhatIsNoNumber) {
  for (const std::string text :
       {"",      "+",     "-",    ".",     "e5",  ".e5",     "1e",   "1e+",     "1e-", "1.2.3",
        "1,5",   "0x10",  "1f",   "--1",   "+-1", "1 ",      " 1",   "1e5.5",   "abc", "comment",
        "1e5e5", "1_000", "nanx", "infin", "in",  "infinit", "nan(", "1.#QNAN", "1-",  "\x31\xB2"}) {
    std::uint32_t bits = 7;
    EXPECT_EQ(parse_float(text.data(), text.size(), bits), DecimalStatus::kSyntax) << text;
    EXPECT_EQ(bits, 7u) << text;
    EXPECT_FALSE(is_number(text.data(), text.size())) << text;
  }
  const std::string with_nul("1\0", 2);
  std::uint32_t bits = 0;
  EXPECT_EQ(parse_float(with_nul.data(), with_nul.size(), bits), DecimalStatus::kSyntax);
  const std::string too_long(kMaxDecimalBytes + 1, '0');
  EXPECT_EQ(parse_float(too_long.data(), too_long.size(), bits), DecimalStatus::kSyntax);
  const std::string long_enough(kMaxDecimalBytes, '9');
  EXPECT_EQ(parse_float(long_enough.data(), long_enough.size(), bits), DecimalStatus::kNotFinite);
  const std::string longest_fraction = "." + std::string(kMaxDecimalBytes - 1, '9');
  EXPECT_TRUE(agrees(longest_fraction));
  EXPECT_TRUE(agrees("." + std::string(40, '0') + std::string(kMaxDecimalBytes - 41, '7')));
}

TEST(Decimal, NamesOfTheNonFinite) {
  for (const std::string text :
       {"nan", "NaN", "-nan", "+NAN", "nan(ind)", "-nan(snan)", "inf", "-Inf", "+INF", "infinity", "-INFINITY"}) {
    std::uint32_t bits = 7;
    EXPECT_EQ(parse_float(text.data(), text.size(), bits), DecimalStatus::kNotFinite) << text;
    EXPECT_EQ(bits, 7u);
    EXPECT_TRUE(is_number(text.data(), text.size())) << text;
  }
}

TEST(Decimal, Integers) {
  const auto parsed = [](const std::string& text) {
    std::int64_t value = -99;
    const DecimalStatus status = parse_integer(text.data(), text.size(), value);
    return std::pair(status, value);
  };
  using P = std::pair<DecimalStatus, std::int64_t>;
  EXPECT_EQ(parsed("0"), P(DecimalStatus::kOk, 0));
  EXPECT_EQ(parsed("-0"), P(DecimalStatus::kOk, 0));
  EXPECT_EQ(parsed("+12"), P(DecimalStatus::kOk, 12));
  EXPECT_EQ(parsed("-007"), P(DecimalStatus::kOk, -7));
  EXPECT_EQ(parsed("9223372036854775807"), P(DecimalStatus::kOk, INT64_MAX));
  EXPECT_EQ(parsed("-9223372036854775808"), P(DecimalStatus::kOk, INT64_MIN));
  EXPECT_EQ(parsed("9223372036854775808"), P(DecimalStatus::kRange, -99));
  EXPECT_EQ(parsed("-9223372036854775809"), P(DecimalStatus::kRange, -99));
  EXPECT_EQ(parsed("99999999999999999999999"), P(DecimalStatus::kRange, -99));
  for (const char* text : {"", "+", "-", "1.0", "1e3", "a", "1 ", "99999999999999999999x", "nan"}) {
    EXPECT_EQ(parsed(text), P(DecimalStatus::kSyntax, -99)) << text;
  }
}

TEST(Decimal, DoublesRoundToFloatsAsTheHardwareRounds) {
  std::mt19937_64 generator(kSeed);
  for (int i = 0; i < 300000; ++i) {
    std::uint64_t bits = generator();
    if (i % 3 == 1) {  // near the middle of two floats, denormals among them
      const std::uint32_t low = static_cast<std::uint32_t>(generator()) % (i % 2 == 0 ? 0x00800000u : 0x7F800000u);
      bits = std::bit_cast<std::uint64_t>(middle_above(low)) + generator() % 3 - 1;
    }
    if (i % 3 == 2) bits = (bits & 0x800FFFFFFFFFFFFFu) | ((0x369 + bits % 0x120) << 52);  // the floats' exponents
    const double value = std::bit_cast<double>(bits);
    const std::uint32_t got = float_bits_from_double_bits(bits);
    if (std::isnan(value)) {
      ASSERT_TRUE(std::isnan(std::bit_cast<float>(got))) << "case " << i;
    } else {
      ASSERT_EQ(got, std::bit_cast<std::uint32_t>(static_cast<float>(value))) << exact(value) << " case " << i;
    }
  }
}

}  // namespace
}  // namespace gridiron
