// Error bounds of the kernel at the inputs found to come closest to them: every decision is still the exact one, and
// the errors are the shares of their bounds that bound_cases.h states.
//
// Found by hill climbing over the bits of the inputs, from thousands of starts at numbers just above powers of two,
// for the largest error as a share of its bound or, with the bound lowered as far as a case says, for a wrong decision.
// SPDX-License-Identifier: Apache-2.0
#include <gridiron/engine/grid/frustum.h>
#include <gridiron/ray/camera.h>
#include <gridiron/ray/distance.h>
#include <gridiron/ray/edges.h>
#include <gridiron/ray/intersect_standard.h>
#include <gridiron/ray/pixel_box.h>
#include <gridiron/ray/subpackets.h>

#include "core/engine/grid/bound_cases.h"
#include "core/lane_types.h"
#include "core/ray/exact_ray.h"
#include "core/ray/packet_cases.h"
#include "support/rational_vectors.h"

namespace gridiron::test {
namespace {

using SmallPacket = Packet<4>;
using Wide = long double;  // 64 bits: what it loses is 2^-40 of any bound here

template <class L>
class ErrorBoundsTest : public testing::Test {};
TYPED_TEST_SUITE(ErrorBoundsTest, LaneTypes, LaneNames);

// All rays of a packet from one origin in one direction, nothing hit yet.
void set_ray(SmallPacket& packet, const float origin[3], const float dir[3]) {
  for (int axis = 0; axis < 3; ++axis) {
    packet.origin[axis] = origin[axis];
    std::ranges::fill(packet.dir[axis], dir[axis]);
  }
  start_all(packet);
}

// 2 det[dir, a - origin, b - origin]
Wide edge_value(const float origin[3], const float dir[3], const float a[3], const float b[3]) {
  Wide from_a[3], from_b[3], value = 0;
  for (int i = 0; i < 3; ++i) {
    from_a[i] = Wide{a[i]} - Wide{origin[i]};
    from_b[i] = Wide{b[i]} - Wide{origin[i]};
  }
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    value += Wide{dir[i]} * (from_a[j] * from_b[k] - from_a[k] * from_b[j]);
  }
  return 2 * value;
}

// A triangle with an edge (a, b) and its third corner on one side of the plane of origin and edge, as far from the edge
// as this is long.
VertexTriangle triangle_at_edge(const float origin[3], const float a[3], const float b[3], double side) {
  double from_a[3], edge[3], normal[3], length = 0.0, size = 0.0;
  for (int i = 0; i < 3; ++i) {
    from_a[i] = double{a[i]} - double{origin[i]};
    edge[i] = double{b[i]} - double{a[i]};
  }
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    normal[i] = from_a[j] * edge[k] - from_a[k] * edge[j];
    length = std::hypot(length, normal[i]);
    size = std::hypot(size, edge[i]);
  }
  Vec3 c;
  for (int i = 0; i < 3; ++i) {
    c[i] = static_cast<float>(0.5 * (double{a[i]} + double{b[i]}) + side * size * normal[i] / length);
  }
  return vertex_triangle(vec_of(a), vec_of(b), c, 5);
}

template <class L>
EdgeBatch<L> edges_of(const SmallPacket& packet, const VertexTriangle& triangle) {
  const VertexTriangle* triangles[EdgeBatch<L>::kTriangles];
  std::ranges::fill(triangles, &triangle);
  EdgeBatch<L> batch;
  WorkCounters work;
  set_up_edges<L>(packet, triangles, Culling{.corner_rays = false, .subpackets = false}, batch, work);
  return batch;
}

