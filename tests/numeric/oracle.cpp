// The oracle: see the header. SPDX-License-Identifier: Apache-2.0
#include "numeric/oracle.h"

#include <thread>

namespace gridiron::test {
namespace {

constexpr std::uint32_t kLeafTriangles = 4;
constexpr std::size_t kMostDepth = 40;  // of a tree of fewer than 2^32 triangles that is halved at every node

// --- Integers ---------------------------------------------------------------------------------------------------

struct WideVec {
  WideInt x, y, z;
};

WideVec operator-(const WideVec& a, const WideVec& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}

WideInt determinant(const WideVec& a, const WideVec& b, const WideVec& c) {
  return a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) + a.z * (b.x * c.y - b.y * c.x);
}

WideVec wide(const float* v, int unit) {
  return {Dyadic(v[0]).in_units_of<WideInt>(unit), Dyadic(v[1]).in_units_of<WideInt>(unit),
          Dyadic(v[2]).in_units_of<WideInt>(unit)};
}

struct Corners {
  float at[3][3];
};

Corners corners_of(const MeshView& mesh, std::uint32_t triangle) {
  const UVec3& t = mesh.triangles[triangle];
  const std::uint32_t index[3] = {t.x, t.y, t.z};
  Corners corners;
  for (int corner = 0; corner < 3; ++corner) {
    for (int axis = 0; axis < 3; ++axis) corners.at[corner][axis] = mesh.vertices[index[corner]][axis];
  }
  return corners;
}

// Side of the edge from corner `edge` to the next on which the ray's line passes.
int exact_side(const OracleRay& ray, const Corners& p, int edge) {
  const float* a = p.at[edge];
  const float* b = p.at[(edge + 1) % 3];
  const int unit = common_unit({ray.origin, a, b});
  const WideVec origin = wide(ray.origin, unit);
  const WideVec direction = wide(ray.direction, common_unit({ray.direction}));
  return determinant(direction, wide(a, unit) - origin, wide(b, unit) - origin).sign();
}

// Numerator / denominator of the distance to the plane; the denominator is not negative. It is 0 where the ray is
// parallel to the plane or the triangle has no area.
struct SignedFraction {
  WideInt numerator, denominator;
};

SignedFraction plane_distance(const OracleRay& ray, const Corners& p) {
  const int unit = common_unit({ray.origin, p.at[0], p.at[1], p.at[2]});
  const int direction_unit = common_unit({ray.direction});
  const WideVec a = wide(p.at[0], unit);
  const WideVec u = wide(p.at[1], unit) - a;
  const WideVec v = wide(p.at[2], unit) - a;
  SignedFraction result{determinant(a - wide(ray.origin, unit), u, v),
                        determinant(wide(ray.direction, direction_unit), u, v)};
  if (result.denominator < 0) {
    result.numerator = -result.numerator;
    result.denominator = -result.denominator;
  }
  if (unit > direction_unit) {
    result.numerator <<= static_cast<unsigned>(unit - direction_unit);
  } else {
    result.denominator <<= static_cast<unsigned>(direction_unit - unit);
  }
  return result;
}

// --- Doubles ----------------------------------------------------------------------------------------------------

// A sum of products of three differences of floats, and a sure bound of its error. With e = 2^-52, one rounding in any
// mode: a term passes at most 3 roundings of differences, 2 of products and 3 of sums, so the error is below 9 e times
// the sum of magnitudes; 16 e is charged. Neither overflow nor underflow: a product of three floats or differences of
// floats is 0 or lies in 2^[-447, 387].
struct BoundedDouble {
  double value, error;
};
constexpr double kDeterminantError = 0x1p-48;
// Of a distance to a plane of a box: a difference, a reciprocal and a product.
constexpr double kBoxError = 0x1p-48;

BoundedDouble determinant(const DVec3& a, const DVec3& b, const DVec3& c) {
  const double yz = b.y * c.z, zy = b.z * c.y;
  const double zx = b.z * c.x, xz = b.x * c.z;
  const double xy = b.x * c.y, yx = b.y * c.x;
  const double value = a.x * (yz - zy) + a.y * (zx - xz) + a.z * (xy - yx);
  const double magnitude = std::fabs(a.x) * (std::fabs(yz) + std::fabs(zy)) +
                           std::fabs(a.y) * (std::fabs(zx) + std::fabs(xz)) +
                           std::fabs(a.z) * (std::fabs(xy) + std::fabs(yx));
  return {value, kDeterminantError * magnitude};
}

DVec3 doubles_of(const float* v) {
  return {exact_double(v[0]), exact_double(v[1]), exact_double(v[2])};
}

bool is_finite(const float* v) {
  return test::is_finite(v[0]) && test::is_finite(v[1]) && test::is_finite(v[2]);
}

}  // namespace

