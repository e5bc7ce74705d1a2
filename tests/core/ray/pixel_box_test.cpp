// Pixel boxes: no ray beside a triangle's box hits it, boxes are hardly larger than what the triangle covers, and what
// they say in subpackets and rows is what their pixels say.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/ray/camera.h>
#include <gridiron/ray/pixel_box.h>

#include <glm/geometric.hpp>

#include "core/lane_types.h"
#include "core/ray/frame_cases.h"
#include "core/ray/packet_cases.h"
#include "core/seeds.h"
#include "support/test_mesh.h"

namespace gridiron::test {
namespace {

// A point that a packet sees at a place of its pixels, as far as floats have it.
template <class PacketType>
Vec3 point_at(const PacketType& packet, double depth, double column, double row) {
  Vec3 point;
  for (int axis = 0; axis < 3; ++axis) {
    const double along =
        double{packet.first_dir[axis]} + column * double{packet.step_x[axis]} + row * double{packet.step_y[axis]};
    point[axis] = static_cast<float>(double{packet.origin[axis]} + depth * along);
  }
  return point;
}

// A column or row of pixels: anywhere, on a pixel's centre, or off it by as little as its last digits.
double random_place(TestRandom& random, std::uint32_t width) {
  const double anywhere = double{random.between(-2.0f, static_cast<float>(width + 2))};
  if (random.below(2) == 0) return anywhere;
  const double off =
      random.below(2) == 0 ? 0.0 : std::ldexp(double{random.between(-1, 1)}, -4 - static_cast<int>(random.below(20)));
  return std::floor(anywhere) + off;
}

template <class PacketType>
VertexTriangle make_triangle(TestRandom& random, const PacketType& packet) {
  constexpr std::uint32_t kWidth = PacketType::kWidth;
  const double center[2] = {random_place(random, kWidth), random_place(random, kWidth)};
  const double size = std::ldexp(double{random.between(1, 2)}, static_cast<int>(random.below(12)) - 5);
  const std::uint32_t shape = random.below(9);
  const std::uint32_t far_axis = random.below(2);
  const double far = std::ldexp(1.0, 16 + static_cast<int>(random.below(10)));
  const double depth = random.below(4) == 0 ? std::ldexp(1.0, static_cast<int>(random.below(60)) - 30)
                                            : double{random.between(0.5f, 8.0f)};
  Vec3 corners[3];
  double first_place[2] = {center[0], center[1]};
  for (int i = 0; i < 3; ++i) {
    double place[2];
    for (int axis = 0; axis < 2; ++axis) {
      place[axis] = center[axis] + size * double{random.between(-1, 1)};
      if (shape == 0) place[axis] = random_place(random, kWidth);               // on centres, near them
      if (shape == 1 && i != 0 && axis == 1) place[axis] = first_place[axis];   // along a row
      if (shape == 2 && i != 0 && axis == 0) place[axis] = first_place[axis];   // along a column
      if (shape == 3 && i == 2) place[axis] = first_place[axis] + 1e-4 * size;  // a sliver
      if (i == 0) first_place[axis] = place[axis];
    }
    double at = depth;
    if (random.below(2) == 0) at *= double{random.between(0.9f, 1.1f)};
    if (shape == 4) at *= double{random.between(-1, 1)};  // some behind the eye
    if (shape == 8 && i != 0) {  // across the picture between two points as good as in the eye's plane
      at /= far;
      place[far_axis] += (i == 1 ? far : -far) * double{random.between(1, 2)};
    }
    if (shape == 5) at *= std::ldexp(1.0, static_cast<int>(random.below(40)) - 20);  // seen almost edge-on
    corners[i] = point_at(packet, at, place[0], place[1]);
  }
  const Vec3 eye = vec_of(packet.origin);
  if (shape == 6 && random.below(2) == 0) corners[random.below(3)] = eye;
  if (shape == 7 && random.below(2) == 0) {  // around the eye, up to the largest coordinates
    const float reach = std::ldexp(1.0f, static_cast<int>(random.below(150)) - 30);
    for (Vec3& corner : corners) corner = eye + random_vec(random, reach);
  }
  return vertex_triangle(corners[0], corners[1], corners[2], 3);
}

// Whether a ray hits a triangle in exact arithmetic. A wide float says so for those that pass far beside it.
bool truly_hits(const float origin[3], const float direction[3], const VertexTriangle& triangle) {
  bool positive = false, negative = false;
  for (int edge = 0; edge < 3; ++edge) {
    long double a[3], b[3], value = 0.0L, size = 0.0L;
    for (int axis = 0; axis < 3; ++axis) {
      a[axis] = static_cast<long double>(triangle.v[edge][axis]) - static_cast<long double>(origin[axis]);
      b[axis] = static_cast<long double>(triangle.v[(edge + 1) % 3][axis]) - static_cast<long double>(origin[axis]);
    }
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      const auto d = static_cast<long double>(direction[i]);
      value += d * (a[j] * b[k] - a[k] * b[j]);
      size += std::fabs(d) * (std::fabs(a[j] * b[k]) + std::fabs(a[k] * b[j]));
    }
    const bool is_sure = std::fabs(value) > 0x1p-50L * size;
    positive = positive || (is_sure && value > 0.0L);
    negative = negative || (is_sure && value < 0.0L);
  }
  if (positive && negative) return false;
  return true_distance(origin, direction, triangle) > 0.0f;
}

template <class L>
class PixelBoxTest : public testing::Test {};
TYPED_TEST_SUITE(PixelBoxTest, LaneTypes, LaneNames);

// A packet of a frame, somewhere in the picture, and as many triangles as there are lanes.
template <class L, class PacketType>
struct BoxCase {
  std::unique_ptr<PacketType> packet = std::make_unique<PacketType>();
  alignas(16) VertexTriangle triangles[L::kCount];
  PixelBoxes<L> boxes;

