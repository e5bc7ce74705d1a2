// The two pipes: see the header. SPDX-License-Identifier: Apache-2.0
#include <gridiron/sim/engine_work.h>
#include <pipe_model.h>

#include <algorithm>
#include <cstring>

namespace gridiron::calibrate {

namespace {

thread_local PipeModel* current_model = nullptr;

const ClassFacts& facts(OpClass op) {
  return kClassFacts[static_cast<std::size_t>(op)];
}

}  // namespace

std::uint64_t KindTotals::even() const {
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < kOpClassCount; ++i) sum += kClassFacts[i].odd ? 0 : operations[i];
  return sum;
}

std::uint64_t KindTotals::odd() const {
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < kOpClassCount; ++i) sum += kClassFacts[i].odd ? operations[i] : 0;
  return sum;
}

double KindTotals::cycles() const {
  return static_cast<double>(half_cycles) / 2 + static_cast<double>(misses * kBranchMissCycles);
}

double KindTotals::resource_cycles() const {
  std::uint64_t held = 0;
  for (std::size_t i = 0; i < kOpClassCount; ++i) held += kClassFacts[i].hold_cycles * operations[i];
  return static_cast<double>(std::max(even(), odd()) + held + misses * kBranchMissCycles);
}

double KindTotals::single_issue_cycles() const {
  return cycles() + static_cast<double>(pairs) / 2;
}

void add(KindTotals& sum, const KindTotals& more) {
  sum.units += more.units;
  sum.half_cycles += more.half_cycles;
  sum.pairs += more.pairs;
  sum.misses += more.misses;
  for (std::size_t i = 0; i < kOpClassCount; ++i) sum.operations[i] += more.operations[i];
}

void add(Branches& sum, const Branches& more) {
  for (const auto& [site, ways] : more) {
    for (std::size_t way = 0; way < 2; ++way) sum[site][way] += ways[way];
  }
}

PipeModel::PipeModel(const Branches* branches, const PipeRules& rules)
    : schedules_(branches != nullptr),
      rules_(rules),
      ready_(kRememberedNodes),
      history_(kRememberedNodes),
      depth_(kRememberedNodes),
      slots_(kStackBytes / 4),
      outer_(current_model) {
  current_model = this;
  if (branches == nullptr) return;
  for (const auto& [site, ways] : *branches) usual_[site] = ways[1] > ways[0];
}

PipeModel::~PipeModel() {
  current_model = outer_;
}

PipeModel& PipeModel::current() {
  return *current_model;
}

void PipeModel::add_units(WorkId kind, std::uint32_t amount) {
  totals_[kind.number()].units += amount;
  kind_ = kind;
  // A unit that is only a branch has no operation that could take its miss.
  if (missed_ && !sim::is_charged_as_event(kind)) charge_miss();
}

void PipeModel::charge_miss() {
  const bool is_charged = !sim::is_charged_as_event(kind_);
  ++totals_[(is_charged ? kind_ : *missed_).number()].misses;
  missed_.reset();
}

Node PipeModel::emit(OpClass op, std::uint64_t tie, Node a, Node b, Node c) {
  if (missed_) charge_miss();
  // A value is told from others by how it came about.
  std::uint64_t history = tie * 16 + static_cast<std::uint64_t>(op);
  for (const Node node : {a, b, c}) {
    const std::uint64_t before = node == 0 ? 0 : history_[node % kRememberedNodes];
    history = (history ^ (history >> 29)) * 0x9E3779B97F4A7C15u + before;
  }
  block_.push_back({op, kind_, segment_, {a, b, c}, history, false});
  const Node node = first_node_ + static_cast<Node>(block_.size()) - 1;
  history_[node % kRememberedNodes] = history;
  std::uint64_t depth = 0;
  for (const Node before : {a, b, c}) depth = std::max(depth, before == 0 ? 0 : depth_[before % kRememberedNodes]);
  depth_[node % kRememberedNodes] = depth + facts(op).latency_cycles;
  return node;
}

Node PipeModel::emit_product(std::uint64_t tie, Node a, Node b) {
  const Node node = emit(OpClass::kFloat, tie, a, b);
  block_.back().is_product = true;
  return node;
}

std::uint64_t PipeModel::ready_of(Node node) const {
  if (node == 0 || first_node_ - node >= kRememberedNodes) return 0;
  return ready_[node % kRememberedNodes];
}

void PipeModel::branch(Site site, bool taken, Node condition) {
  // A branch waits for its conditions; the operations that join several are counted with them.
  Node last = 0;
  for (const Node node : conditions_) {
    if (last == 0 || depth_[node % kRememberedNodes] > depth_[last % kRememberedNodes]) last = node;
  }
  conditions_.clear();
  const Node hint = rules_.has_hints && is_usually_taken(site) ? emit(OpClass::kHint, site) : 0;
  emit(OpClass::kBranch, site, condition, last, hint);
  ++branches_[site][taken ? 1 : 0];
  ++block_number_;
  ++segment_;
  const bool is_usual = taken == is_usually_taken(site);
  if (!schedules_ || segment_ >= rules_.superblock_branches || !is_usual) schedule();
  if (!is_usual) missed_ = kind_;
}