void OracleCounts::add(const OracleCounts& other) {
  rays += other.rays;
  pairs += other.pairs;
  hits += other.hits;
  exact_sides += other.exact_sides;
  exact_distances += other.exact_distances;
}

// --- Tree -------------------------------------------------------------------------------------------------------

struct Oracle::RayDoubles {
  DVec3 origin, direction;
  double reciprocal[3];  // of the direction; unused where that is 0
  double low, high;      // every distance between the limits lies between these

  RayDoubles(const OracleRay& ray, Reading reading)
      : origin(doubles_of(ray.origin)), direction(doubles_of(ray.direction)) {
    for (int axis = 0; axis < 3; ++axis) reciprocal[axis] = direction[axis] != 0.0 ? 1.0 / direction[axis] : 0.0;
    low = exact_double(ray.t_min);
    high = exact_double(ray.t_max);
    if (reading == Reading::kStandard) {
      low *= 1.0 - 0x1p-22;
      high = ray.t_max >= kFloatMax ? std::numeric_limits<double>::max() : high * (1.0 + 0x1p-22);
    }
  }

  [[nodiscard]] bool meets(const MedianTree::Node& node, double limit) const {
    double near = low;
    double far = limit;
    for (int axis = 0; axis < 3; ++axis) {
      if (direction[axis] == 0.0) {
        if (origin[axis] < node.low[axis] || origin[axis] > node.high[axis]) return false;
        continue;
      }
      const double a = (node.low[axis] - origin[axis]) * reciprocal[axis];
      const double b = (node.high[axis] - origin[axis]) * reciprocal[axis];
      const double first = a < b ? a : b;
      const double last = a < b ? b : a;
      near = std::max(near, first - std::fabs(first) * kBoxError);
      far = std::min(far, last + std::fabs(last) * kBoxError);
    }
    return near <= far;
  }
};

Oracle::Oracle(const MeshView& mesh, OracleSettings settings) : mesh_(mesh), settings_(settings) {
  std::vector<PlacedBox> boxes(mesh.triangles.size());
  std::vector<std::uint32_t> ids;
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const Corners p = corners_of(mesh, i);
    if (!is_finite(p.at[0]) || !is_finite(p.at[1]) || !is_finite(p.at[2])) continue;
    ids.push_back(i);
    for (const float* corner : p.at) {
      boxes[i].add(doubles_of(corner));
      boxes[i].middle += doubles_of(corner);
    }
  }
  tree_ = MedianTree(boxes, std::move(ids), kLeafTriangles);
}

template <class Visit>
void Oracle::visit_candidates(const RayDoubles& doubles, double& limit, Visit&& visit) const {
  if (!settings_.use_boxes) {
    for (const std::uint32_t triangle : tree_.order()) visit(triangle);
    return;
  }
  if (tree_.nodes().empty()) return;
  std::uint32_t stack[kMostDepth];
  std::size_t depth = 0;
  stack[depth++] = 0;
  while (depth != 0) {
    const std::uint32_t index = stack[--depth];
    const MedianTree::Node& node = tree_.nodes()[index];
    if (!doubles.meets(node, limit)) continue;
    if (node.count != 0) {
      for (std::uint32_t i = 0; i < node.count; ++i) visit(tree_.order()[node.first + i]);
      continue;
    }
    // The nearer child comes first: it lies on top.
    const bool is_upward = doubles.direction[node.axis] >= 0.0;
    stack[depth++] = is_upward ? node.second : index + 1;
    stack[depth++] = is_upward ? index + 1 : node.second;
  }
}

// --- Pairs ------------------------------------------------------------------------------------------------------

ExactDistance Oracle::distance(const OracleRay& ray, std::uint32_t triangle_id) const {
  const SignedFraction found = plane_distance(ray, corners_of(mesh_, triangle_id));
  return {found.numerator, found.denominator};
}

