// Transfers of the counted kernel, found before core's: bytes arrive at once. What commands and waits cost is
// MachineProfile::issue_cycles and wait_cycles, so nothing is counted in here.
// Memory: borrowed. Threads: the model's. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gridiron/dma/tags.h>

namespace gridiron {

template <class P>
class Transfers {
 public:
  Transfers(P& platform, WorkCounters&) : platform_(platform) {}

  [[nodiscard]] auto queue_depth() const { return platform_.limits().queue_depth; }
  template <class Count>
  void reserve_for_output(const Count&) {}

  template <class Bytes, class TagIndex>
  [[nodiscard]] Status get(void* local, const MainAddress& address, const Bytes& bytes, const TagIndex&) {
    PipeModel::current().forget(local, plain(bytes));
    return platform_.get(local, {address.value.value}, plain(bytes), {});
  }
  template <class Bytes, class TagIndex>
  [[nodiscard]] Status put(const void* local, const MainAddress& address, const Bytes& bytes, const TagIndex&) {
    return platform_.put(local, {address.value.value}, plain(bytes), {});
  }
  template <class TagIndex>
  [[nodiscard]] Status wait(const TagIndex&) {
    return Status::kOk;
  }
  void note_stage(Stage) {}
  [[nodiscard]] ItemClaim claim_item() { return platform_.claim_item(); }

 private:
  P& platform_;
};

}  // namespace gridiron