bool PipeModel::is_usually_taken(Site site) const {
  const auto found = usual_.find(site);
  return found != usual_.end() && found->second;
}

// Of a loop over constants, without a branch.
constexpr std::uint32_t kUnrolledTurns = 16;

void PipeModel::use_condition(bool value, Node node) {
  if (loop_ == 0) {
    conditions_.push_back(emit(OpClass::kFixed, value, node));
  } else if (turns_ == nullptr || node != 0 || ++*turns_ % kUnrolledTurns == 0) {
    branch(loop_, value, node);
  }
  loop_ = 0;
}

void PipeModel::note_address(Node node) {
  if (addresses_used_) addresses_.clear();
  addresses_used_ = false;
  addresses_.push_back(node);
}

// The latest of what is part of the address, in no order that a compiler could choose.
std::array<Node, 2> PipeModel::gather_addresses() {
  addresses_used_ = true;
  const auto later = [this](Node a, Node b) {
    if (depth_[a % kRememberedNodes] != depth_[b % kRememberedNodes]) {
      return depth_[a % kRememberedNodes] > depth_[b % kRememberedNodes];
    }
    return history_[a % kRememberedNodes] > history_[b % kRememberedNodes];
  };
  std::ranges::sort(addresses_, later);
  return {addresses_.empty() ? 0 : addresses_[0], addresses_.size() < 2 ? 0 : addresses_[1]};
}

// The register that holds a quadword of memory, loaded where it has left the registers.
PipeModel::Quad& PipeModel::quad_at(std::uintptr_t address) {
  Quad& quad = quads_[address / 16];
  if (quad.last_block == 0 || block_number_ - quad.last_block > kRegisterBlocks) {
    std::uint64_t words[2];
    std::memcpy(words, reinterpret_cast<const void*>(address / 16 * 16), sizeof(words));
    const auto [first, second] = gather_addresses();
    quad = {emit(OpClass::kLoad, words[0] * 31 + words[1], first, second), {}, block_number_};
  }
  quad.last_block = block_number_;
  return quad;
}

Node PipeModel::scalar_at(const void* pointer, std::uint64_t tie) {
  addresses_used_ = true;
  const auto address = reinterpret_cast<std::uintptr_t>(pointer);
  if (is_constant(pointer)) return 0;
  if (on_stack(address) && !slot_of(address).in_memory) return slot_of(address).node;
  Quad& quad = quad_at(address);
  const std::size_t lane = address / 4 % 4;
  if (lane == 0) return quad.node;  // a scalar lives in the first word of a register
  if (quad.lanes[lane] == 0) quad.lanes[lane] = emit(OpClass::kShuffle, tie, quad.node);
  return quad.lanes[lane];
}

void PipeModel::make_register(const void* pointer, Node node) {
  const auto address = reinterpret_cast<std::uintptr_t>(pointer);
  if (on_stack(address)) slot_of(address) = {node, false};
}

// There is no store of less than a quadword: load it, form the mask, put the scalar in, store.
void PipeModel::set_scalar(const void* pointer, Node node, std::uint64_t tie) {
  const auto address = reinterpret_cast<std::uintptr_t>(pointer);
  if (on_stack(address)) {
    slot_of(address) = {node, false};
    return;
  }
  Quad& quad = quad_at(address);
  const Node mask = emit(OpClass::kShuffle, tie, gather_addresses()[0]);
  const Node merged = emit(OpClass::kShuffle, tie, quad.node, node, mask);
  emit(OpClass::kStore, tie, merged);
  quad = {merged, {}, block_number_};
}

Node PipeModel::splat_of(const void* pointer, std::uint64_t tie) {
  addresses_used_ = true;
  const auto address = reinterpret_cast<std::uintptr_t>(pointer);
  if (is_constant(pointer)) return 0;
  if (on_stack(address) && !slot_of(address).in_memory) {
    const Node node = slot_of(address).node;
    return node == 0 ? 0 : emit(OpClass::kShuffle, tie, node);
  }
  const Node node = quad_at(address).node;
  return emit(OpClass::kShuffle, tie, node);
}

Node PipeModel::load_quad(const void* pointer, std::uint64_t tie) {
  addresses_used_ = true;
  const auto address = reinterpret_cast<std::uintptr_t>(pointer);
  if (on_stack(address) && !slot_of(address).in_memory) {
    // Scalars in registers become a vector.
    const Node low = emit(OpClass::kShuffle, tie, slot_of(address).node, slot_of(address + 4).node);
    const Node high = emit(OpClass::kShuffle, tie + 1, slot_of(address + 8).node, slot_of(address + 12).node);
    return emit(OpClass::kShuffle, tie + 2, low, high);
  }
  return quad_at(address).node;
}

