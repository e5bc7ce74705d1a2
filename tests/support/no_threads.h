// No threads: a host that cannot start one.
// Memory: none. Threads: changes a default of the process; one at a time. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pthread.h>

#include "support/test_headers.h"

namespace gridiron::test {

/// While one lives, starting a thread fails: the stack that it would get by default is larger than any address space.
class NoThreads {
 public:
  NoThreads() {
    pthread_getattr_default_np(&usual_);
    pthread_attr_t huge;
    pthread_getattr_default_np(&huge);
    EXPECT_EQ(pthread_attr_setstacksize(&huge, std::size_t{1} << 62), 0);
    EXPECT_EQ(pthread_setattr_default_np(&huge), 0);
    pthread_attr_destroy(&huge);
  }
  ~NoThreads() {
    EXPECT_EQ(pthread_setattr_default_np(&usual_), 0);
    pthread_attr_destroy(&usual_);
  }
  NoThreads(const NoThreads&) = delete;
  NoThreads& operator=(const NoThreads&) = delete;

 private:
  pthread_attr_t usual_;
};

}  // namespace gridiron::test