// kEdgeErrorFactor. A ray close to an edge, on the side that its sum in single precision does not say.
TYPED_TEST(ErrorBoundsTest, AnEdgeSignDeclaredSureIsTheExactOne) {
  double largest = 0.0;
  for (const EdgeCase& shown : kEdgeCases) {
    for (const double side : {-1.0, 1.0}) {
      alignas(16) const VertexTriangle triangle = triangle_at_edge(shown.origin, shown.a, shown.b, side);
      SmallPacket packet{};
      set_ray(packet, shown.origin, shown.dir);
      const EdgeBatch<TypeParam> batch = edges_of<TypeParam>(packet, triangle);
      ASSERT_NE(batch.in_range & 1u, 0u);
      const float value = batch.n[0][0] * shown.dir[0] + batch.n[1][0] * shown.dir[1] + batch.n[2][0] * shown.dir[2];
      const int inward = batch.orientation[0];
      const int sign = inward * exact_edge_sign(shown.origin, shown.dir, shown.a, shown.b);
      EXPECT_FALSE(value > batch.error[0] && sign < 0) << "inside, it says";
      EXPECT_FALSE(value < -batch.error[0] && sign >= 0) << "outside, it says";
      const Wide exact = inward * edge_value(shown.origin, shown.dir, shown.a, shown.b);
      largest = std::fmax(largest, static_cast<double>(std::fabs(Wide{value} - exact) / Wide{batch.error[0]}));

      WorkCounters work;
      (void)intersect_standard<TypeParam, false>(packet, triangle, false, work);
      const bool hits = true_distance(shown.origin, shown.dir, triangle) > 0.0f;
      EXPECT_EQ(packet.id[0] != kNoTriangle, hits) << "side " << side;
    }
  }
  EXPECT_GT(largest, kEdgeShare);
  EXPECT_LT(largest, 0.5);
}

// A packet of a frame that has nothing but directions; the eye is at 0.
template <class L, class PacketType>
std::unique_ptr<PacketType> packet_of(const PictureCase& shown) {
  FrameRecord frame{};
  for (int axis = 0; axis < 3; ++axis) {
    frame.corner[axis] = shown.corner[axis];
    frame.step_x[axis] = shown.step_x[axis];
    frame.step_y[axis] = shown.step_y[axis];
  }
  frame.width = frame.height = 8192;
  frame.t_far = kFloatMax;
  frame.depth_address = 1;
  auto packet = std::make_unique<PacketType>();
  RaySet<PacketType::kRayCount> present;
  WorkCounters work;
  generate_packet<L>(frame, shown.left, shown.top, *packet, present, work);
  packet->active = present;
  return packet;
}

// The ray of a packet at a column and a row.
template <class PacketType>
std::uint32_t ray_at(std::uint32_t column, std::uint32_t row) {
  for (std::uint32_t ray = 0; ray < PacketType::kRayCount; ++ray) {
    if (PacketType::column_of(ray) == column && PacketType::row_of(ray) == row) return ray;
  }
  return ~0u;
}

template <class L, class PacketType>
void expect_same_hits(PacketType& packet, const VertexTriangle& triangle, Culling culling) {
  const auto plain = std::make_unique<PacketType>(packet);
  const OpenTriangle open{&triangle, PacketType::kAllSubpackets, ~0u, false};
  WorkCounters work;
  (void)intersect_standard_batch<L, false>(*plain, &open, 1, Culling{.corner_rays = false, .subpackets = false}, work);
  (void)intersect_standard_batch<L, false>(packet, &open, 1, culling, work);
  for (std::uint32_t ray = 0; ray < PacketType::kRayCount; ++ray) {
    ASSERT_EQ(packet.id[ray], plain->id[ray])
        << "column " << PacketType::column_of(ray) << ", row " << PacketType::row_of(ray);
  }
}

// The edge functions of a triangle at an edge of a case, the third corner where the case's ray is inside.
template <class L, class PacketType>
struct PictureEdges {
  std::unique_ptr<PacketType> packet;
  std::uint32_t ray;
  std::array<float, 3> dir;
  alignas(16) VertexTriangle triangle;
  EdgeBatch<L> batch;

