// Runs the counted kernel: see the header. SPDX-License-Identifier: Apache-2.0
#include <gridiron/base/exact_sum.h>
#include <gridiron/bvh/bvh_core.h>
#include <gridiron/render/tile_renderer.h>
// clang-format off
#include <counted/host_numbers.h>  // behind them
// clang-format on

namespace gridiron::calibrate {
namespace {

namespace twin = gridiron_counted;
using twin::Counted;

// noinline, as everything that the model sees: what it puts on the stack is below the model's stack base.
template <class Store>
__attribute__((noinline)) void render(const CountedRun& run, PipeModel& model) {
  LineBytes bytes(sizeof(Store));
  Store& store = *reinterpret_cast<Store*>(bytes.bytes().data());
  model.set_store(&store, sizeof(store));
  CopyCore core(run.memory, run.tiles);
  require(twin::render_tiles<twin::Lanes<4>>(store, core, twin::MainAddress{0},
                                             {twin::MainAddress{run.spill_address}, run.spill_bytes}));
}

void render_program(const CountedRun& run, PipeModel& model) {
  switch (run.program) {
    case CountedProgram::kPackets8:
      return render<twin::LocalStore<twin::StoreLayout256K<8>>>(run, model);
    case CountedProgram::kPackets32:
      return render<twin::LocalStore<twin::StoreLayout256K<32>>>(run, model);
    case CountedProgram::kTree:
      return render<twin::LocalStore<twin::TreeLayout256K<32>>>(run, model);
    case CountedProgram::kEffects:
      return render<twin::LocalStore<twin::EffectLayout256K<twin::kAllEffects, 32>>>(run, model);
    case CountedProgram::kBvh:
      return render<twin::bvh::BvhStore>(run, model);
  }
}

// Reading the input is the caller's work.
void load(Counted<float> (&to)[3], const float (&from)[3]) {
  for (int i = 0; i < 3; ++i) {
    to[i] = Counted<float>::made(from[i], twin::emit(OpClass::kLoad, twin::bits_of(from[i])));
  }
}

__attribute__((noinline)) void decide(std::span<const ExactDecision> decisions, PipeModel& model) {
  for (const ExactDecision& decision : decisions) {
    Counted<float> eye[3], direction[3], a[3], b[3], c[3];
    model.charge_to(Work::kWait);
    load(eye, decision.eye);
    load(a, decision.a);
    load(b, decision.b);
    load(c, decision.c);
    load(direction, decision.direction);
    model.add_units(Work::kExactSign, 1);
    (void)twin::exact_edge_sign(eye, direction, a, b);
    model.add_units(Work::kExactDistance, 1);
    (void)twin::exact_distance(eye, direction, a, b, c);
    Counted<float> first[3][3], second[3][3];
    for (int axis = 0; axis < 3; ++axis) {
      first[0][axis] = a[axis], first[1][axis] = b[axis], first[2][axis] = c[axis];
      second[0][axis] = b[axis], second[1][axis] = c[axis], second[2][axis] = a[axis];
    }
    model.add_units(Work::kExactOrder, 1);
    (void)twin::exact_distance_order(eye, direction, first, second);
  }
}

template <class Run>
Branches learn(const Run& run) {
  const int stack_base = 0;
  PipeModel model(nullptr);
  model.set_stack(&stack_base);
  run(model);
  return model.branches();
}
template <class Run>
Counts count(const Run& run, const Branches& usual, const PipeRules& rules) {
  const int stack_base = 0;
  PipeModel model(&usual, rules);
  model.set_stack(&stack_base);
  run(model);
  return model.finish();
}

}  // namespace

Branches branches_of(const CountedRun& run) {
  return learn([&](PipeModel& model) { render_program(run, model); });
}

Counts run_counted(const CountedRun& run, const Branches& usual, const PipeRules& rules) {
  return count([&](PipeModel& model) { render_program(run, model); }, usual, rules);
}

Totals count_decisions(std::span<const ExactDecision> decisions, const PipeRules& rules) {
  const auto decide_all = [&](PipeModel& model) { decide(decisions, model); };
  return count(decide_all, learn(decide_all), rules).totals;
}

}  // namespace gridiron::calibrate