void PipeModel::store_quad(const void* pointer, Node node, std::uint64_t tie) {
  const auto address = reinterpret_cast<std::uintptr_t>(pointer);
  emit(OpClass::kStore, tie, node, gather_addresses()[0]);
  quads_[address / 16] = {node, {}, block_number_};
  if (on_stack(address)) {
    for (std::uintptr_t i = 0; i < 4; ++i) slot_of(address + 4 * i) = {node, true};
  }
}

void PipeModel::forget(const void* pointer, std::size_t bytes) {
  const auto first = reinterpret_cast<std::uintptr_t>(pointer) / 16;
  for (std::uintptr_t quad = first; quad <= first + bytes / 16; ++quad) quads_.erase(quad);
}

std::vector<bool> PipeModel::fuse_products() {
  std::vector<bool> is_part(block_.size());
  if (!rules_.fuses) return is_part;
  std::vector<std::uint32_t> uses(block_.size());
  for (const Op& op : block_) {
    for (const Node node : op.deps) {
      if (node >= first_node_) ++uses[node - first_node_];
    }
  }
  for (Op& op : block_) {
    if (op.op != OpClass::kFloat || op.is_product || op.deps[2] != 0) continue;
    for (int i = 0; i < 2; ++i) {
      if (op.deps[i] < first_node_) continue;
      const std::size_t place = op.deps[i] - first_node_;
      if (!block_[place].is_product || uses[place] != 1) continue;
      is_part[place] = true;
      op.deps[2] = op.deps[1 - i];
      op.deps[0] = block_[place].deps[0];
      op.deps[1] = block_[place].deps[1];
      break;
    }
  }
  return is_part;
}

std::uint32_t PipeModel::note_pressure(const std::vector<std::uint32_t>& turns) {
  const auto count = static_cast<std::uint32_t>(block_.size());
  std::unordered_map<Node, std::uint32_t> last_use;  // turns
  for (std::uint32_t i = 0; i < count; ++i) {
    for (const Node node : block_[i].deps) {
      if (node != 0) last_use[node] = std::max(last_use[node], turns[i]);
    }
  }
  std::uint32_t kept = 0;
  for (const auto& [address, quad] : quads_) {
    if (block_number_ - quad.last_block > kRegisterBlocks) continue;
    ++kept;
    last_use.erase(quad.node);
  }
  std::vector<std::int32_t> change(count + 2);  // of the values that are needed, by turn
  for (const auto& [node, last] : last_use) {
    ++change[node < first_node_ ? 0 : turns[node - first_node_] + 1];
    --change[last + 1];
  }
  std::int32_t needed = 0, most = 0;
  for (const std::int32_t more : change) most = std::max(most, needed += more);
  const std::uint32_t registers = kept + static_cast<std::uint32_t>(most);
  ++pressure_[std::min<std::size_t>(registers, pressure_.size() - 1)];
  return registers > kRegisters ? registers - kRegisters : 0;
}