  PictureEdges(const PictureCase& shown, Culling culling)
      : packet(packet_of<L, PacketType>(shown)),
        ray(ray_at<PacketType>(shown.column, shown.row)),
        dir(direction_of(*packet, ray)) {
    triangle = triangle_at_edge(packet->origin, shown.a, shown.b, 1.0);
    const VertexTriangle* triangles[EdgeBatch<L>::kTriangles];
    std::ranges::fill(triangles, &triangle);
    WorkCounters work;
    set_up_edges<L>(*packet, triangles, culling, batch, work);
  }
  // The edge function at the case's ray.
  [[nodiscard]] Wide exact_value() const {
    return batch.orientation[0] * edge_value(packet->origin, dir.data(), triangle.v[0], triangle.v[1]);
  }
};

// @returns by how much all corner rays are farther outside of the case's edge than its ray, as a share of the bound.
template <class L, class PacketType>
double expect_no_hit_lost_to_corners(const PictureCase& shown, std::uint32_t& hits) {
  constexpr Culling kCulling{.corner_rays = true, .subpackets = false};
  PictureEdges<L, PacketType> edges(shown, kCulling);
  PacketType& packet = *edges.packet;
  const bool hit = true_distance(packet, edges.ray, edges.triangle) > 0.0f;
  hits += hit ? 1u : 0u;
  float nearest = -kFloatMax;
  for (int corner = 0; corner < 4; ++corner) {
    nearest = std::max(nearest, edges.batch.n[0][0] * packet.corner_dir[0][corner] +
                                    edges.batch.n[1][0] * packet.corner_dir[1][corner] +
                                    edges.batch.n[2][0] * packet.corner_dir[2][corner]);
  }
  expect_same_hits<L>(packet, edges.triangle, kCulling);
  EXPECT_EQ(packet.id[edges.ray] != kNoTriangle, hit);
  return static_cast<double>((edges.exact_value() - Wide{nearest}) /
                             Wide{edges.batch.error[0] * packet.corner_widening});
}

// kCornerErrorFactor. All four corner rays pass an edge on the outside, a ray between them on the inside.
TYPED_TEST(ErrorBoundsTest, CornerRaysSpeakForRoundedDirections) {
  double largest = 0.0;
  std::uint32_t hits = 0;
  for (const PictureCase& shown : kCornerCases) {
    const double share = shown.width == 8 ? expect_no_hit_lost_to_corners<TypeParam, Packet<8>>(shown, hits)
                                          : expect_no_hit_lost_to_corners<TypeParam, Packet<32>>(shown, hits);
    largest = std::fmax(largest, share);
  }
  EXPECT_GT(hits, 0u);
  EXPECT_GT(largest, kCornerShare);
  EXPECT_LT(largest, 0.5);
}

// kSubpacketErrorFactor. The edge function's linear form over the place of a ray says that all pass on the outside
// while the ray is inside; or the other way round.
TYPED_TEST(ErrorBoundsTest, TheLinearFormOfAnEdgeIsAsCloseAsItSays) {
  using PacketType = Packet<32>;
  constexpr Culling kCulling{.corner_rays = false, .subpackets = true};
  double largest = 0.0;
  for (const PictureCase& shown : kSubpacketCases) {
    PictureEdges<TypeParam, PacketType> edges(shown, kCulling);
    const EdgeBatch<TypeParam>& batch = edges.batch;
    const auto near_line = [&](std::uint32_t width, const float* first) {
      const auto column = static_cast<float>(shown.column / width * width);
      const auto row = static_cast<float>(width == kSubpacketWidth ? shown.row : shown.row / width * width);
      return first[0] + (column * batch.per_column[0] + row * batch.per_row[0]);
    };
    const Wide exact = edges.exact_value();
    const float values[] = {near_line(kSubpacketWidth, batch.first_row),
                            near_line(2 * kSubpacketWidth, batch.first_square),
                            near_line(4 * kSubpacketWidth, batch.first_quarter)};
    const float limit = batch.surely_outside[0];
    ASSERT_LT(limit, 0.0f);
    for (const float value : values) {
      largest = std::fmax(largest, static_cast<double>((exact - Wide{value}) / -Wide{limit}));
      EXPECT_FALSE(value < limit && exact >= 0);
    }
    expect_same_hits<TypeParam>(*edges.packet, edges.triangle, kCulling);
  }
  EXPECT_GT(largest, kSubpacketShare);
  EXPECT_LT(largest, 0.25);
}

