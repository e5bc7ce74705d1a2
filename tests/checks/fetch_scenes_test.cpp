// tools/fetch_scenes with a mirror on disk: a wrong download leaves no file behind.
// SPDX-License-Identifier: Apache-2.0
#include "run_script.h"
#include "support/scenes.h"

namespace gridiron::test {
namespace {

namespace fs = std::filesystem;

bool can_download() {
  return run_script("command -v curl").exit_code == 0;
}

// Fetches `name` from scratch/mirror into scratch/scans.
ScriptResult fetch(const ScratchDirectory& scratch, const std::string& name) {
  return run_script(source_path("tools/fetch_scenes") + " --into '" + (scratch.path() / "scans").string() +
                    "' --from 'file://" + (scratch.path() / "mirror").string() + "' " + name);
}

std::string header(const std::string& vertices, const std::string& faces) {
  return "ply\nformat ascii 1.0\nelement vertex " + vertices +
         "\nproperty float x\nproperty float y\nproperty float z\nelement face " + faces +
         "\nproperty list uchar int vertex_indices\nend_header\n";
}

void gzip_mirror_file(const ScratchDirectory& scratch, const std::string& name) {
  const ScriptResult result = run_script("gzip '" + (scratch.path() / "mirror" / name).string() + "'");
  ASSERT_EQ(result.exit_code, 0) << result.output;
}

TEST(FetchScenes, TheRightCountsPassAndAFileThatIsThereIsLeftAlone) {
  if (!can_download()) GTEST_SKIP() << "curl is not installed";
  const ScratchDirectory scratch;
  scratch.write("mirror/horse.ply", header("48485", "96966"));
  gzip_mirror_file(scratch, "horse.ply");
  const ScriptResult result = fetch(scratch, "horse");
  EXPECT_EQ(result.exit_code, 0) << result.output;
  EXPECT_TRUE(fs::exists(scratch.path() / "scans/horse.ply"));
  EXPECT_NE(fetch(scratch, "horse").output.find("is there already"), std::string::npos);
}

TEST(FetchScenes, WrongCountsAWrongChecksumAndABrokenArchiveLeaveNothing) {
  if (!can_download()) GTEST_SKIP() << "curl is not installed";
  const ScratchDirectory scratch;
  scratch.write("mirror/horse.ply", header("48485", "96965"));
  gzip_mirror_file(scratch, "horse.ply");
  scratch.write("mirror/Armadillo.ply", header("172974", "345944"));
  gzip_mirror_file(scratch, "Armadillo.ply");
  const ScriptResult counts = fetch(scratch, "horse");
  EXPECT_EQ(counts.exit_code, 1);
  EXPECT_NE(counts.output.find("has 48485 vertices, 96965 faces"), std::string::npos) << counts.output;
  const ScriptResult sum = fetch(scratch, "armadillo");
  EXPECT_EQ(sum.exit_code, 1);
  EXPECT_NE(sum.output.find("its SHA-256 is not"), std::string::npos) << sum.output;
  scratch.write("mirror/horse.ply.gz", "this is no archive");
  EXPECT_EQ(fetch(scratch, "horse").exit_code, 1);
  EXPECT_EQ(fetch(scratch, "bunny").exit_code, 1);
  EXPECT_FALSE(fs::exists(scratch.path() / "scans") && !fs::is_empty(scratch.path() / "scans"));
}

TEST(FetchScenes, AnUnknownNameAndAnUnknownOptionAreRefused) {
  EXPECT_EQ(run_script(source_path("tools/fetch_scenes") + " lucy").exit_code, 2);
  EXPECT_EQ(run_script(source_path("tools/fetch_scenes") + " --everything").exit_code, 2);
}

TEST(FetchScenes, TheMeasuredScansAreTheOnesAtHand) {
  const SharedFile scans = find_scene("");
  GRIDIRON_SKIP_IF_MISSING(scans);
  const ScriptResult result = run_script(source_path("tools/fetch_scenes") + " --verify '" + scans.path.string() + "'");
  EXPECT_EQ(result.exit_code, 0) << result.output;
  EXPECT_NE(result.output.find("the same   bunny.ply"), std::string::npos) << result.output;
}

}  // namespace
}  // namespace gridiron::test