// Issues the block's operations in cycles: of those whose operands are there, the one with the longest chain behind it
// on each pipe. A branch leaves when all that stands before it has left; stores stay behind the branches before them.
void PipeModel::schedule() {
  const std::uint32_t count = static_cast<std::uint32_t>(block_.size());
  const std::uint32_t segments = segment_ + 1;
  segment_ = 0;
  if (!schedules_ || count == 0) {
    first_node_ += count;
    block_.clear();
    return;
  }
  const std::vector<bool> is_part = fuse_products();
  std::vector<std::uint32_t> turns(rules_.has_spills ? count : 0);
  std::uint32_t turn = 0;
  height_.assign(count, 0);
  earliest_.assign(count, 0);
  missing_.assign(count, 0);
  first_successor_.assign(count + 1, 0);
  left_in_segment_.assign(segments, 0);
  const auto in_block = [&](Node node) { return node >= first_node_; };

  // 1. Who waits for whom, and how long the chains are.
  for (std::uint32_t i = 0; i < count; ++i) {
    if (is_part[i]) continue;
    if (block_[i].op != OpClass::kBranch) ++left_in_segment_[block_[i].segment];
    for (const Node node : block_[i].deps) {
      if (in_block(node)) {
        ++missing_[i];
        ++first_successor_[node - first_node_ + 1];
      } else {
        earliest_[i] = std::max(earliest_[i], ready_of(node));
      }
    }
  }
  for (std::uint32_t i = 0; i < count; ++i) first_successor_[i + 1] += first_successor_[i];
  successors_.assign(first_successor_[count], 0);
  candidates_.assign(first_successor_.begin(), first_successor_.end());
  for (std::uint32_t i = 0; i < count; ++i) {
    if (is_part[i]) continue;
    for (const Node node : block_[i].deps) {
      if (in_block(node)) successors_[candidates_[node - first_node_]++] = i;
    }
  }
  for (std::uint32_t i = count; i-- > 0;) {
    std::uint64_t behind = 0;
    for (std::uint32_t s = first_successor_[i]; s < first_successor_[i + 1]; ++s) {
      behind = std::max(behind, height_[successors_[s]]);
    }
    height_[i] = behind + facts(block_[i].op).latency_cycles;
  }

  // 2. Cycle by cycle.
  candidates_.clear();
  for (std::uint32_t i = 0; i < count; ++i) {
    if (missing_[i] == 0 && !is_part[i]) candidates_.push_back(i);
  }
  constexpr std::uint32_t kNone = 0xFFFFFFFFu;
  // What stands earlier on the path comes first: a branch must not wait for what may not even be needed.
  const auto before = [&](std::uint32_t a, std::uint32_t b) {
    if (b == kNone) return true;
    if (block_[a].segment != block_[b].segment) return block_[a].segment < block_[b].segment;
    if (height_[a] != height_[b]) return height_[a] > height_[b];
    return block_[a].tie < block_[b].tie;
  };
  std::uint32_t open_segment = 0;  // the first whose branch has not left
  const auto may_leave = [&](std::uint32_t i) {
    const Op& op = block_[i];
    if (op.op == OpClass::kBranch) return op.segment == open_segment && left_in_segment_[open_segment] == 0;
    return op.op != OpClass::kStore || op.segment == open_segment;
  };
  const auto totals_of = [&](std::uint32_t i) -> KindTotals& { return totals_[block_[i].kind.number()]; };
  while (!candidates_.empty()) {
    std::uint64_t cycle = ~std::uint64_t{0};
    for (const std::uint32_t i : candidates_) {
      if (may_leave(i)) cycle = std::min(cycle, earliest_[i]);
    }
    cycle = std::max(cycle, clock_ + 1);
    std::uint32_t chosen[2] = {kNone, kNone};
    for (const std::uint32_t i : candidates_) {
      std::uint32_t& pipe = chosen[facts(block_[i].op).odd ? 1 : 0];
      if (earliest_[i] <= cycle && may_leave(i) && before(i, pipe)) pipe = i;
    }
    // The last of a segment takes its branch with it, where the odd pipe is free.
    if (chosen[1] == kNone && left_in_segment_[block_[chosen[0]].segment] == 1 &&
        block_[chosen[0]].segment == open_segment && facts(block_[chosen[0]].op).hold_cycles == 0) {
      for (const std::uint32_t i : candidates_) {
        if (block_[i].op == OpClass::kBranch && block_[i].segment == open_segment && earliest_[i] <= cycle) {
          chosen[1] = i;
        }
      }
    }
    const std::uint64_t elapsed = cycle - clock_;
    const bool both = chosen[0] != kNone && chosen[1] != kNone;
    std::uint64_t held = 0;
    for (const std::uint32_t i : chosen) {
      if (i == kNone) continue;
      const std::uint32_t hold = facts(block_[i].op).hold_cycles;
      held = std::max<std::uint64_t>(held, hold);
      totals_of(i).half_cycles += (both ? elapsed : 2 * elapsed) + 2 * hold;
      if (both) ++totals_of(i).pairs;
      ++totals_of(i).operations[static_cast<std::size_t>(block_[i].op)];
      std::erase(candidates_, i);
      if (rules_.has_spills) turns[i] = turn++;
      if (block_[i].op == OpClass::kBranch) {
        ++open_segment;
      } else {
        --left_in_segment_[block_[i].segment];
      }
    }
    for (const std::uint32_t i : chosen) {
      if (i == kNone) continue;
      const std::uint64_t done = cycle + facts(block_[i].op).latency_cycles;
      ready_[(first_node_ + i) % kRememberedNodes] = done;
      for (std::uint32_t s = first_successor_[i]; s < first_successor_[i + 1]; ++s) {
        const std::uint32_t next = successors_[s];
        earliest_[next] = std::max(earliest_[next], done);
        if (--missing_[next] == 0) candidates_.push_back(next);
      }
    }
    clock_ = cycle + held;
  }
  // Stored and loaded again, in the odd pipe.
  if (rules_.has_spills) totals_of(count - 1).half_cycles += 4 * std::uint64_t{note_pressure(turns)};
  first_node_ += count;
  block_.clear();
}

Counts PipeModel::finish() {
  schedule();
  if (missed_) charge_miss();
  return {totals_, pressure_};
}

}  // namespace gridiron::calibrate