  BoxCase(TestRandom& random, FrameKind kind) {
    const FrameRecord frame = make_frame(random, kind);
    RaySet<PacketType::kRayCount> present;
    WorkCounters work;
    const std::uint32_t places = kind <= FrameKind::kExact || random.below(2) == 0 ? 512 : frame.width;
    const std::uint32_t left = PacketType::kWidth * random.below(places / PacketType::kWidth);
    const std::uint32_t top = PacketType::kWidth * random.below(places / PacketType::kWidth);
    generate_packet<L>(frame, left, top, *packet, present, work);
  }
  void find_boxes() {
    const VertexTriangle* pointers[L::kCount];
    for (int i = 0; i < L::kCount; ++i) pointers[i] = &triangles[i];
    find_pixel_boxes<L>(*packet, pointers, boxes);
  }
  [[nodiscard]] bool covers(int i, std::uint32_t column, std::uint32_t row) const {
    return (boxes.covering >> i & 1u) != 0 && column >= boxes.first_column[i] && column < boxes.end_column[i] &&
           row >= boxes.first_row[i] && row < boxes.end_row[i];
  }
};

template <class L, class PacketType>
void expect_no_hit_beside_boxes(FrameKind kind) {
  constexpr std::uint64_t kSeeds = 200;
  std::uint64_t at_rim = 0;    // triangles that a ray in the outermost pixels of their box hits
  std::uint64_t rays_out = 0;  // rays beside boxes
  for_each_seed(kSeeds, [&](std::uint64_t seed) {
    TestRandom random(seed * 64 + static_cast<std::uint64_t>(kind));
    BoxCase<L, PacketType> shown(random, kind);
    const PacketType& packet = *shown.packet;
    for (VertexTriangle& triangle : shown.triangles) triangle = make_triangle(random, packet);
    shown.find_boxes();
    for (int i = 0; i < L::kCount; ++i) {
      bool is_rim_hit = false;
      for (std::uint32_t ray = 0; ray < PacketType::kRayCount; ++ray) {
        const std::uint32_t column = PacketType::column_of(ray), row = PacketType::row_of(ray);
        const bool inside = shown.covers(i, column, row);
        rays_out += inside ? 0u : 1u;
        const bool rim = inside && (column == shown.boxes.first_column[i] || column + 1 == shown.boxes.end_column[i] ||
                                    row == shown.boxes.first_row[i] || row + 1 == shown.boxes.end_row[i]);
        if (inside && (!rim || is_rim_hit)) continue;
        if (!truly_hits(packet.origin, direction_of(packet, ray).data(), shown.triangles[i])) continue;
        ASSERT_TRUE(inside) << "kind " << static_cast<int>(kind) << ", triangle " << i << ": pixel " << column << ", "
                            << row << " beside columns " << shown.boxes.first_column[i] << " to "
                            << shown.boxes.end_column[i] << ", rows " << shown.boxes.first_row[i] << " to "
                            << shown.boxes.end_row[i] << ", covering " << (shown.boxes.covering >> i & 1u);
        is_rim_hit = true;
      }
      at_rim += is_rim_hit ? 1u : 0u;
    }
  });
  if (!all_seeds_run() || testing::Test::HasFailure()) return;
  const std::uint64_t triangles = kSeeds * L::kCount;
  EXPECT_GT(at_rim, triangles / 6) << "kind " << static_cast<int>(kind);
  if (kind == FrameKind::kDegenerate) {
    EXPECT_EQ(rays_out, 0u) << "there is no picture, but somebody knows where triangles are in it";
  } else {
    EXPECT_GT(rays_out, triangles * PacketType::kRayCount / 10) << "kind " << static_cast<int>(kind);
  }
}

TYPED_TEST(PixelBoxTest, NoRayBesideABoxHits) {
  for (std::uint32_t kind = 0; kind < static_cast<std::uint32_t>(FrameKind::kCount); ++kind) {
    expect_no_hit_beside_boxes<TypeParam, Packet<16>>(static_cast<FrameKind>(kind));
    expect_no_hit_beside_boxes<TypeParam, Packet<32>>(static_cast<FrameKind>(kind));
  }
}

// Columns, or rows, from `first` to before `end`.
struct PixelRange {
  double first, end;
};

// The pixels between two places of the picture, as many as there are on either side.
PixelRange clipped(double low, double high, std::uint32_t width) {
  const auto clip = [width](double value) {
    return std::fmin(std::fmax(value, 0.0), double{static_cast<double>(width)});
  };
  return {clip(low), clip(high)};
}

// Where doubles see the three vertices: columns or rows from the least to the greatest. In front of the eye.
template <class PacketType>
void true_places(const PacketType& packet, const VertexTriangle& triangle, double least[2], double greatest[2]) {
  DVec3 f, x, y;
  for (int axis = 0; axis < 3; ++axis) {
    f[axis] = packet.first_dir[axis];
    x[axis] = packet.step_x[axis];
    y[axis] = packet.step_y[axis];
  }
  const DVec3 rows[3] = {glm::cross(x, y), glm::cross(y, f), glm::cross(f, x)};
  least[0] = least[1] = std::numeric_limits<double>::infinity();
  greatest[0] = greatest[1] = -least[0];
  for (const auto& vertex : triangle.v) {
    DVec3 a;
    for (int axis = 0; axis < 3; ++axis) a[axis] = double{vertex[axis]} - double{packet.origin[axis]};
    for (int i = 0; i < 2; ++i) {
      const double place = glm::dot(rows[i + 1], a) / glm::dot(rows[0], a);
      least[i] = std::fmin(least[i], place);
      greatest[i] = std::fmax(greatest[i], place);
    }
  }
}

template <class L, class PacketType>
void expect_tight_boxes() {
  constexpr auto kWidth = PacketType::kWidth;
  std::uint64_t small_count = 0, beside_centers = 0, left_out = 0, in_packet = 0;
  std::uint64_t exact = 0, bounds = 0;
  for_each_seed(600, [&](std::uint64_t seed) {
    TestRandom random(seed);
    BoxCase<L, PacketType> shown(random, seed % 2 == 0 ? FrameKind::kOrdinary : FrameKind::kExact);
    const PacketType& packet = *shown.packet;
    ASSERT_LT(packet.projection.margin, 0.25f);
    for (VertexTriangle& triangle : shown.triangles) {
      const double center[2] = {random_place(random, kWidth), random_place(random, kWidth)};
      const double size = random.below(2) == 0 ? 0.5 : std::ldexp(1.0, static_cast<int>(random.below(7)));
      Vec3 corners[3];
      for (Vec3& corner : corners) {
        const double depth = double{random.between(1.0f, 1.5f)};
        const double column = center[0] + 0.5 * size * double{random.between(-1, 1)};
        corner = point_at(packet, depth, column, center[1] + 0.5 * size * double{random.between(-1, 1)});
      }
      triangle = vertex_triangle(corners[0], corners[1], corners[2], 3);
    }
    shown.find_boxes();
    for (int i = 0; i < L::kCount; ++i) {
      double least[2], greatest[2];
      true_places(packet, shown.triangles[i], least, greatest);
      const bool is_covering = (shown.boxes.covering >> i & 1u) != 0;
      const std::uint32_t first[2] = {shown.boxes.first_column[i], shown.boxes.first_row[i]};
      const std::uint32_t end[2] = {shown.boxes.end_column[i], shown.boxes.end_row[i]};
      bool meets_centers = true;
      for (int axis = 0; axis < 2; ++axis) {
        const PixelRange truth = clipped(std::ceil(least[axis]), std::floor(greatest[axis]) + 1.0, kWidth);
        meets_centers = meets_centers && truth.first < truth.end;
        ASSERT_LE(end[axis], kWidth);
        ASSERT_GE(first[axis] + 1.0, truth.first) << "triangle " << i << ", axis " << axis;
        ASSERT_LE(end[axis] - 1.0, truth.end) << "triangle " << i << ", axis " << axis;
        bounds += 2;
        exact += (first[axis] == truth.first ? 1u : 0u) + (end[axis] == truth.end ? 1u : 0u);
      }
      if (!is_covering) {
        ASSERT_FALSE(meets_centers && greatest[0] - least[0] > 1.5 && greatest[1] - least[1] > 1.5);
      }
      if (greatest[0] - least[0] > 1.0 || greatest[1] - least[1] > 1.0) continue;
      ++small_count;
      const double last = kWidth - 1.0;
      if (greatest[0] >= 0.0 && least[0] <= last && greatest[1] >= 0.0 && least[1] <= last) ++in_packet;
      if (meets_centers) continue;
      ++beside_centers;
      left_out += is_covering ? 0u : 1u;
    }
  });
  if (!all_seeds_run() || testing::Test::HasFailure()) return;
  EXPECT_GT(exact, bounds / 10 * 9);
  EXPECT_GT(in_packet, 500u);
  EXPECT_GT(beside_centers, small_count / 3);
  EXPECT_GT(left_out, beside_centers / 10 * 9) << "of " << beside_centers;
}

TYPED_TEST(PixelBoxTest, BoxesAreHardlyLargerThanWhatIsCovered) {
  expect_tight_boxes<TypeParam, Packet<16>>();
  expect_tight_boxes<TypeParam, Packet<32>>();
}

// With a projection that does not round, a place on a pixel's centre counts as that pixel, and one behind it does not.
TYPED_TEST(PixelBoxTest, PlacesOnCentersCount) {
  using Wide = Packet<32>;
  const auto packet = std::make_unique<Wide>();
  packet->projection = PixelProjection{{{0, 0, 1}, {1, 0, 0}, {0, 1, 0}}, 0.0f, 1000.0f};
  for (std::uint32_t pixel = 0; pixel < Wide::kWidth; ++pixel) {
    const auto center = static_cast<float>(pixel);
    const float least_past = std::nextafter(center, 100.0f);
    struct Case {
      float low, high;
      std::uint32_t first, end;
    };
    const Case cases[] = {{center, center, pixel, pixel + 1},
                          {center - 0.25f, center, pixel, pixel + 1},
                          {center, center + 0.25f, pixel, pixel + 1},
                          {least_past, center + 1.0f, pixel, pixel + 2},  // as good as on it
                          {center + 0.125f, center + 1.0f, pixel + 1, pixel + 2},
                          {center - 1.0f, center + 0.5f, pixel == 0 ? 0 : pixel - 1, pixel + 1},
                          {center + 0.25f, center + 0.75f, pixel + 1, pixel + 1},
                          {-5.0f, 50.0f, 0, Wide::kWidth}};
    for (const Case& shown : cases) {
      const std::uint32_t end = std::min(shown.end, Wide::kWidth), first = std::min(shown.first, Wide::kWidth);
      for (const bool is_column : {true, false}) {
        const auto at = [is_column](float value, float other) {
          return is_column ? Vec3(value, other, 1) : Vec3(other, value, 1);
        };
        alignas(16) const VertexTriangle triangle =
            vertex_triangle(at(shown.low, 3), at(shown.high, 5), at(shown.high, 7), 1);
        const VertexTriangle* pointers[TypeParam::kCount];
        std::ranges::fill(pointers, &triangle);
        PixelBoxes<TypeParam> boxes;
        find_pixel_boxes<TypeParam>(*packet, pointers, boxes);
        ASSERT_EQ(boxes.covering, first < end ? TypeParam::kAllBits : 0u) << shown.low << " to " << shown.high;
        for (int i = 0; i < TypeParam::kCount; ++i) {
          const auto& firsts = is_column ? boxes.first_column : boxes.first_row;
          const auto& ends = is_column ? boxes.end_column : boxes.end_row;
          ASSERT_EQ(firsts[i], first) << shown.low << " to " << shown.high;
          ASSERT_EQ(ends[i], end) << shown.low << " to " << shown.high;
          ASSERT_EQ((is_column ? boxes.first_row : boxes.first_column)[i], 3u);
          ASSERT_EQ((is_column ? boxes.end_row : boxes.end_column)[i], 8u);
        }
      }
    }
  }
}

// Every box in a packet of 32 x 32, against its pixels.
TEST(PixelBox, SubpacketsAndRowsAreThoseOfItsPixels) {
  using Wide = Packet<32>;
  // Per range of columns, or rows: the columns, or rows, of subpackets that its pixels lie in.
  const auto lines_of = [](std::uint32_t first, std::uint32_t end) {
    std::uint32_t lines = 0;
    for (std::uint32_t pixel = first; pixel < end; ++pixel) lines |= 1u << pixel / kSubpacketWidth;
    return lines;
  };
  std::uint64_t small_count = 0, count = 0;
  for (std::uint32_t first_row = 0; first_row < Wide::kWidth; ++first_row) {
    for (std::uint32_t end_row = first_row + 1; end_row <= Wide::kWidth; ++end_row) {
      std::uint32_t rows = 0;
      for (std::uint32_t row = first_row; row < end_row; ++row) rows |= 1u << row;
      const std::uint32_t rows_of_subpackets = lines_of(first_row, end_row);
      for (std::uint32_t first_column = 0; first_column < Wide::kWidth; ++first_column) {
        for (std::uint32_t end_column = first_column + 1; end_column <= Wide::kWidth; ++end_column) {
          const PixelBox box{first_column, end_column, first_row, end_row};
          const std::uint32_t columns_of_subpackets = lines_of(first_column, end_column);
          SubpacketSet subpackets = 0;
          for (std::uint32_t i = 0; i < Wide::kSubpacketCount; ++i) {
            const std::uint32_t column = Wide::column_of(i * kSubpacketRays) / kSubpacketWidth;
            const std::uint32_t row = Wide::row_of(i * kSubpacketRays) / kSubpacketWidth;
            const bool touched = (columns_of_subpackets >> column & rows_of_subpackets >> row & 1u) != 0;
            subpackets |= SubpacketSet{touched ? 1u : 0u} << i;
          }
          const bool is_small = count_bits(columns_of_subpackets) <= 2 && count_bits(rows_of_subpackets) <= 2;
          ASSERT_EQ(box.subpackets(), subpackets) << first_column << " " << end_column << " " << first_row;
          ASSERT_EQ(box.rows(), rows) << first_row << " to " << end_row;
          ASSERT_EQ(box.is_small(), is_small)
              << first_column << " to " << end_column << ", " << first_row << " to " << end_row;
          small_count += is_small ? 1u : 0u;
          ++count;
        }
      }
    }
  }
  EXPECT_EQ(count, std::uint64_t{528} * 528);
  EXPECT_GT(small_count, 20000u);
}

}  // namespace
}  // namespace gridiron::test
