// Judge: see the header. SPDX-License-Identifier: Apache-2.0
#include "numeric/hard_cases/judge.h"

namespace gridiron::test::hard {
namespace {

bool is_same(float a, float b) {
  return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
}

// As core computes it.
float length_of(const Vec3& d) {
  return std::sqrt((d.x * d.x + d.y * d.y) + d.z * d.z);
}

}  // namespace

Judge::Judge(const Target& target, Grade grade) : target_(target), grade_(grade) {
  float size = 0.0f;
  for (const Vec3& v : target.mesh().vertices)
    size = std::fmax(size, std::fmax(std::fabs(v.x), std::fmax(std::fabs(v.y), std::fabs(v.z))));
  overflows_ = target.profile().accuracy == Accuracy::kFast && !(size > 0x1p-40f && size < 0x1p40f);
}

std::uint32_t Judge::true_id(const NearestHit& truth) const {
  if (truth.float_ties.empty()) return kNoTriangle;
  return target_.profile().accuracy == Accuracy::kExact ? truth.ties.front() : truth.float_ties.front();
}

const char* Judge::fault_of(const Rays& rays, std::size_t ray, const Answer& answer, Form form) {
  const NearestHit& truth = truth_[ray];
  const bool is_hit = answer.id != kNoTriangle;
  const std::uint32_t wanted = true_id(truth);
  differing_ += answer.id != wanted;
  if (is_hit && answer.id == wanted && form == Form::kDistance) {
    largest_error_ = std::fmax(largest_error_, std::fabs(double{answer.t} - double{truth.t}) / double{truth.t});
  }
  // C: every accuracy with a stronger promise keeps this too.
  if (is_hit && answer.id >= target_.mesh().triangles.size()) return "no such triangle";
  if (is_hit && !target_.has_area(answer.id)) return "a triangle without area";
  if (form == Form::kDistance && is_hit &&
      !(answer.t <= rays.t_far && (answer.t > 0.0f || (answer.t == 0.0f && overflows_))))
    return "a distance that is none";
  if (form == Form::kDepth && !(answer.t >= 0.0f)) return "a depth that is none";
  if (!target_.profile().is_exact) return nullptr;
  // D: from inside a closed mesh every ray hits.
  if (grade_ == Grade::kClosed && !is_hit) return wanted == kNoTriangle ? "no ray from inside" : "a hole";
  // B follows from A, which is promised.
  const bool is_tie = std::binary_search(truth.float_ties.begin(), truth.float_ties.end(), answer.id);
  if (is_hit != (wanted != kNoTriangle) || (is_hit && !is_tie)) return "another triangle";
  if (answer.id != wanted) return "another triangle of the ties";
  if (form == Form::kDistance && is_hit && !is_same(answer.t, truth.t)) return "another distance";
  if (form == Form::kDepth) {
    const float depth = is_hit ? truth.t * length_of(rays.directions[ray]) : kFloatMax;
    if (!is_same(answer.t, depth)) return "another depth";
  }
  return nullptr;
}

void Judge::check(const Rays& rays, std::span<const Answer> answers, std::span<const std::size_t> only, Form form,
                  const std::string& way) {
  for (std::size_t i = 0; i < answers.size(); ++i) {
    const std::size_t ray = only.empty() ? i : only[i];
    ++checked_;
    const char* const fault = fault_of(rays, ray, answers[i], form);
    if (fault == nullptr || failures_++ != 0) continue;
    const Vec3& o = rays.origin;
    const Vec3& d = rays.directions[ray];
    ADD_FAILURE() << target_.profile().name << ", " << way << ": " << fault << ", triangle "
                  << static_cast<std::int32_t>(answers[i].id) << " for "
                  << static_cast<std::int32_t>(true_id(truth_[ray])) << " of " << truth_[ray].float_ties.size()
                  << " ties, at " << std::hexfloat << answers[i].t << " for " << truth_[ray].t << ", ray " << ray
                  << " from " << o.x << ", " << o.y << ", " << o.z << " along " << d.x << ", " << d.y << ", " << d.z;
  }
}

}  // namespace gridiron::test::hard
