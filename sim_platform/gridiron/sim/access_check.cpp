// The accesses of instrumented code: each must lie in memory that the core may touch, apart from pending transfers.
// Memory: borrowed. Threads: a core for each thread. SPDX-License-Identifier: Apache-2.0
#include <gridiron/sim/byte_ranges.h>
#include <gridiron/sim/sim_core.h>
#include <link.h>
#include <pthread.h>

#include <algorithm>
#include <utility>

namespace gridiron::sim {

namespace {

thread_local SimCore* current_core = nullptr;

constexpr std::uint8_t kFree = 0, kGetInFlight = 1, kPutInFlight = 2;

// Read-only data of the program and its libraries, and where the program itself was loaded.
struct ReadOnlyData {
  std::vector<std::pair<std::uintptr_t, std::uintptr_t>> ranges;
  std::uintptr_t load_address = 0;

  ReadOnlyData() {
    dl_iterate_phdr(
        [](dl_phdr_info* info, std::size_t, void* self) {
          auto& data = *static_cast<ReadOnlyData*>(self);
          if (data.ranges.empty()) data.load_address = info->dlpi_addr;
          for (int i = 0; i < info->dlpi_phnum; ++i) {
            const auto& header = info->dlpi_phdr[i];
            const bool constant = header.p_type == PT_LOAD && (header.p_flags & PF_W) == 0;
            if (!constant && header.p_type != PT_GNU_RELRO) continue;
            const std::uintptr_t begin = info->dlpi_addr + header.p_vaddr;
            data.ranges.emplace_back(begin, begin + header.p_memsz);
          }
          return 0;
        },
        this);
  }
};

const ReadOnlyData& read_only_data() {
  static const ReadOnlyData data;
  return data;
}

std::uintptr_t stack_bottom() {
  pthread_attr_t attributes;
  void* address = nullptr;
  std::size_t bytes = 0;
  if (pthread_getattr_np(pthread_self(), &attributes) != 0) return 0;
  pthread_attr_getstack(&attributes, &address, &bytes);
  pthread_attr_destroy(&attributes);
  return reinterpret_cast<std::uintptr_t>(address);
}

}  // namespace

SimCore::AccessScope::AccessScope(SimCore& core, const void* stack_top) : outer_(current_core) {
  static_cast<void>(read_only_data());
  core.granule_state_.assign(core.arena_.size() / kGranuleBytes + 1, kFree);
  core.stack_bottom_ = stack_bottom();
  core.stack_top_ = reinterpret_cast<std::uintptr_t>(stack_top);
  current_core = &core;
}

SimCore::AccessScope::~AccessScope() {
  current_core = outer_;
}

void SimCore::mark(const Pending& pending) {
  if (granule_state_.empty()) return;
  const std::uint8_t state = !pending.in_use ? kFree : pending.is_get ? kGetInFlight : kPutInFlight;
  const auto offset = static_cast<std::size_t>(pending.local - arena_.data());
  const std::size_t first = offset / kGranuleBytes;
  const std::size_t end = (offset + pending.bytes + kGranuleBytes - 1) / kGranuleBytes;
  for (std::size_t i = first; i < end; ++i) granule_state_[i] = state;
}

void SimCore::unmark(Pending& pending) {
  pending.in_use = false;
  mark(pending);
  // Sources of two puts may share granules, and small transfers too.
  for (const Pending& other : pending_) {
    if (other.in_use) mark(other);
  }
}

void SimCore::bad_access(std::uintptr_t address, std::uintptr_t bytes, bool is_store, std::uintptr_t code,
                         const char* what) {
  // A loop repeats itself; each instruction is told once.
  if (std::find(bad_code_.begin(), bad_code_.end(), code) != bad_code_.end()) return;
  if (bad_code_.size() == kMaxViolations / 2) return;
  bad_code_.push_back(code);
  sticky_error_ = violate(Status::kBadAccess, tile_id_,
                          std::string(is_store ? "store" : "load") + " of " + std::to_string(bytes) + " bytes at " +
                              describe_local(address) + ": " + what + " (instruction " +
                              hex(code - read_only_data().load_address) + ")");
}

void SimCore::check_access(std::uintptr_t address, std::uintptr_t bytes, bool is_store, std::uintptr_t code) {
  SimCore* const core = current_core;
  if (core == nullptr || bytes == 0) return;
  const std::uintptr_t arena = reinterpret_cast<std::uintptr_t>(core->arena_.data());
  const std::size_t arena_bytes = core->arena_.size();
  const std::uintptr_t offset = address - arena;
  if (offset < arena_bytes && bytes <= arena_bytes - offset) {
    const std::size_t first = offset / kGranuleBytes;
    const std::size_t last = (offset + bytes - 1) / kGranuleBytes;
    for (std::size_t i = first; i <= last; ++i) {
      if (core->granule_state_[i] == kFree) continue;
      // A granule can be larger than a transfer: ask the transfers themselves.
      for (const Pending& pending : core->pending_) {
        if (!pending.in_use || !(pending.is_get || is_store)) continue;
        if (!overlap(address, bytes, address_of(pending.local), pending.bytes)) continue;
        core->bad_access(address, bytes, is_store, code,
                         pending.is_get ? "destination of a get that was not waited for"
                                        : "source of a put that was not waited for");
        return;
      }
    }
    return;
  }
  if (address >= core->stack_bottom_ && address < core->stack_top_ && bytes <= core->stack_top_ - address) return;
  if (!is_store) {
    for (const auto& [begin, end] : read_only_data().ranges) {
      if (address >= begin && address < end && bytes <= end - address) return;
    }
  }
  core->bad_access(address, bytes, is_store, code, "outside the arena, the stack and constant data");
}

}  // namespace gridiron::sim