// What the roundings of a subpacket's edge value can add up to at most, to first order, in units of e scale D: each is
// off by its result's last digit, all the wrong way. Half of it is the most in rounding to nearest.
double sum_of_roundings(const PictureCase& shown) {
  double dir[3], first_dir[3], dir_digits[3], n[3], a_size = 0.0, f_size = 0.0, dir_bound = 0.0, sum = 0.0;
  const auto size = [](double value) { return std::fabs(value); };
  const double left = shown.left, top = shown.top, column = shown.column, row = shown.row;
  double s[3], f[3];
  for (int i = 0; i < 3; ++i) {
    const double corner = double{shown.corner[i]}, x = double{shown.step_x[i]}, y = double{shown.step_y[i]};
    const double along_x = (left + column) * x, along_y = (top + row) * y;
    dir[i] = corner + along_x + along_y;
    first_dir[i] = corner + left * x + top * y;
    dir_digits[i] = size(along_x) + size(corner + along_x) + size(along_y) + size(dir[i]);
    if (shown.left != 0) dir_digits[i] += size(left * x) + size(corner + left * x);
    if (shown.top != 0) dir_digits[i] += size(top * y) + size(first_dir[i]);
    dir_bound = std::fmax(dir_bound, size(corner) + (left + 31.0) * size(x) + (top + 31.0) * size(y));
    s[i] = double{shown.a[i]} + double{shown.b[i]};
    f[i] = double{shown.b[i]} - double{shown.a[i]};
    a_size += size(double{shown.a[i]}) + size(double{shown.b[i]});
    f_size = std::fmax(f_size, size(f[i]));
  }
  for (int i = 0; i < 3; ++i) {  // n
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    n[i] = s[j] * f[k] - s[k] * f[j];
    const double s_digits = size(double{shown.a[i]}) + size(double{shown.b[i]}) + size(s[i]);
    sum += size(f[k] * dir[j] - f[j] * dir[k]) * s_digits + size(dir[k] * s[j] - dir[j] * s[k]) * size(f[i]);
    sum += size(dir[i]) * (size(s[j] * f[k]) + size(s[k] * f[j]) + size(n[i]));
  }
  for (int i = 0; i < 3; ++i) sum += size(n[i]) * dir_digits[i];  // the direction, the linear form's first
  double value[3] = {};
  const double weight[3] = {1.0, column, row};
  for (int vector = 0; vector < 3; ++vector) {  // n . first_dir, n . step_x, n . step_y
    double partial = 0.0;
    for (int i = 0; i < 3; ++i) {
      const double product =
          n[i] * (vector == 0 ? first_dir[i] : double{vector == 1 ? shown.step_x[i] : shown.step_y[i]});
      partial += product;
      sum += weight[vector] * (size(product) + (i > 0 ? size(partial) : 0.0));
    }
    value[vector] = partial;
  }
  const auto by_columns = [&](std::uint32_t columns) { return static_cast<double>(columns) * value[1]; };
  const auto by_rows = [&](std::uint32_t rows) { return static_cast<double>(rows) * value[2]; };
  const double rise = std::fmax(value[1], 0.0) + std::fmax(value[2], 0.0);
  const double in_square = value[0] + 7.0 * rise, in_subpacket = in_square - 4.0 * rise;
  const double near_x = by_columns(shown.column / 4 % 2 * 4), near_y = by_rows(shown.row / 4 % 2 * 4);
  const double far_x = by_columns(shown.column / 8 * 8), far_y = by_rows(shown.row / 8 * 8);
  const double offset = in_subpacket + near_x + near_y;
  sum += 3.0 * rise + 7.0 * rise + size(in_square) + 4.0 * rise + size(in_subpacket) + size(near_x + near_y);
  sum += size(offset) + size(far_x) + size(far_y) + size(far_x + far_y) + size(offset + far_x + far_y);
  return sum / (a_size * f_size * dir_bound);
}