bool Oracle::is_within_limits(const OracleRay& ray, OracleHit& hit, OracleCounts& counts) const {
  const double t_min = exact_double(ray.t_min);
  const double t_max = exact_double(ray.t_max);
  if (settings_.reading == Reading::kExact) {
    if (settings_.use_filter) {
      if (hit.low > t_min && hit.high <= t_max) return true;
      if (hit.high <= t_min || hit.low > t_max) return false;
    }
    ++counts.exact_distances;
    const ExactDistance t = distance(ray, hit.triangle_id);
    return t > exact_distance_of(ray.t_min) && t <= exact_distance_of(ray.t_max);
  }
  const double t = exact_double(rounded_distance(ray, hit, counts));
  return t > t_min && t <= t_max;
}

float Oracle::rounded_distance(const OracleRay& ray, const OracleHit& hit, OracleCounts& counts) const {
  if (settings_.use_filter) {
    const float low = rounded_float(hit.low, settings_.reading);
    if (std::bit_cast<std::uint32_t>(low) == std::bit_cast<std::uint32_t>(rounded_float(hit.high, settings_.reading))) {
      return low;
    }
  }
  ++counts.exact_distances;
  return distance(ray, hit.triangle_id).rounded(settings_.reading);
}

bool Oracle::test(const OracleRay& ray, const RayDoubles& doubles, std::uint32_t triangle, OracleHit& hit,
                  OracleCounts& counts) const {
  ++counts.pairs;
  const Corners p = corners_of(mesh_, triangle);
  const DVec3 corner[3] = {doubles_of(p.at[0]), doubles_of(p.at[1]), doubles_of(p.at[2])};
  Side side[3] = {Side::kUnsure, Side::kUnsure, Side::kUnsure};
  const auto has = [&](Side wanted) { return side[0] == wanted || side[1] == wanted || side[2] == wanted; };
  if (settings_.use_filter) {
    const DVec3 from[3] = {corner[0] - doubles.origin, corner[1] - doubles.origin, corner[2] - doubles.origin};
    for (int edge = 0; edge < 3; ++edge) {
      const BoundedDouble e = determinant(doubles.direction, from[edge], from[(edge + 1) % 3]);
      if (e.value > e.error) side[edge] = Side::kPositive;
      if (e.value < -e.error) side[edge] = Side::kNegative;
    }
    if (has(Side::kPositive) && has(Side::kNegative)) return false;
  }
  for (int edge = 0; edge < 3; ++edge) {
    if (side[edge] != Side::kUnsure) continue;
    ++counts.exact_sides;
    side[edge] = static_cast<Side>(exact_side(ray, p, edge));
  }
  if (has(Side::kPositive) == has(Side::kNegative)) return false;

  hit.triangle_id = triangle;
  bool is_bounded = false;
  if (settings_.use_filter) {
    const DVec3 u = corner[1] - corner[0], v = corner[2] - corner[0];
    const BoundedDouble numerator = determinant(corner[0] - doubles.origin, u, v);
    const BoundedDouble denominator = determinant(doubles.direction, u, v);
    // With relative errors up to 1/8 the quotient is off by at most twice their sum, and by a few roundings.
    is_bounded =
        std::fabs(numerator.value) > 8 * numerator.error && std::fabs(denominator.value) > 8 * denominator.error;
    if (is_bounded) {
      const double quotient = numerator.value / denominator.value;
      if (quotient < 0.0) return false;
      const double relative =
          2 * (numerator.error / std::fabs(numerator.value) + denominator.error / std::fabs(denominator.value)) +
          0x1p-48;
      hit.low = quotient * (1.0 - relative);
      hit.high = quotient * (1.0 + relative);
    }
  }
  if (!is_bounded) {
    ++counts.exact_distances;
    const SignedFraction found = plane_distance(ray, p);
    if (found.numerator < 0) return false;
    const auto [low, high] = ExactDistance{found.numerator, found.denominator}.bounds();
    hit.low = low;
    hit.high = high;
  }
  if (!is_within_limits(ray, hit, counts)) return false;
  ++counts.hits;
  return true;
}

// --- Rays -------------------------------------------------------------------------------------------------------

