// Zero area and projection: see the header. SPDX-License-Identifier: Apache-2.0
#include <gridiron/base/exact_sum.h>
#include <gridiron/build/triangle_records.h>

#include <bit>

namespace gridiron {
namespace {

double absolute(double value) {
  return __builtin_fabs(value);  // one instruction, no call
}

// One component e1_u e2_v - e1_v e2_u of (b - a) x (c - a).
struct NormalComponent {
  double value;
  double error;  // |value - exact| < error, or both 0
};

// The bound is derived at has_zero_area.
NormalComponent normal_component(const double e1[3], const double e2[3], int u, int v) {
  const double p = e1[u] * e2[v];
  const double q = e1[v] * e2[u];
  return {p - q, 0x1p-50 * (absolute(p) + absolute(q))};
}

void edges_of(const Vec3& a, const Vec3& b, const Vec3& c, double e1[3], double e2[3]) {
  for (int axis = 0; axis < 3; ++axis) {
    e1[axis] = double{b[axis]} - double{a[axis]};
    e2[axis] = double{c[axis]} - double{a[axis]};
  }
}

// One component of (b - a) x (c - a), from its exact value: off by a few units of double's last place.
double exact_normal_component(const Vec3& a, const Vec3& b, const Vec3& c, int u, int v) {
  ExactSum sum;
  const float corners[3][3] = {{a.x, a.y, a.z}, {b.x, b.y, b.z}, {c.x, c.y, c.z}};
  sum.add_normal_component(corners[0], corners[1], corners[2], u, v);
  const int sign = sum.take_magnitude();
  // The product of two floats spans 2^-298 to 2^256: all within the range of double, limb by limb, above 2^-479.
  double value = 0.0;
  for (int i = ExactSum::kLimbCount - 1; i >= 0; --i) {
    const std::uint64_t weight_bits = static_cast<std::uint64_t>(1023 + 32 * i + ExactSum::kLowestExponent) << 52;
    value += static_cast<double>(sum.limb(i)) * std::bit_cast<double>(weight_bits);
  }
  return sign < 0 ? -value : value;
}

int largest_axis(const double v[3]) {
  const int k = absolute(v[1]) > absolute(v[0]) ? 1 : 0;
  return absolute(v[2]) > absolute(v[k]) ? 2 : k;
}

float to_float(double value) {
  const double below = value < double{kFloatMax} ? value : double{kFloatMax};
  return static_cast<float>(below > -double{kFloatMax} ? below : -double{kFloatMax});
}

}  // namespace

bool decide_zero_area(const Vec3& a, const Vec3& b, const Vec3& c) {
  double e1[3];
  double e2[3];
  edges_of(a, b, c, e1, e2);
  bool surely_zero = true;
  for (int u = 0; u < 3; ++u) {
    const NormalComponent component = normal_component(e1, e2, u, u < 2 ? u + 1 : 0);
    if (absolute(component.value) > component.error) return false;
    // Both products are zero only if a factor of each is, and a difference of floats is zero only if they are equal.
    surely_zero = surely_zero && component.error == 0.0;
  }
  if (surely_zero || a == b || b == c) return true;
  const float fa[3] = {a.x, a.y, a.z};
  const float fb[3] = {b.x, b.y, b.z};
  const float fc[3] = {c.x, c.y, c.z};
  return exact_zero_area(fa, fb, fc);
}

void make_projection_triangle(const Vec3& a, const Vec3& b, const Vec3& c, std::uint32_t triangle_id,
                              ProjectionTriangle& record) {
  double e1[3];
  double e2[3];
  edges_of(a, b, c, e1, e2);
  double normal[3];
  double error[3];
  for (int axis = 0; axis < 3; ++axis) {
    const NormalComponent component = normal_component(e1, e2, (axis + 1) % 3, (axis + 2) % 3);
    normal[axis] = component.value;
    error[axis] = component.error;
  }
  int k = largest_axis(normal);
  if (!(absolute(normal[k]) > error[k])) {  // a sliver whose normal is lost in the rounding of doubles
    for (int axis = 0; axis < 3; ++axis) {
      normal[axis] = exact_normal_component(a, b, c, (axis + 1) % 3, (axis + 2) % 3);
    }
    k = largest_axis(normal);
  }
  const int u = k < 2 ? k + 1 : 0;
  const int v = k > 0 ? k - 1 : 2;
  const double a_u = double{a[u]};
  const double a_v = double{a[v]};
  const double scale = 1.0 / normal[k];  // at most 2^299: far from the ends of double
  const double n_u = normal[u] * scale;
  const double n_v = normal[v] * scale;
  record = ProjectionTriangle{};
  record.n_u = to_float(n_u);
  record.n_v = to_float(n_v);
  record.n_d = to_float(double{a[k]} + n_u * a_u + n_v * a_v);
  record.b_u = to_float(e2[v] * scale);
  record.b_v = to_float(-e2[u] * scale);
  record.b_d = to_float((a_v * e2[u] - a_u * e2[v]) * scale);
  record.c_u = to_float(-e1[v] * scale);
  record.c_v = to_float(e1[u] * scale);
  record.c_d = to_float((a_u * e1[v] - a_v * e1[u]) * scale);
  record.axis_k = static_cast<std::uint32_t>(k);
  record.triangle_id = triangle_id;
}

}  // namespace gridiron