// kSubpacketErrorFactor covers what roundings of any mode can come to. 17 e would do in rounding to nearest, where the
// sum is halved: found by climbing for the largest sum, over pictures, places and edges through a pixel's centre.
TEST(ErrorBounds, TheLinearFormsRoundingsStayBelowTheirBoundInAnyMode) {
  constexpr double kCharged = double{kSubpacketErrorFactor} * 0x1p23;
  const double sum = sum_of_roundings(kWorstSubpacketCase);
  EXPECT_LT(sum, kCharged);
  EXPECT_GT(sum, kRoundingShare * kCharged);
  EXPECT_LT(0.5 * sum, 17.0);
}

// kUnit * (...) of set_up_projection. A triangle's corner lies on a ray, exactly, and the rest beside it.
TYPED_TEST(ErrorBoundsTest, PixelBoxesHoldACornerOnARay) {
  using PacketType = Packet<32>;
  double largest = 0.0;
  for (const PictureCase& shown : kPlaceCases) {
    const auto packet = packet_of<TypeParam, PacketType>(shown);
    const std::uint32_t ray = ray_at<PacketType>(shown.column, shown.row);
    const auto dir = direction_of(*packet, ray);
    const PixelProjection& projection = packet->projection;
    ASSERT_GT(projection.most_per_depth, 0.0f);
    const auto along = [&](int row) {
      return dir[0] * projection.rows[row][0] + dir[1] * projection.rows[row][1] + dir[2] * projection.rows[row][2];
    };
    const float inverse = 1.0f / along(0);
    const double off[2] = {double{along(1) * inverse} - static_cast<double>(shown.column),
                           double{along(2) * inverse} - static_cast<double>(shown.row)};
    const int axis = std::fabs(off[0]) > std::fabs(off[1]) ? 0 : 1;
    largest = std::fmax(largest, std::fabs(off[axis]) / double{projection.margin});
    // The other corners lie eight pixels farther to where the place is off.
    const float way = off[axis] > 0.0 ? 8.0f : -8.0f;
    const Vec3 corner = vec_of(dir.data());
    const Vec3 ahead = way * vec_of(axis == 0 ? packet->step_x : packet->step_y);
    const Vec3 beside = 4.0f * vec_of(axis == 0 ? packet->step_y : packet->step_x);
    alignas(16) const VertexTriangle triangle =
        vertex_triangle(corner, corner + ahead + beside, corner + ahead - beside, 5);
    ASSERT_GT(true_distance(*packet, ray, triangle), 0.0f);
    const VertexTriangle* triangles[TypeParam::kCount];
    std::ranges::fill(triangles, &triangle);
    PixelBoxes<TypeParam> boxes;
    find_pixel_boxes<TypeParam>(*packet, triangles, boxes);
    EXPECT_NE(boxes.covering & 1u, 0u);
    EXPECT_LE(boxes.first_column[0], shown.column);
    EXPECT_GT(boxes.end_column[0], shown.column);
    EXPECT_LE(boxes.first_row[0], shown.row);
    EXPECT_GT(boxes.end_row[0], shown.row);
  }
  EXPECT_GT(largest, kPlaceShare);
  EXPECT_LT(largest, 0.5);
}

