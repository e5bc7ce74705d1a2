// Borrowed region. SPDX-License-Identifier: Apache-2.0
#include <gridiron/base/math.h>
#include <gridiron/sim/borrowed_region.h>

#include <cstdint>
#include <cstring>
#include <new>

#if __has_include(<sys/mman.h>)
#include <sys/mman.h>
#include <unistd.h>
#endif

namespace gridiron::sim {

bool borrow_bytes(const MemoryRegion& region, std::span<std::byte> shared) {
  std::byte* const own = region.bytes.data();
  const std::size_t bytes = region.bytes.size();
#if defined(MREMAP_FIXED)
  const auto page = static_cast<std::uintptr_t>(::sysconf(_SC_PAGESIZE));
  const auto address = reinterpret_cast<std::uintptr_t>(own);
  const std::size_t front = static_cast<std::size_t>(round_up(address, page) - address);
  const std::size_t whole = bytes > front ? (bytes - front) / page * page : 0;
  if (whole != 0 && reinterpret_cast<std::uintptr_t>(shared.data() + front) % page == 0) {
    // An old size of 0 maps the same pages once more, anywhere: a failure at a fixed place may leave a hole there.
    void* const mapped = ::mremap(shared.data() + front, 0, whole, MREMAP_MAYMOVE);
    if (mapped != MAP_FAILED) {
      if (::mremap(mapped, whole, whole, MREMAP_MAYMOVE | MREMAP_FIXED, own + front) == MAP_FAILED) {
        throw std::bad_alloc();
      }
      (void)::mprotect(own + front, whole, PROT_READ);
      std::memcpy(own, shared.data(), front);
      std::memcpy(own + front + whole, shared.data() + front + whole, bytes - front - whole);
      return true;
    }
  }
#endif
  std::memcpy(own, shared.data(), bytes);
  return false;
}

}  // namespace gridiron::sim
