// Machine files: printed ones read back identical, and every error has its line.
// SPDX-License-Identifier: Apache-2.0
#include "gridiron/device/machine_file.h"

#include "failure_of.h"
#include "temporary_folder.h"

namespace gridiron::test {
namespace {

using sim::MachineProfile;
using tool::Machine;

std::string complaint_of(const std::filesystem::path& path) {
  return failure_of([&path] { return tool::read_machine_file(path); });
}

Machine read_text(const std::string& text, const std::string& name = "a.machine") {
  const TemporaryFolder folder;
  return tool::read_machine_file(folder.write(name, text));
}

std::string without_line(const std::string& text, const std::string& key) {
  const std::size_t begin = text.find("\n" + key + " ");
  EXPECT_NE(begin, std::string::npos) << key;
  return text.substr(0, begin) + text.substr(text.find('\n', begin + 1));
}

TEST(MachineFile, BuiltInProfilesReadBackIdentical) {
  for (const MachineProfile& machine : sim::machine_profiles()) {
    const Machine copy = read_text(tool::machine_text(machine));
    EXPECT_EQ(*copy, machine) << machine.name;
  }
}

TEST(MachineFile, EveryDigitReadsBackIdentical) {
  MachineProfile machine = *sim::find_machine_profile("cell-ps3");
  machine.name = "mine";
  machine.description = "a machine of mine";
  machine.clock_hz = 1e9 / 3;
  machine.latency_cycles = 0.1 + 0.2;
  machine.channel_bytes_per_cycle = 65536;
  machine.claim_cycles = 1e-300;
  machine.pass_start_cycles = 2.0 / 3;
  machine.pass_barrier_cycles = 700.1;
  machine.main_memory_bytes = std::uint64_t{1} << 40;
  machine.work_cycles[0] = 123456.0 / 7;
  machine.master.step_cycles[0] = 1.0 / 3;
  EXPECT_EQ(*read_text(tool::machine_text(machine)), machine);
  machine.latency_cycles = {{0.1 + 0.2, 1.0 / 3}, {500, 1.0 / 3}, {7e5, 1.0 / 3}};
  EXPECT_EQ(*read_text(tool::machine_text(machine)), machine);
}

TEST(MachineFile, ABaseGivesWhatIsNotSaid) {
  const Machine machine = read_text(
      "\xEF\xBB\xBF# my chip\r\n\r\nbased_on\tcell-ps3\r\n core_count 4 # half of it\r\nclock_hz 1.5e9\n"
      "work_cycles.cell_step 12.5\nwork_cycles.tile_view 99\nmaster.step_cycles.node_made 7\nmaster.clock_hz "
      "2e9\nqueue_depth 1",
      "mine.machine");
  MachineProfile expected = *sim::find_machine_profile("cell-ps3");
  expected.name = "mine";
  expected.description = "based on cell-ps3";
  expected.core_count = 4;
  expected.clock_hz = 1.5e9;
  expected.queue_depth = 1;
  expected.work_cycles[static_cast<std::size_t>(GridWork::kCellStep)] = 12.5;
  expected.tile_work_cycles[0] = 99;
  expected.master.step_cycles[static_cast<std::size_t>(sim::BuildStep::kNodeMade)] = 7;
  expected.master.clock_hz = 2e9;
  EXPECT_EQ(*machine, expected);
}

TEST(MachineFile, NamesAndDescriptionsAreText) {
  const Machine machine =
      read_text("based_on cell-2006\nname chip-7\ndescription  8 cores, as we think of them  # now\n");
  EXPECT_EQ(machine->name, "chip-7");
  EXPECT_EQ(machine->description, "8 cores, as we think of them");
  EXPECT_EQ(read_text("based_on cell-2006\n", "two words.machine")->name, "unnamed");
  // The ends of every range of UTF-8.
  const std::string text =
      "~ \xC2\xA0.\xDF\xBF \xE0\xA0\x80 \xEC\xBF\xBF \xED\x9F\xBF \xEE\x80\x80 \xF0\x90\x80\x80 \xF4\x8F\xBF\xBF";
  EXPECT_EQ(read_text("based_on cell-2006\ndescription " + text, "b.machine")->description, text);
}

// A built-in machine's name implies its figures.
TEST(MachineFile, NamesOfBuiltInMachinesAreTheirs) {
  const Machine same = read_text("based_on cell-2006\nname cell-2006\ndescription in other words\n");
  EXPECT_EQ(same->name, "cell-2006");
  EXPECT_EQ(same->description, "in other words");
  EXPECT_EQ(read_text("based_on cell-2006\n", "cell-2006.machine")->name, "cell-2006");
  EXPECT_EQ(read_text("based_on cell-2006\n", "cell-ps3.machine")->name, "unnamed")
      << "the file's name is not the machine's";
}

// An edited copy of 'gridiron machines NAME' still has that name; a report must distinguish the two.
TEST(MachineFile, AnEditedCopyOfABuiltInMachineIsCalledEdited) {
  for (const MachineProfile& built_in : sim::machine_profiles()) {
    std::string text = tool::machine_text(built_in);
    const std::size_t line = text.find("core_count");
    text.replace(line, text.find('\n', line) - line, "core_count 5");
    const Machine edited = read_text(text, "my.machine");
    EXPECT_EQ(edited->name, std::string(built_in.name) + "-edited");
    EXPECT_EQ(edited->description, "edited copy of " + std::string(built_in.name));
    EXPECT_EQ(edited->core_count, 5u);
    const Machine again = read_text(tool::machine_text(*edited), "again.machine");
    EXPECT_EQ(*again, *edited) << "what is printed reads back identical";
  }
  const std::string other = "name cell-2006\n";
  EXPECT_EQ(read_text("based_on cell-ps3\n" + other)->name, "cell-2006-edited");
}

TEST(MachineFile, WithoutABaseEveryKeyIsAsked) {
  const TemporaryFolder folder;
  const std::string text = tool::machine_text(*sim::find_machine_profile("cell-ps3"));
  const auto lines = std::to_string(std::count(text.begin(), text.end(), '\n') - 1);
  std::istringstream stream(text);
  int keys = 0;
  for (std::string line; std::getline(stream, line);) {
    const std::string key = line.substr(0, line.find(' '));
    if (key == "name" || key == "description") continue;
    ++keys;
    const auto path = folder.write("a.machine", without_line(text, key));
    EXPECT_EQ(complaint_of(path), path.string() + ":" + lines + ": the file ends without '" + key +
                                      "', and has no 'based_on' to take it from");
  }
  // 16 numbers and the master's clock; three kinds of work are charged as events and have no key.
  EXPECT_EQ(keys, static_cast<int>(17 + sim::kGridEngine.kind_count() - 3 + kTileWorkCount + sim::kBuildStepCount));
  EXPECT_NE(read_text(without_line(text, "description"), "b.machine")->description, "");
}

TEST(MachineFile, NamesTheLineOfEveryDefect) {
  const std::string base = "based_on cell-ps3\n";
  const std::pair<std::string, const char*> cases[] = {
      {base + "cores 4\n", ":2: unknown key 'cores'"},
      {base + "Core_count 4\n", ":2: unknown key; keys are words"},
      {base + "work_cycles.paint 4\n", ":2: unknown key 'work_cycles.paint'"},
      {base + "work_cycles.wait 4\n", ":2: unknown key 'work_cycles.wait'"},
      {base + "core_count 4\n\ncore_count 4\n", ":4: second 'core_count'"},
      {base + "name a\nname b\n", ":3: second 'name'"},
      {base + base, ":2: second 'based_on'"},
      {"core_count 4\n" + base, ":2: 'based_on' must be the first key"},
      {"based_on abacus\n", ":1: 'abacus' is no built-in machine; there are cell-ps3, cell-2006"},
      {"based_on\n", ":1: '' is no built-in machine"},
      {base + "core_count\n", ":2: 'core_count' has no value"},
      {base + "name # none\n", ":2: 'name' has no value"},
      {base + "name two words\n", ":2: 'name' takes one word"},
      {base + "name caf\xC3\xA9\n", ":2: 'name' takes one word"},
      {base + "name a\x7F\n", ":2: 'name' takes one word"},
      {base + "description a\x7F\n", ":2: 'description' has a control character"},
      {base + "description a\x1B[2J\n", ":2: not a text file"},
      {base + "description a\xC2\x80\n", ":2: 'description' has a control character"},
      {base + "description a\xC2\x9F\n", ":2: 'description' has a control character"},
      {base + "\ndescription caf\xE9\n", ":3: 'description' is not UTF-8"},
      {base + "core_count 4 5\n", ":2: 'core_count' takes one number"},
      {base + "core_count four\n", ":2: 'four' is not a whole number"},
      {base + "core_count 4.5\n", ":2: '4.5' is not a whole number"},
      {base + "core_count -4\n", ":2: '-4' is not a whole number"},
      {base + "clock_hz 3GHz\n", ":2: '3GHz' is not a number"},
      {base + "clock_hz nan\n", ":2: 'nan' is not a number"},
      {base + "clock_hz inf\n", ":2: 'inf' is not a number"},
      {base + "clock_hz 0x10\n", ":2: '0x10' is not a number"},
      {base + "core_count 0\n", ":2: 'core_count' must be from 1 to 1024, not '0'"},
      {base + "core_count 1025\n", ":2: 'core_count' must be from 1 to 1024, not '1025'"},
      {base + "core_count 99999999999999999999999\n", ":2: 'core_count' must be from 1 to 1024"},
      {base + "clock_hz 1e999\n", ":2: 'clock_hz' must be from 1 to 1e12, not '1e999'"},
      {base + "local_store_bytes 8192\n", ":2: 'local_store_bytes' must be from 16384 to 1073741824, not '8192'"},
      {base + "main_memory_bytes 1\n", ":2: 'main_memory_bytes' must be from 65536 to 1099511627776, not '1'"},
      {base + "latency_cycles -1\n", ":2: 'latency_cycles' must be from 0 to 1048576, not '-1'"},
      {base + "latency_cycles 400 500\n", ":2: 'latency_cycles' takes one number, or several with shares"},
      {base + "latency_cycles 400:0.5 500\n", ":2: 'latency_cycles' takes one number, or several with shares"},
      {base + "latency_cycles 400:0.5 500:0.4\n", ":2: the shares of 'latency_cycles' add up to 0.9, not to 1"},
      {base + "latency_cycles 400:0 500:1\n", ":2: a share of 'latency_cycles' must be from "},
      {base + "latency_cycles 400:half\n", ":2: 'half' is not a number"},
      {base + "latency_cycles 400:0.5 -1:0.5\n", ":2: 'latency_cycles' must be from 0 to 1048576, not '-1'"},
      {base + "latency_cycles 1:.1 2:.1 3:.1 4:.1 5:.1 6:.1 7:.1 8:.1 9:.2\n",
       ":2: 'latency_cycles' takes at most 8 numbers"},
      {base + "channel_bytes_per_cycle 0\n", ":2: 'channel_bytes_per_cycle' must be from 0.0625 to 65536, not '0'"},
      {base + "queue_depth 4097\n", ":2: 'queue_depth' must be from 1 to 4096"},
      {base + "line_bytes 0\n", ":2: 'line_bytes' must be from 1 to 16384"},
      {base + "# " + std::string(999, 'x') + "\n", ":2: line of more than 1000 bytes"},
      {base + std::string(100000, 'x'), ":2: line of more than 1000 bytes"},
      {base + std::string("core_count\0 4\n", 14), ":2: not a text file"},
      {"\x7F"
       "ELF\x02\x01\x01",
       ": is a program; expected a machine file"},
      {"ply\nformat ascii 1.0\n", ": is a PLY mesh; expected a machine file"},
      {"\n", ":1: the file ends without 'core_count'"},
      {"# nothing\n\n", ":2: the file ends without 'core_count'"},
  };
  const TemporaryFolder folder;
  const auto expect = [&folder](const std::string& content, const std::string& line_and_reason) {
    const auto path = folder.write("a.machine", content);
    const std::string failure = complaint_of(path);
    EXPECT_EQ(failure.find(path.string() + line_and_reason), 0u) << failure << "\nfor: " << content.substr(0, 200);
    EXPECT_LT(failure.size(), path.string().size() + 250) << "a complaint does not repeat the file";
  };
  for (const auto& [content, line_and_reason] : cases) expect(content, line_and_reason);
  for (const char* text :
       {"\x80", "\xC0\xAF", "\xC1\xBF", "\xC3", "\xC3(", "\xE0\x9F\xBF", "\xE2\x82", "\xE2\x82(", "\xED\xA0\x80",
        "\xF0\x8F\xBF\xBF", "\xF0\x9F\x98\xC0", "\xF4\x90\x80\x80", "\xF5\x80\x80\x80"}) {
    expect(base + "description " + text + "\n", ":2: 'description' is not UTF-8");
  }
}

TEST(MachineFile, FilesThatCannotBeRead) {
  const TemporaryFolder folder;
  EXPECT_EQ(complaint_of(folder.folder()),
            folder.folder().string() +
                ": is a folder; expected a machine file: text as 'gridiron machines cell-ps3' prints it");
  EXPECT_EQ(complaint_of(folder.path("none")), folder.path("none").string() + ": No such file or directory");
  EXPECT_EQ(complaint_of("/dev/zero"), "/dev/zero: File too large");
}

TEST(MachineFile, NamesOfBuiltInMachinesComeFirst) {
  EXPECT_EQ(tool::find_machine("cell-2006").get(), sim::find_machine_profile("cell-2006"));
  const TemporaryFolder folder;
  const std::string path = folder.write("cell-2006", "based_on cell-ps3\ncore_count 3\n").string();
  EXPECT_EQ(tool::find_machine(path)->core_count, 3u);
  EXPECT_EQ(failure_of([] { return tool::find_machine("abacus"); }),
            "abacus: no such file, and no built-in machine of that name; there are cell-ps3, cell-2006, "
            "cell-ps3-2gb, cell-ps3-dram, cell-ps3-tlb, fu540, cortex-m7");
}

TEST(MachineFile, TheStoreFollowsTheMachine) {
  MachineProfile machine = *sim::find_machine_profile("cell-ps3");
  EXPECT_EQ(tool::largest_store(machine), sim::StoreSize::k256KB);
  machine.local_store_bytes = (256u << 10) - 1;
  EXPECT_EQ(tool::largest_store(machine), sim::StoreSize::k128KB);
  machine.local_store_bytes = (128u << 10) - 1;
  EXPECT_EQ(tool::largest_store(machine), sim::StoreSize::k64KB);
  machine.local_store_bytes = (64u << 10) - 1;
  EXPECT_EQ(tool::largest_store(machine), sim::StoreSize::k16KB);
  machine.local_store_bytes = 1u << 30;
  EXPECT_EQ(tool::largest_store(machine), sim::StoreSize::k512KB);
}

}  // namespace
}  // namespace gridiron::test
