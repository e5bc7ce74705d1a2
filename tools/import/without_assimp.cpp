// Import in a build without Assimp. SPDX-License-Identifier: Apache-2.0
#include "import/import_child.h"
#include "import/model_import.h"
#include "import/model_stream.h"

namespace gridiron::tool {

ImportedModel read_with_assimp(std::span<const std::byte>, const ChildSettings&) {
  throw ImportError("this program was built without Assimp");
}

}  // namespace gridiron::tool