// A grid and a frustum of rays that all run the same way, along x and y.
template <class L>
struct MarchOfOneRay {
  GridRecord grid{};
  float origin[3];
  float dir[3];
  SmallPacket packet{};
  Frustum frustum;

  explicit MarchOfOneRay(const MarchCase& shown)
      : origin{shown.origin[0], shown.origin[1], 0.5f}, dir{shown.dir[0], shown.dir[1], 0.0f} {
    for (int axis = 0; axis < 3; ++axis) {
      grid.minimum[axis] = axis < 2 ? shown.minimum[axis] : 0.0f;
      grid.cells_per_unit[axis] = axis < 2 ? shown.cells_per_unit[axis] : 1.0f;
      grid.cell_count[axis] = grid.macro_cell_count[axis] = axis == 0 ? shown.slices : axis == 1 ? 2048u : 1u;
    }
    grid.macro_width = 1;
    set_ray(packet, origin, dir);
    RaySet<SmallPacket::kRayCount> waiting;
    waiting.fill();
    WorkCounters work;
    EXPECT_TRUE(take_pass<L>(grid, waiting, packet, frustum, work));
    EXPECT_EQ(frustum.axis_k, 0u);
    EXPECT_FALSE(frustum.reverse);
  }
};

// The factor of march_bound. A ray leaves the slices up to a plane in the corner of a cell, just beyond its face.
TYPED_TEST(ErrorBoundsTest, AFrustumHoldsTheCellThatARayJustReaches) {
  double largest = 0.0;
  for (const MarchCase& shown : kMarchCases) {
    MarchOfOneRay<TypeParam> march(shown);
    const auto last = static_cast<std::int32_t>(shown.plane) - 1;
    const auto box = ExactRay(march.grid, march.origin, march.dir).box_between(0, 0, last);
    ASSERT_TRUE(box.has_value());
    const Slab slab = march.frustum.slab_of(0, last);
    const CellRect rect = march.frustum.rect_of(slab);
    EXPECT_LE(rect.u_first, box->u.first);
    EXPECT_GE(rect.u_last, box->u.last);

    const auto in_cells = [&](int axis) {
      return (Wide{march.origin[axis]} - Wide{march.grid.minimum[axis]}) * Wide{march.grid.cells_per_unit[axis]};
    };
    const Wide slope = Wide{march.dir[1]} * Wide{march.grid.cells_per_unit[1]} /
                       (Wide{march.dir[0]} * Wide{march.grid.cells_per_unit[0]});
    const Wide truth = in_cells(1) + slope * (static_cast<Wide>(shown.plane) - in_cells(0));
    const Wide pad = (Wide{march.frustum.start[1]} - Wide{march.frustum.start[0]}) / 2;
    const float bound = march.frustum.start[1] + march.frustum.slope_far[1] * slab.exit;
    largest = std::fmax(largest, static_cast<double>((truth - (Wide{bound} - pad)) / pad));
  }
  EXPECT_GT(largest, kMarchShare);
  EXPECT_LT(largest, 1.0);
}

// kReachFactor is not needed: pad_k is at least 9 e of any march in a grid, and a march, a reach and their comparison
// lose less than that. Nor are they ever without the 2 kEstimateError that every reach is lengthened by.
TYPED_TEST(ErrorBoundsTest, PadsCoverTheRoundingsOfAReach) {
  double largest = 0.0;
  for (const MarchCase& shown : kReachCases) {
    MarchOfOneRay<TypeParam> march(shown);
    const auto first = static_cast<std::int32_t>(shown.plane);
    ASSERT_TRUE(ExactRay(march.grid, march.origin, march.dir).reaches(0, first, first, shown.t));
    const Slab slab = march.frustum.slab_of(first, first);
    const float reach = shown.t * march.packet.march_high[0];
    EXPECT_FALSE(march.frustum.beyond(slab, reach));
    EXPECT_LE(slab.entry, reach + march.frustum.pad_k) << "without the factor";
    largest = std::fmax(largest, (double{slab.entry} - double{reach}) / double{march.frustum.pad_k});
  }
  EXPECT_GT(largest, kReachShare);
  EXPECT_LT(largest, 0.5);
}

