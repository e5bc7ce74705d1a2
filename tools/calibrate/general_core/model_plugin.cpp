// A plugin of QEMU 7.2's user emulation: gives each executed instruction to the core model and prints what each step of
// building took. Argument: out=FILE. The interface is declared here, as the packaged emulator comes without its header.
// Memory: a decoded instruction for each translated one. Threads: one. SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstdio>
#include <cstring>
#include <deque>
#include <string>
#include <vector>

#include "core_model.h"
#include "riscv_decoder.h"

extern "C" {
using qemu_plugin_id_t = std::uint64_t;
using qemu_plugin_meminfo_t = std::uint32_t;
struct qemu_info_t;
struct qemu_plugin_tb;
struct qemu_plugin_insn;
enum qemu_plugin_cb_flags { QEMU_PLUGIN_CB_NO_REGS };
enum qemu_plugin_mem_rw { QEMU_PLUGIN_MEM_R = 1, QEMU_PLUGIN_MEM_W, QEMU_PLUGIN_MEM_RW };

void qemu_plugin_register_vcpu_tb_trans_cb(qemu_plugin_id_t, void (*)(qemu_plugin_id_t, qemu_plugin_tb*));
void qemu_plugin_register_vcpu_tb_exec_cb(qemu_plugin_tb*, void (*)(unsigned, void*), qemu_plugin_cb_flags, void*);
void qemu_plugin_register_vcpu_mem_cb(qemu_plugin_insn*,
                                      void (*)(unsigned, qemu_plugin_meminfo_t, std::uint64_t, void*),
                                      qemu_plugin_cb_flags, qemu_plugin_mem_rw, void*);
void qemu_plugin_register_atexit_cb(qemu_plugin_id_t, void (*)(qemu_plugin_id_t, void*), void*);
std::size_t qemu_plugin_tb_n_insns(const qemu_plugin_tb*);
qemu_plugin_insn* qemu_plugin_tb_get_insn(const qemu_plugin_tb*, std::size_t);
const void* qemu_plugin_insn_data(const qemu_plugin_insn*);
std::size_t qemu_plugin_insn_size(const qemu_plugin_insn*);
std::uint64_t qemu_plugin_insn_vaddr(const qemu_plugin_insn*);
unsigned qemu_plugin_mem_size_shift(qemu_plugin_meminfo_t);

[[gnu::visibility("default")]] int qemu_plugin_version = 1;
}

namespace {

using namespace gridiron::general_core;

constexpr std::uint32_t kNoMark = 127, kMarks = 256;  // as in gridiron/build/build_step.h

struct Step {
  Instruction instruction;
  std::uint64_t next = 0;  // address of the one behind it
  std::int32_t mark = -1;
};
struct Block {
  std::vector<Step> steps;
  bool has_marks = false;
};

struct Access {
  const Step* step;
  Event event;
};

std::deque<Block> blocks;
const Block* running = nullptr;  // its instructions are executed, but not yet given to the model
std::vector<Access> accesses;    // of them
CoreModel model;
std::uint32_t current = kNoMark;
std::array<Counts, kMarks> by_mark;
Counts before;
std::string out_path;

void charge() {
  const Counts& now = model.counts();
  Counts& sum = by_mark[current];
  sum.instructions += now.instructions - before.instructions;
  sum.cycles += now.cycles - before.cycles;
  sum.branch_misses += now.branch_misses - before.branch_misses;
  sum.lines_waited += now.lines_waited - before.lines_waited;
  sum.lines_streamed += now.lines_streamed - before.lines_streamed;
  before = now;
}

// A block is given to the model when the next one begins: then it is known which way its branch went.
void flush(std::uint64_t next_address) {
  // What no builder does is not looked at.
  if (running == nullptr || (current == kNoMark && !running->has_marks)) {
    accesses.clear();
    return;
  }
  auto access = accesses.begin();
  for (const Step& step : running->steps) {
    if (step.mark >= 0) {
      charge();
      current = static_cast<std::uint32_t>(step.mark) % kMarks;
      continue;
    }
    if (current == kNoMark) continue;
    Event event;
    for (; access != accesses.end() && access->step == &step; ++access) event = access->event;
    event.taken = &step == &running->steps.back() && next_address != step.next;
    model.execute(step.instruction, event);
  }
  accesses.clear();
}

void on_block(unsigned, void* data) {
  const auto* block = static_cast<const Block*>(data);
  flush(block->steps.front().instruction.address);
  running = block;
}

void on_access(unsigned, qemu_plugin_meminfo_t info, std::uint64_t address, void* data) {
  accesses.push_back({static_cast<const Step*>(data), {address, 1u << qemu_plugin_mem_size_shift(info), false}});
}

void on_translation(qemu_plugin_id_t, qemu_plugin_tb* translated) {
  const std::size_t count = qemu_plugin_tb_n_insns(translated);
  Block& block = blocks.emplace_back();
  block.steps.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    qemu_plugin_insn* const instruction = qemu_plugin_tb_get_insn(translated, i);
    const std::size_t bytes = qemu_plugin_insn_size(instruction);
    const std::uint64_t address = qemu_plugin_insn_vaddr(instruction);
    std::uint32_t code = 0;
    std::memcpy(&code, qemu_plugin_insn_data(instruction), bytes);
    Step& step = block.steps[i];
    step.instruction = decode(code, address);
    step.next = address + bytes;
    if (const auto mark = mark_of(code)) {
      step.mark = static_cast<std::int32_t>(*mark);
      block.has_marks = true;
    }
    qemu_plugin_register_vcpu_mem_cb(instruction, on_access, QEMU_PLUGIN_CB_NO_REGS, QEMU_PLUGIN_MEM_RW, &step);
  }
  qemu_plugin_register_vcpu_tb_exec_cb(translated, on_block, QEMU_PLUGIN_CB_NO_REGS, &block);
}

void on_exit(qemu_plugin_id_t, void*) {
  flush(0);
  charge();
  std::FILE* const file = std::fopen(out_path.c_str(), "w");
  if (file == nullptr) return;
  for (std::uint32_t mark = kNoMark; mark < kMarks; ++mark) {
    const Counts& sum = by_mark[mark];
    if (sum.instructions == 0) continue;
    std::fprintf(file, "step %d %llu %llu %llu %llu %llu\n", static_cast<int>(mark) - 128,
                 static_cast<unsigned long long>(sum.instructions), static_cast<unsigned long long>(sum.cycles),
                 static_cast<unsigned long long>(sum.branch_misses), static_cast<unsigned long long>(sum.lines_waited),
                 static_cast<unsigned long long>(sum.lines_streamed));
  }
  std::fclose(file);
}

}  // namespace

extern "C" [[gnu::visibility("default")]] int qemu_plugin_install(qemu_plugin_id_t id, const qemu_info_t*, int argc,
                                                                  char** argv) {
  for (int i = 0; i < argc; ++i) {
    if (std::strncmp(argv[i], "out=", 4) == 0) out_path = argv[i] + 4;
  }
  if (out_path.empty()) return 1;
  qemu_plugin_register_vcpu_tb_trans_cb(id, on_translation);
  qemu_plugin_register_atexit_cb(id, on_exit, nullptr);
  return 0;
}
