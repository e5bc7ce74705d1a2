// Installed documents: their links lead to installed files; uninstalling removes what was installed, and nothing else.
// SPDX-License-Identifier: Apache-2.0
#include "run_script.h"

namespace gridiron::test {
namespace {

namespace fs = std::filesystem;

std::string text_of_file(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

ScriptResult check_links(const fs::path& root) {
  return run_script(source_path("tools/checks/check_links") + " '" + root.string() + "'");
}

TEST(Documents, LinksOfTheCheckoutLeadSomewhere) {
  const ScriptResult result = check_links(source_path("."));
  EXPECT_EQ(result.exit_code, 0) << result.output;
}

TEST(Documents, DeadLinksAreNamed) {
  const ScratchDirectory scratch;
  scratch.write("a.md", "# A\n\nSee [the\nother](b/c.md#a-heading),\n[gone](b/gone.md), [web](https://x.org/y.md).\n");
  scratch.write(
      "b/c.md",
      "## A `heading`!\n\n```\n[code](code.md)\n```\n\n    [code](code.md)\n\n[up](../a.md#none) [own](#own)\n");
  const ScriptResult result = check_links(scratch.path());
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.output,
            "a.md:5: links to b/gone.md, which is not there\n"
            "b/c.md:9: links to ../a.md#none, but a.md has no such heading\n"
            "b/c.md:9: links to #own, but b/c.md has no such heading\n"
            "check_links: 3 breaches\n");
}

TEST(Documents, InstalledOnesLinkToInstalledOnes) {
  const ScratchDirectory scratch;
  const std::string copy = source_path("tools/cmake/copy_documents");
  ASSERT_EQ(run_script(copy + " '" + scratch.path().string() + "/doc'").exit_code, 0);
  ASSERT_EQ(run_script(copy + " --kit '" + scratch.path().string() + "/kit'").exit_code, 0);
  scratch.write("doc/LICENSE", "");  // it belongs to another component
  const ScriptResult whole = check_links(scratch.path() / "doc");
  EXPECT_EQ(whole.exit_code, 0) << whole.output;
  fs::rename(scratch.path() / "doc/core/SPEC.md", scratch.path() / "SPEC.md");
  const ScriptResult part = check_links(scratch.path() / "doc");
  EXPECT_EQ(part.exit_code, 1);
  EXPECT_NE(part.output.find("core/TREE.md:"), std::string::npos) << part.output;
  const ScriptResult kit = check_links(scratch.path() / "kit");
  EXPECT_EQ(kit.exit_code, 0) << kit.output;

  const std::string readme = text_of_file(scratch.path() / "doc" / "README.md");
  EXPECT_NE(readme.find("](core/SPEC.md)"), std::string::npos) << "an installed page";
  EXPECT_NE(readme.find(" 141 million rays from"), std::string::npos) << "one that is not";
  EXPECT_EQ(std::ranges::count(readme, '\n'), std::ranges::count(text_of_file(source_path("README.md")), '\n'));
  EXPECT_NE(text_of_file(scratch.path() / "kit" / "PORTING.md").find("\ncopy_port.h, some 40 lines.\n"),
            std::string::npos);
  EXPECT_NE(text_of_file(scratch.path() / "doc/platform/README.md").find("StoreLayout256K<8>> store;"),
            std::string::npos);
}

TEST(Documents, UninstallRemovesWhatWasInstalled) {
  const ScratchDirectory scratch;
  const fs::path root = scratch.path();
  const std::string uninstall = "DESTDIR='" + root.string() + "/stage' cmake -D BUILD='" + root.string() +
                                "/build' -P " + source_path("tools/cmake/uninstall.cmake");
  fs::create_directories(root / "build");
  const ScriptResult nothing = run_script(uninstall);
  EXPECT_NE(nothing.exit_code, 0);
  EXPECT_NE(nothing.output.find("nothing was installed from this build"), std::string::npos) << nothing.output;

  for (const char* name :
       {"stage/usr/bin/gridiron", "stage/usr/bin/other", "stage/usr/include/gridiron/a/a b.h",
        "stage/usr/include/gridiron/c.h", "stage/usr/share/gridiron/mine.txt", "stage/usr/share/gridiron/port/x"}) {
    scratch.write(name, "");
  }
  scratch.write("build/install_manifest.txt",
                "/usr/bin/gridiron\n/usr/include/gridiron/a/a b.h\n/usr/include/gridiron/c.h\n/usr/gone/before\n");
  scratch.write("build/install_manifest_tools.txt", "/usr/share/gridiron/port/x\n");
  const ScriptResult result = run_script(uninstall);
  EXPECT_EQ(result.exit_code, 0) << result.output;
  EXPECT_NE(result.output.find("4 files removed"), std::string::npos) << result.output;
  std::set<std::string> left;
  for (const auto& entry : fs::recursive_directory_iterator(root / "stage")) {
    left.insert(entry.path().lexically_relative(root / "stage").string());
  }
  const std::set<std::string> expected = {"usr",
                                          "usr/bin",
                                          "usr/bin/other",
                                          "usr/include",
                                          "usr/share",
                                          "usr/share/gridiron",
                                          "usr/share/gridiron/mine.txt"};
  EXPECT_EQ(left, expected);
  EXPECT_FALSE(fs::exists(root / "build/install_manifest.txt"));
}

// Each manifest's files lie below the DESTDIR of its own install; that of the environment is taken before it.
TEST(Documents, UninstallKnowsWhereFilesWereStaged) {
  const ScratchDirectory scratch;
  const std::string root = scratch.path().string();
  for (const char* name : {"all/usr/bin/a", "tools/usr/bin/b", "asked/usr/bin/a", "asked/usr/bin/b"}) {
    scratch.write(name, "");
  }
  const auto install = [&scratch, &root] {
    scratch.write("build/install_manifest.txt", "/usr/bin/a\n");
    scratch.write("build/install_destdir.txt", root + "/all");
    scratch.write("build/install_manifest_tools.txt", "/usr/bin/b\n");
    scratch.write("build/install_destdir_tools.txt", root + "/tools");
  };
  const std::string uninstall =
      "cmake -D BUILD='" + root + "/build' -P " + source_path("tools/cmake/uninstall.cmake");
  install();
  const ScriptResult asked = run_script("DESTDIR='" + root + "/asked' " + uninstall);
  EXPECT_NE(asked.output.find("2 files removed"), std::string::npos) << asked.output;
  EXPECT_TRUE(fs::exists(scratch.path() / "all/usr/bin/a"));
  EXPECT_FALSE(fs::exists(scratch.path() / "asked/usr/bin/a"));
  install();
  const ScriptResult known = run_script("env -u DESTDIR " + uninstall);
  EXPECT_NE(known.output.find("2 files removed"), std::string::npos) << known.output;
  EXPECT_FALSE(fs::exists(scratch.path() / "all/usr/bin/a"));
  EXPECT_FALSE(fs::exists(scratch.path() / "tools/usr/bin/b"));
  EXPECT_TRUE(fs::is_empty(scratch.path() / "build"));
}

}  // namespace
}  // namespace gridiron::test
