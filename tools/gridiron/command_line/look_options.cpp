// Options of a look: what a mesh gets besides its triangles. SPDX-License-Identifier: Apache-2.0
#include <string>
#include <vector>

#include "gridiron/scene/look.h"
#include "options.h"

namespace gridiron::tool {
namespace {

std::optional<std::uint32_t> parse_samples(const std::string& text) {
  const std::optional<std::uint32_t> count = parse_count(text);
  return count && (*count == 1 || *count == 4 || *count == 16) ? count : std::nullopt;
}

std::optional<float> parse_degrees(const std::string& text) {
  const std::optional<float> value = parse_float(text);
  return value && *value >= 0.0f && *value <= 180.0f ? value : std::nullopt;
}

}  // namespace

void add_look_options(CLI::App& app, LookRequest& look) {
  const std::vector<std::string> colors(color_names().begin(), color_names().end());
  std::string color = "RRGGBB in hexadecimal, or";
  for (const std::string& name : colors) color += (name == colors.front() ? " " : ", ") + name;
  add_choice(
      app, "--look", look.is_studio, Choices<bool>{{"studio", true}},
      "put a mesh on a ground, with a key light, a large light, ambient occlusion, smooth normals and 4 samples a "
      "pixel; each part can be set by itself, with this option or without it");
  CLI::Option* own =
      add_parsed(app, "--color", look.color, parse_color, color, "COLOR", "of the mesh, in place of its own");
  CLI::Option* behind = add_parsed(app, "--background", look.background, parse_color, color, "COLOR",
                                   "where no ray hits anything (default: the colour of the lit ground)");
  for (CLI::Option* option : {own, behind}) set_offer(*option, {.words = colors, .endings = {}});
  add_choice(app, "--ground", look.ground, Choices<bool>{{"on", true}, {"off", false}}, "a ground below the mesh");
  add_parsed(app, "--light", look.lights, parse_lights, "none, or a list of head, key and area with commas", "LIST",
             "head: a light at the eye (default without --look); key: from the left; area: a large one from the right",
             {"none", "head", "key", "area", "key,area", "head,key,area"});
  add_count(app, "--ao", look.occlusion, 0, kMostEffectSamples, "rays of ambient occlusion from each point, 0: none");
  add_parsed(app, "--samples", look.samples, parse_samples, "1, 4 or 16", "N", "eye rays of each pixel",
             {"1", "4", "16"});
  add_parsed(
      app, "--smooth", look.smooth_degrees, parse_degrees, "an angle from 0 to 180 degrees", "ANGLE",
      "smooth normals across edges that bend by at most ANGLE degrees; 0: facets (studio: the file's normals, or "
      "35)");
  add_choice(app, "--levels", look.levels,
             Choices<ColorLevels>{{"linear", ColorLevels::kLinear}, {"srgb", ColorLevels::kSrgb}},
             "how brightness becomes levels of a pixel: as screens expect it (srgb, default of looks) or in proportion "
             "(linear, default of text scenes)");
}

}  // namespace gridiron::tool
