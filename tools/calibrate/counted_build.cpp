// Runs counted passes of a build: see the header. SPDX-License-Identifier: Apache-2.0
#include <gridiron/build/passes/build_passes.h>
// clang-format off
#include <counted/host_numbers.h>  // behind it
// clang-format on

#include <cstring>
#include <stdexcept>

// The pass that checks an image is not counted, and never runs.
namespace gridiron_counted {
CheckValue::CheckValue() {
  throw std::logic_error("calibration: an image is not checked here");
}
void CheckValue::add(std::span<const std::byte>) {}
Counted<std::uint64_t> CheckValue::value() const {
  return 0;
}
}  // namespace gridiron_counted

namespace gridiron::calibrate {
namespace {

namespace twin = gridiron_counted;

// noinline: see counted_kernel.cpp.
template <class Layout>
__attribute__((noinline)) void build(const CountedPass& pass, PipeModel& model) {
  using Store = twin::BuildStore<Layout>;
  const LineBytes bytes(sizeof(Store)), plan_bytes(sizeof(twin::BuildPlan));
  Store& store = *reinterpret_cast<Store*>(bytes.bytes().data());
  model.set_store(&store, sizeof(store));
  // What a plan says is constant.
  if (pass.plan.size() != sizeof(twin::BuildPlan)) throw std::runtime_error("calibration: another plan");
  std::memcpy(plan_bytes.bytes().data(), pass.plan.data(), pass.plan.size());
  const auto& plan = *reinterpret_cast<const twin::BuildPlan*>(plan_bytes.bytes().data());
  CopyCore core(pass.memory, pass.items);
  require(twin::run_build_pass(core, store, plan, static_cast<twin::BuildPass>(pass.number)));
}

}  // namespace

Branches branches_of(const CountedPass& pass) {
  const int stack_base = 0;
  PipeModel model(nullptr);
  model.set_stack(&stack_base);
  build<twin::BuildLayout256K>(pass, model);
  return model.branches();
}

Counts run_counted(const CountedPass& pass, const Branches& usual, const PipeRules& rules) {
  const int stack_base = 0;
  PipeModel model(&usual, rules);
  model.set_stack(&stack_base);
  build<twin::BuildLayout256K>(pass, model);
  return model.finish();
}

}  // namespace gridiron::calibrate
