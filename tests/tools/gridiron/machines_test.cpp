// machines and --machine: profiles that people print, edit and give back. SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <gridiron/sim/work_costs.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "gridiron/device/machine_keys.h"
#include "run_program.h"
#include "temporary_folder.h"

namespace gridiron::test {
namespace {

using Json = nlohmann::json;

/// Renders a small torus. @returns the report without the host's seconds.
Json report_on(const TemporaryFolder& folder, const std::string& machine) {
  folder.write_ply("a.ply", make_torus(24, 16, 1.0f, 0.4f));
  run(folder, {"render", "a.ply", "-o", "a.png", "--size", "96x96", "--machine", machine, "--report", "r.json"});
  Json report = Json::parse(read_file(folder.path("r.json")), nullptr, false);
  report.erase("host");
  return report;
}

TEST(Machines, APrintedProfileRendersTheSameFrame) {
  const TemporaryFolder folder;
  for (const char* name : {"cell-ps3", "cell-2006", "cell-ps3-tlb"}) {
    const std::string text = run(folder, {"machines", name}).out;
    folder.write("copy.machine", text);
    EXPECT_EQ(run(folder, {"machines", "copy.machine"}).out, text);
    EXPECT_EQ(report_on(folder, "copy.machine"), report_on(folder, name)) << name;
  }
}

TEST(Machines, AProfileComesThroughAPipe) {
  const TemporaryFolder folder;
  const std::string text = run(folder, {"machines", "cell-2006"}).out;
  const std::filesystem::path pipe = folder.path("pipe");
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  std::thread writer([&] { std::ofstream(pipe) << text; });
  RunningProgram program(folder.folder(), {"machines", "pipe"});
  const ProgramResult result = program.wait(std::chrono::seconds(60));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out, text);
  const int reader = ::open(pipe.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);  // lets the writer end in any case
  writer.join();
  ::close(reader);
}

TEST(Machines, EditedFiguresCount) {
  const TemporaryFolder folder("slow.machine", "based_on cell-ps3\nlatency_cycles 5000\ncore_count 2\n");
  const Json slow = report_on(folder, "slow.machine");
  EXPECT_EQ(slow["machine"]["name"], "slow");
  EXPECT_EQ(slow["machine"]["cores"], 2);
  const Json usual = report_on(folder, "cell-ps3");
  EXPECT_GT(slow["frame"]["cycles"], usual["frame"]["cycles"]);
  EXPECT_EQ(slow["image_hash"], usual["image_hash"]) << "a machine changes figures and no pixel";
}

TEST(Machines, AnEditedCopyRendersAtFirstTryUnderANameOfItsOwn) {
  const TemporaryFolder folder;
  std::string text = run(folder, {"machines", "fu540"}).out;
  const std::size_t line = text.find("latency_cycles");
  text.replace(line, text.find('\n', line) - line, "latency_cycles 5000");
  folder.write("my.machine", text);
  const Json edited = report_on(folder, "my.machine");
  EXPECT_EQ(edited["machine"]["name"], "fu540-edited");
  EXPECT_GT(edited["frame"]["cycles"], report_on(folder, "fu540")["frame"]["cycles"]);
}

TEST(Machines, InfoAndPackFitTheMachineOfAFile) {
  const TemporaryFolder folder("a.ply", make_torus(240, 120, 1.0f, 0.4f));
  folder.write("small.machine", "based_on cell-ps3\nmain_memory_bytes 12650000\nlocal_store_bytes 65536\n");
  const Json info =
      Json::parse(run(folder, with_reference({"info", "a.ply", "--json", "--machine", "small.machine"})).out);
  EXPECT_EQ(info["main_memory"]["machine"], "small");
  EXPECT_EQ(info["main_memory"]["capacity_bytes"], 12650000);
  EXPECT_EQ(info["local_store"]["arena_bytes"], 65536);
  EXPECT_LT(info["grid"]["lambda"], 4.0) << "the grid is made to fit";
  run(folder, with_reference({"pack", "a.ply", "-o", "a.gri", "--machine", "small.machine"}));
  const Json packed = Json::parse(run(folder, with_reference({"info", "a.gri", "--json"})).out);
  EXPECT_EQ(packed["grid"]["lambda"], info["grid"]["lambda"]);
}

// The same mean: the more latencies differ, the less waiting is hidden. Another seed gives another frame.
TEST(Machines, LatencyMayBeATable) {
  const TemporaryFolder folder("table.machine", "based_on cell-ps3\nlatency_cycles 400:0.98 5400:0.02\n");
  folder.write("seed.machine", "based_on cell-ps3\nlatency_cycles 400:0.98 5400:0.02\nlatency_seed 2\n");
  const Json usual = report_on(folder, "cell-ps3"), table = report_on(folder, "table.machine");
  EXPECT_EQ(table["work"], usual["work"]);
  EXPECT_EQ(table["image_hash"], usual["image_hash"]);
  EXPECT_GT(table["frame"]["cycles"], usual["frame"]["cycles"]);
  EXPECT_NE(report_on(folder, "seed.machine")["frame"]["cycles"], table["frame"]["cycles"]);
  EXPECT_EQ(report_on(folder, "cell-ps3-tlb")["frame"]["cycles"], table["frame"]["cycles"]);
  const Json listed = Json::parse(run(folder, {"machines", "table.machine", "--json"}).out)["machines"][0];
  EXPECT_EQ(listed["latency_cycles"],
            Json::parse(R"([{"cycles": 400.0, "share": 0.98}, {"cycles": 5400.0, "share": 0.02}])"));
  EXPECT_EQ(listed["latency_seed"], 1);
}

// A short queue reaches the kernel, which keeps to it: it waits more often, and does nothing else more often.
TEST(Machines, AShortQueueChangesWaitsAlone) {
  const TemporaryFolder folder("short.machine", "based_on cell-ps3\nqueue_depth 1\n");
  folder.write("far.machine", "based_on cell-ps3\nlatency_cycles 5000\n");
  const Json usual = report_on(folder, "cell-ps3"), brief = report_on(folder, "short.machine");
  EXPECT_EQ(report_on(folder, "far.machine")["work"], usual["work"]) << "times have no say in the work";
  EXPECT_GT(brief["work"]["wait"], usual["work"]["wait"]);
  EXPECT_EQ(brief["image_hash"], usual["image_hash"]);
  for (const auto& [kind, count] : usual["work"].items()) {
    if (kind != "wait") {
      EXPECT_EQ(brief["work"][kind], count) << kind;
    }
  }
}

// The least that a machine file may say renders a small picture of a small scene, in every configuration.
TEST(Machines, TheSmallestMachineRenders) {
  const TemporaryFolder folder("a.ply", make_torus(24, 16, 1.0f, 0.4f));
  folder.write("least.machine", "based_on cell-ps3\nmain_memory_bytes 1048576\nlocal_store_bytes 65536\n");
  const struct {
    const char* configuration;
    const char* words;
  } cases[] = {
      {"reference", ""},
      {"grid",
       "a.ply: configuration grid has 4 cell blocks and 3 triangle buffers; a local store of 64 KB holds 2 cell blocks "
       "and 3 triangle buffers for it\n"},
      {"deep",
       "a.ply: configuration deep has 4 cell blocks and 8 triangle buffers; a local store of 64 KB holds 2 cell blocks "
       "and 4 triangle buffers for it\n"}};
  std::set<std::string> hashes;
  for (const auto& each : cases) {
    const ProgramResult result =
        run(folder, {"render", "a.ply", "-o", "a.png", "--size", "128x128", "--machine", "least.machine",
                     "--configuration", each.configuration, "--report", "r.json"});
    EXPECT_EQ(result.err, each.words);
    const Json report = Json::parse(read_file(folder.path("r.json")));
    EXPECT_EQ(report["scene"]["grid"]["lambda"], report["scene"]["grid"]["wanted_lambda"]);
    hashes.insert(report["image_hash"].get<std::string>());
  }
  EXPECT_EQ(hashes.size(), 1u);
  // A note is no error.
  EXPECT_EQ(run(folder, {"render", "a.ply", "-o", "a.png", "--size", "128x128", "--machine", "least.machine",
                         "--configuration", "deep", "--quiet"})
                .err,
            "");
  // An explicit number of buffers is used.
  EXPECT_EQ(run(folder, {"render", "a.ply", "-o", "a.png", "--size", "128x128", "--machine", "least.machine",
                         "--configuration", "grid", "--buffering", "double"})
                .err,
            "");
}

TEST(Machines, BadFilesEndWithOneAndRenderNothing) {
  const TemporaryFolder folder("a.ply", make_torus(24, 16, 1.0f, 0.4f));
  folder.write("bad.machine", "based_on cell-ps3\ncore_count 0\n");
  const Words before = folder.names();
  const struct {
    const char* machine;
    const char* words;
  } cases[] = {{"bad.machine", "bad.machine:2: 'core_count' must be from 1 to 1024, not '0'"},
               {"abacus", "abacus: no such file, and no built-in machine of that name; there are cell-ps3,"},
               {"a.ply", "a.ply: is a PLY mesh; expected a machine file"},
               {".", ".: is a folder; expected a machine file"}};
  for (const auto& each : cases) {
    for (const Words& command : {Words{"render", "a.ply", "--machine"},
                                 {"info", "a.ply", "--machine"},
                                 {"pack", "a.ply", "-o", "a.gri", "--machine"},
                                 {"machines"}}) {
      Words arguments = command;
      arguments.emplace_back(each.machine);
      const ProgramResult result = run_program(folder.folder(), arguments);
      EXPECT_EQ(result.exit_code, 1) << each.machine;
      EXPECT_EQ(result.err.find(each.words), 0u) << result.err;
      EXPECT_EQ(result.out, "");
      EXPECT_EQ(folder.names(), before);
    }
  }
  // A mistake on the command line is reported first.
  EXPECT_EQ(run_program(folder.folder(), {"render", "a.ply", "--machine", "bad.machine", "--fov", "0"}).exit_code, 2);
}

TEST(Machines, OneMachineAsJson) {
  const TemporaryFolder folder("mine.machine", "based_on cell-ps3\nmaster.step_cycles.cell_row 99.5\n");
  const Json document = Json::parse(run(folder, {"machines", "mine.machine", "--json"}).out);
  ASSERT_EQ(document["machines"].size(), 1u);
  EXPECT_EQ(document["machines"][0]["name"], "mine");
  EXPECT_EQ(document["machines"][0]["master"]["step_cycles"]["cell_row"], 99.5);
  EXPECT_EQ(document["machines"][0]["work_cycles"]["cell_step"],
            sim::kWorkCosts[static_cast<std::size_t>(GridWork::kCellStep)].cycles);
}

TEST(Machines, TheExampleFileRenders) {
  const TemporaryFolder folder;
  const std::string file = std::string(GRIDIRON_MACHINES) + "/cluster-8.machine";
  const Json report = report_on(folder, file);
  EXPECT_EQ(report["machine"]["name"], "cluster-8");
  EXPECT_EQ(report["machine"]["cores"], 8);
  EXPECT_EQ(report["machine"]["clock_hz"], 1e9);
  EXPECT_EQ(report["local_store"]["arena_bytes"], 131072) << "the largest store that it has room for";
  EXPECT_GT(report["frame"]["fps"], 0.0);
}

TEST(Machines, TheReadmeNamesEveryKey) {
  const TemporaryFolder folder;
  const std::string readme = read_file(std::string(GRIDIRON_MACHINES) + "/../README.md");
  std::istringstream stream(run(folder, {"machines", "cell-ps3"}).out);
  for (std::string line; std::getline(stream, line);) {
    const std::string key = line.substr(0, line.find(' '));
    const std::size_t dot = key.rfind('.');
    // Kinds of work and steps are words of their own there.
    const bool is_listed = dot != std::string::npos && key != "master.clock_hz";
    const std::string word = is_listed ? key.substr(dot + 1) : key;
    EXPECT_NE(readme.find("`" + word + "`"), std::string::npos) << key;
  }
  for (const tool::MachineKeyHelp& row : tool::machine_key_help()) {
    EXPECT_NE(readme.find("\n| `" + row.key + "` | " + row.range + " | "), std::string::npos) << row.key;
  }
}

TEST(Machines, HelpShowsTheFormat) {
  const TemporaryFolder folder;
  const std::string help = run(folder, {"machines", "--help"}).out;
  EXPECT_NE(help.find("based_on       cell-ps3"), std::string::npos) << help;
  EXPECT_NE(help.find("line_bytes: 1 to 16384; a transfer costs whole lines of this size\n"), std::string::npos)
      << help;
  EXPECT_NE(run(folder, {"render", "--help"}).out.find("cell-ps3-2gb|cell-ps3-dram|cell-ps3-tlb|fu540|cortex-m7|FILE"),
            std::string::npos);
}

}  // namespace
}  // namespace gridiron::test