VertexTriangle triangle_of(const DistanceCase& shown) {
  return vertex_triangle(vec_of(shown.a), vec_of(shown.b), vec_of(shown.c), 5);
}

// kFloatError. Numerator or denominator is as small, compared with its terms, as an estimate accepts, or would accept
// with 1 e.
TYPED_TEST(ErrorBoundsTest, AnEstimatedDistanceIsAsCloseAsItSays) {
  double largest = 0.0;
  for (const DistanceCase& shown : kEstimateCases) {
    alignas(16) const VertexTriangle triangle = triangle_of(shown);
    float dir_max = 0.0f;
    for (const float component : shown.dir) dir_max = std::fmax(dir_max, std::fabs(component));
    const DistanceEstimate estimate = set_up_estimate(shown.origin, dir_max, triangle);
    for (const float sign : {1.0f, -1.0f}) {  // forwards or backwards
      const float dir[3] = {sign * shown.dir[0], sign * shown.dir[1], sign * shown.dir[2]};
      const float denominator = estimate.normal[0] * dir[0] + estimate.normal[1] * dir[1] + estimate.normal[2] * dir[2];
      if (!(std::fabs(denominator) > estimate.least_denominator)) continue;  // left open
      const double truth = double{exact_distance(shown.origin, dir, shown.a, shown.b, shown.c)};
      ASSERT_EQ(denominator > 0.0f, truth > 0.0);
      if (!(denominator > 0.0f)) continue;
      const double error = std::fabs(double{estimate.numerator / denominator} - truth);
      largest = std::fmax(largest, error / (double{kEstimateError} * truth));
    }
  }
  EXPECT_GT(largest, kEstimateShare);
  EXPECT_LT(largest, 0.9);
}

// Distance of a triangle's plane along a ray, without any rounding.
Rational exact_quotient(const DistanceCase& shown) {
  const RationalPoint a = exact_point(shown.a);
  const RationalPoint normal = cross(exact_point(shown.b) - a, exact_point(shown.c) - a);
  return dot(a - exact_point(shown.origin), normal) / dot(exact_point(shown.dir), normal);
}

// kDistanceError. Numerator and denominator lose so much that a quotient said to be sure would round to another float.
TYPED_TEST(ErrorBoundsTest, ASureDistanceIsTheNearestFloat) {
  double largest = 0.0;
  for (const DistanceCase& shown : kQuotientCases) {
    alignas(16) const VertexTriangle triangle = triangle_of(shown);
    SmallPacket packet{};
    set_ray(packet, shown.origin, shown.dir);
    DistanceSetup setup;
    set_up_distance(shown.origin, packet.dir_max, triangle, setup);
    alignas(64) float distance[TypeParam::kCount];
    WorkCounters work;
    distances_of<TypeParam>(packet, 0, TypeParam::kAllBits, triangle, setup, distance, work);
    const float truth = exact_distance(shown.origin, shown.dir, shown.a, shown.b, shown.c);
    for (const float found : distance) EXPECT_EQ(found, truth);
    const double denominator =
        shown.dir[0] * setup.normal[0] + shown.dir[1] * setup.normal[1] + shown.dir[2] * setup.normal[2];
    const double quotient = setup.numerator / denominator;
    const double bound = quotient * (quotient * setup.relative_error_per_t + setup.relative_error);
    const double error = std::fabs((Rational(quotient) - exact_quotient(shown)).convert_to<double>());
    largest = std::fmax(largest, error / bound);
  }
  EXPECT_GT(largest, kQuotientShare);
  EXPECT_LT(largest, 0.5);
}

}  // namespace
}  // namespace gridiron::test
