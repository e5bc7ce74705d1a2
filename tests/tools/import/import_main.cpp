// main of the tests of models: the program under test starts itself as the child, and here that is this one.
// SPDX-License-Identifier: Apache-2.0
#include "import/model_import.h"
#include "support/test_headers.h"

int main(int count, char** values) {
  if (const std::optional<int> code = gridiron::tool::serve_import(count, values)) return *code;
  testing::InitGoogleTest(&count, values);
  return RUN_ALL_TESTS();
}
