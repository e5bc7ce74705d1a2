// Whether a sanitizer that takes terabytes of addresses watches the program: limits of memory cannot be tested then.
// Memory: none. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define GRIDIRON_TEST_SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define GRIDIRON_TEST_SANITIZED 1
#endif
#endif
