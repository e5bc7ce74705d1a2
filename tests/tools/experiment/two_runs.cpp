// Two runs of an experiment. SPDX-License-Identifier: Apache-2.0
#include "two_runs.h"

#include "markup.h"

namespace gridiron::test {

std::set<std::string> names_in(const std::filesystem::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) names.insert(entry.path().filename().string());
  return names;
}

void run_twice(const TemporaryFolder& folder,
               const std::function<Words(std::string output, std::string threads)>& words) {
  for (const std::string threads : {"1", "3"}) EXPECT_EQ(run(folder, words("out" + threads, threads)).out, "");
}

std::set<std::string> expect_same_files(const TemporaryFolder& folder, const std::vector<std::string>& known) {
  std::set<std::string> names = names_in(folder.path("out1"));
  EXPECT_EQ(names, names_in(folder.path("out3")));
  EXPECT_EQ(std::set<std::string>(known.begin(), known.end()).size(), known.size()) << "each once";
  for (const std::string& name : names) {
    EXPECT_NE(std::ranges::find(known, name), known.end()) << name;
    const std::string content = read_file(folder.path("out1") / name);
    const bool is_same = content == read_file(folder.path("out3") / name);
    EXPECT_TRUE(is_same || name.starts_with("host_")) << name;
    EXPECT_TRUE(!name.ends_with(".csv") || std::ranges::count(content, '\n') >= 2) << name << " has no rows";
    EXPECT_TRUE(!name.ends_with(".svg") || !parse_markup(content).empty()) << name;
    EXPECT_TRUE(!name.ends_with(".png") || content.starts_with("\x89PNG")) << name;
  }
  std::set<std::string> linked = {"index.html"};
  for (const MarkupElement& element : parse_markup(read_file(folder.path("out1") / "index.html"))) {
    for (const char* key : {"href", "src"}) {
      const auto found = element.attributes.find(key);
      if (found != element.attributes.end() && found->second.front() != '#') linked.insert(found->second);
    }
  }
  EXPECT_EQ(linked, names);
  return names;
}

}  // namespace gridiron::test
