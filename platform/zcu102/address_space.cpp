// The page tables of the master and of the worker cores.
// Source: Arm Architecture Reference Manual for A-profile (DDI 0487), VMSAv8-64.
// Memory: section .master. Threads: core 0, MMU off, before the others start. SPDX-License-Identifier: Apache-2.0
#include "address_space.h"

#include <cstdint>

#include "cache.h"
#include "memory_map.h"

extern "C" {
// zcu102.ld
extern const char code_begin[], code_end[], constants_end[], data_begin[], data_end[], cleared_begin[], master_begin[],
    master_end[];

void build_spaces();
std::uint64_t master_root();
std::uint64_t worker_root(std::uint32_t core);
}

namespace gridiron::port {
namespace {

constexpr std::uint64_t kPageBytes = 4096;
constexpr std::uint64_t kBlockBytes = 0x200000;
constexpr std::uint64_t kIsTable = 3;
constexpr std::uint64_t kIsPage = 3;
constexpr std::uint64_t kIsBlock = 1;
constexpr std::uint64_t kAccessed = 1u << 10;
constexpr std::uint64_t kAddressBits = 0x0000'FFFF'FFFF'F000;

[[gnu::section(".master.spaces")]] AddressSpace spaces[1 + kCoreCount];

bool map_between(AddressSpace& space, const char* begin, const char* end, Rights rights) {
  const std::uint64_t address = reinterpret_cast<std::uintptr_t>(begin);
  return space.map(address, reinterpret_cast<std::uintptr_t>(end) - address, rights);
}

// Maps what master and workers share: the program, their messages, the console.
bool map_common(AddressSpace& space) {
  return map_between(space, code_begin, code_end, Rights::kCode) &&
         map_between(space, code_end, constants_end, Rights::kConstants) &&
         map_between(space, data_begin, data_end, Rights::kData) &&
         space.map(kUartAddress, kRegisterPageBytes, Rights::kRegisters);
}

// Maps what the master needs to read the job, write its result and start the cores.
bool map_master(AddressSpace& space) {
  return map_between(space, master_begin, master_end, Rights::kData) &&
         space.map(kJobAddress, kMainMemoryEnd - kJobAddress, Rights::kData) &&
         space.map(kResetAddress, kRegisterPageBytes, Rights::kRegisters) &&
         space.map(kApuAddress, kRegisterPageBytes, Rights::kRegisters);
}

// Maps a worker's arena and its DMA channel. It reaches main memory only by DMA.
bool map_worker(AddressSpace& space, std::uint32_t core) {
  return space.map(kOnChipAddress + std::uint64_t{core} * kArenaBytes, kArenaBytes, Rights::kData) &&
         space.map(kGdmaAddress + core * kGdmaChannelBytes, kRegisterPageBytes, Rights::kRegisters);
}

// The clearing and building above bypassed the caches, so lines that they hold from before are old.
void forget_old_lines() {
  invalidate(reinterpret_cast<std::uintptr_t>(cleared_begin), static_cast<std::uint64_t>(master_end - cleared_begin));
}

}  // namespace

AddressSpace::Table* AddressSpace::next_table(std::uint64_t& entry) {
  if (entry == 0) {
    if (used_ + 1 == kTableCount) return nullptr;
    ++used_;
    entry = reinterpret_cast<std::uintptr_t>(&tables_[used_]) | kIsTable;
  }
  return reinterpret_cast<Table*>(static_cast<std::uintptr_t>(entry & kAddressBits));
}

bool AddressSpace::map(std::uint64_t address, std::uint64_t bytes, Rights rights) {
  const std::uint64_t bits = static_cast<std::uint64_t>(rights) | kAccessed;
  for (const std::uint64_t end = address + bytes; address < end;) {
    Table* const middle = next_table(tables_[0].entries[address >> 30]);
    if (middle == nullptr) return false;
    std::uint64_t& entry = middle->entries[address >> 21 & 511];
    if (entry == 0 && address % kBlockBytes == 0 && end - address >= kBlockBytes) {
      entry = address | bits | kIsBlock;
      address += kBlockBytes;
      continue;
    }
    Table* const last = next_table(entry);
    if (last == nullptr) return false;
    last->entries[address >> 12 & 511] = address | bits | kIsPage;
    address += kPageBytes;
  }
  return true;
}

}  // namespace gridiron::port

// Called by start.S.

void build_spaces() {
  using namespace gridiron::port;
  // The master is core 0, so it also gets that core's own mappings.
  bool is_mapped = map_common(spaces[0]) && map_master(spaces[0]) && map_worker(spaces[0], 0);
  for (std::uint32_t core = 0; core < kCoreCount; ++core) {
    is_mapped = is_mapped && map_common(spaces[1 + core]) && map_worker(spaces[1 + core], core);
  }
  if (!is_mapped) __builtin_trap();
  forget_old_lines();
}

std::uint64_t master_root() { return gridiron::port::spaces[0].root(); }
std::uint64_t worker_root(std::uint32_t core) { return gridiron::port::spaces[1 + core].root(); }
