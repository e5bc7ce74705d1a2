// Prints core's constants as the model's constants.h. SPDX-License-Identifier: Apache-2.0
#include <gridiron/base/records.h>
#include <gridiron/dma/tags.h>
#include <gridiron/store/local_store.h>

#include <cstdio>

int main() {
  using namespace gridiron;
  using Effects = EffectStore<EffectLayout256K<kAllEffects>>;
  const auto define = [](const char* name, unsigned value) { std::printf("#define K_%s %u\n", name, value); };
  define("TAG_COUNT", PlatformLimits{}.tag_count);
  define("SETUP_TAG", kSetupTag);
  define("FIRST_MACRO_TAG", kFirstMacroTag);
  define("MACRO_TAG_COUNT", kMacroTagCount);
  define("FIRST_TRIANGLE_TAG", kFirstTriangleTag);
  define("TRIANGLE_TAG_COUNT", kTriangleTagCount);
  define("FIRST_OUTPUT_TAG", kFirstOutputTag);
  define("OUTPUT_TAG_COUNT", kOutputTagCount);
  define("LEAST_INPUT_COMMANDS", kLeastInputCommands);
  define("QUEUE_BLOCKS", Effects::kQueueRays / Effects::kSpillBlockRays);
  define("WAVE_BLOCKS", Effects::kWaveRays / Effects::kSpillBlockRays);
}
