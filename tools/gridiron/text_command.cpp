// Help and version. SPDX-License-Identifier: Apache-2.0
#include <cstdio>

#include "commands.h"

namespace gridiron::tool {

void run_command(const TextRequest& request) {
  std::fputs(request.text.c_str(), stdout);
}

}  // namespace gridiron::tool