std::vector<OracleHit> Oracle::hits(const OracleRay& ray, OracleCounts* counts) const {
  std::vector<OracleHit> found;
  OracleCounts work;
  ++work.rays;
  if (is_finite(ray.origin) && is_finite(ray.direction)) {
    const RayDoubles doubles(ray, settings_.reading);
    double limit = doubles.high;
    visit_candidates(doubles, limit, [&](std::uint32_t triangle) {
      OracleHit hit;
      if (test(ray, doubles, triangle, hit, work)) found.push_back(hit);
    });
  }
  std::sort(found.begin(), found.end(),
            [](const OracleHit& a, const OracleHit& b) { return a.triangle_id < b.triangle_id; });
  if (counts != nullptr) counts->add(work);
  return found;
}

NearestHit Oracle::nearest(const OracleRay& ray, OracleCounts* counts) const {
  OracleCounts work;
  ++work.rays;
  NearestHit result;
  std::vector<OracleHit> found;
  if (is_finite(ray.origin) && is_finite(ray.direction)) {
    const RayDoubles doubles(ray, settings_.reading);
    // Every distance that is the least or rounds to the same float lies below. A denormal's neighbour is 2^-149 off.
    double limit = doubles.high;
    visit_candidates(doubles, limit, [&](std::uint32_t triangle) {
      OracleHit hit;
      if (!test(ray, doubles, triangle, hit, work) || hit.low > limit) return;
      found.push_back(hit);
      // Beyond all floats the next one may be any distance away.
      const double reach = hit.high * (1.0 + 0x1p-22) + 0x1p-148;
      if (reach < 0x1p127) limit = std::min(limit, reach);
    });
    std::erase_if(found, [&](const OracleHit& hit) { return hit.low > limit; });
  }
  if (!found.empty()) settle(ray, found, result, work);
  if (counts != nullptr) counts->add(work);
  return result;
}

void Oracle::settle(const OracleRay& ray, std::vector<OracleHit>& found, NearestHit& result,
                    OracleCounts& work) const {
  std::sort(found.begin(), found.end(),
            [](const OracleHit& a, const OracleHit& b) { return a.triangle_id < b.triangle_id; });

  // Only those whose bounds overlap the nearest's can be nearest.
  double nearest_high = std::numeric_limits<double>::max();
  for (const OracleHit& hit : found) nearest_high = std::min(nearest_high, hit.high);
  std::uint32_t best = 0;
  if (std::count_if(found.begin(), found.end(), [&](const OracleHit& hit) { return hit.low <= nearest_high; }) == 1) {
    while (found[best].low > nearest_high) ++best;
    result.ties.push_back(found[best].triangle_id);
  } else {
    ExactDistance least;
    for (std::uint32_t i = 0; i < found.size(); ++i) {
      if (found[i].low > nearest_high) continue;
      const ExactDistance t = distance(ray, found[i].triangle_id);
      ++work.exact_distances;
      const auto order = result.ties.empty() ? std::strong_ordering::less : t <=> least;
      if (order > 0) continue;
      if (order < 0) {
        result.ties.clear();
        least = t;
        best = i;
      }
      result.ties.push_back(found[i].triangle_id);
    }
  }
  result.t = rounded_distance(ray, found[best], work);
  const auto bits = std::bit_cast<std::uint32_t>(result.t);
  for (const OracleHit& hit : found) {
    if (std::bit_cast<std::uint32_t>(rounded_distance(ray, hit, work)) == bits) {
      result.float_ties.push_back(hit.triangle_id);
    }
  }
}

std::vector<NearestHit> Oracle::nearest(std::span<const OracleRay> rays, unsigned threads, OracleCounts* counts) const {
  std::vector<NearestHit> found(rays.size());
  std::vector<OracleCounts> work(threads);
  std::vector<std::thread> workers;
  for (unsigned i = 0; i < threads; ++i) {
    workers.emplace_back([&, i] {
      const std::size_t end = rays.size() * (i + 1) / threads;
      OracleCounts own;
      for (std::size_t ray = rays.size() * i / threads; ray < end; ++ray) found[ray] = nearest(rays[ray], &own);
      work[i] = own;
    });
  }
  for (std::thread& worker : workers) worker.join();
  if (counts != nullptr) {
    for (const OracleCounts& part : work) counts->add(part);
  }
  return found;
}

}  // namespace gridiron::test
