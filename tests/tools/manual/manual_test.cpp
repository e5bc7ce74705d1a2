// Man pages and completions: they have the options of the help, no more and no fewer, and their readers take them.
// SPDX-License-Identifier: Apache-2.0
#include <regex>

#include "checks/run_script.h"
#include "gridiron/command_line/arguments.h"

namespace gridiron::test {
namespace {

namespace fs = std::filesystem;
using Names = std::set<std::string>;
using Words = std::vector<std::string>;

const Words kCommands = {"render", "animate", "info", "pack", "job", "result", "machines", "experiment"};
const fs::path kPages = GRIDIRON_PAGES;

std::string text_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  EXPECT_TRUE(file) << path;
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string help_of(const std::string& command) {
  const char* const words[] = {"gridiron", "help", command.c_str()};
  return std::get<tool::TextRequest>(tool::parse_arguments(command.empty() ? 2 : 3, words)).text;
}

// The lines of a help that begin with an option: its names and the rest of the line.
std::vector<std::pair<std::string, std::string>> option_lines(const std::string& command) {
  std::vector<std::pair<std::string, std::string>> lines;
  const std::string help = help_of(command);
  const std::regex option("(?:^|\n)  (-[^ \n]+)([^\n]*)");
  for (std::sregex_iterator found(help.begin(), help.end(), option), end; found != end; ++found) {
    lines.emplace_back((*found)[1], (*found)[2]);
  }
  return lines;
}

Words parts_of(const std::string& text, char separator) {
  Words parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, separator);) {
    if (!part.empty()) parts.push_back(part);
  }
  return parts;
}

Names options_of_help(const std::string& command) {
  Names names;
  for (const auto& [option, rest] : option_lines(command)) {
    for (const std::string& name : parts_of(option, ',')) names.insert(name);
  }
  return names;
}

Names found_in(const std::string& text, const std::string& pattern) {
  Names names;
  const std::regex regex(pattern);
  for (std::sregex_iterator found(text.begin(), text.end(), regex), end; found != end; ++found)
    names.insert((*found)[1]);
  return names;
}

std::string between(const std::string& text, const std::string& begin, const std::string& end) {
  const std::size_t first = text.find(begin);
  EXPECT_NE(first, std::string::npos) << begin;
  if (first == std::string::npos) return "";
  return text.substr(first, text.find(end, first + begin.size()) - first);
}

// Of a page, with the minus of roff.
Names options_of_page(const std::string& command) {
  const std::string page = text_of(kPages / "man1" / ("gridiron" + (command.empty() ? "" : "-" + command) + ".1"));
  std::string terms;
  for (const std::string& entry : parts_of(
           std::regex_replace(between(page, ".SH OPTIONS", ".SH EXIT"), std::regex("\n\\.TP\n"), "\x01"), '\x01')) {
    terms += entry.substr(0, entry.find('\n')) + "\n";
  }
  return found_in(std::regex_replace(terms, std::regex(R"(\\-)"), "-"), R"(\\fB(-[a-z-]+)\\fR)");
}

bool has_program(const std::string& name) {
  return run_script("command -v " + name).exit_code == 0;
}

std::string bash_line(const std::string& line) {
  const ScriptResult result = run_script("bash -c '. " + (kPages / "bash" / "gridiron").string() + "; " + line + "'");
  EXPECT_EQ(result.exit_code, 0) << line << "\n" << result.output;
  return result.output;
}

TEST(Manual, EveryPageIsFormattedWithoutAWarning) {
  if (!has_program("man") || !has_program("groff")) GTEST_SKIP() << "man and groff are not installed";
  std::size_t count = 0;
  std::vector<fs::path> pages = {kPages / "mpi" / "man1" / "gridiron_mpi.1"};
  for (const auto& entry : fs::directory_iterator(kPages / "man1")) pages.push_back(entry.path());
  for (const fs::path& path : pages) {
    const std::string page = "'" + path.string() + "'";
    for (const std::string command :
         {"groff -ww -mandoc -Tutf8 ", "groff -ww -mandoc -Tutf8 -rLL=60n ", "MANWIDTH=80 man --warnings -Tutf8 -l "}) {
      const ScriptResult result = run_script("(LC_ALL=C.UTF-8 " + command + page + " > /dev/null)");
      EXPECT_EQ(result.exit_code, 0) << page;
      EXPECT_EQ(result.output, "") << command << page;
    }
    if (has_program("lexgrog")) {
      EXPECT_EQ(run_script("lexgrog " + page).exit_code, 0) << page << ": whatis finds no name";
    }
    ++count;
  }
  EXPECT_EQ(count, kCommands.size() + 2);
}

TEST(Manual, PagesHaveTheOptionsOfTheHelp) {
  for (const std::string& command : kCommands) EXPECT_EQ(options_of_page(command), options_of_help(command)) << command;
  EXPECT_EQ(options_of_page(""), options_of_help(""));
  const std::string page = text_of(kPages / "man1" / "gridiron.1");
  for (const std::string& command : kCommands) {
    EXPECT_NE(page.find("\n\\fB" + command + "\\fR\n"), std::string::npos) << command;
    EXPECT_NE(page.find("gridiron\\-" + command + " (1)"), std::string::npos) << command;
  }
}

TEST(Manual, CompletionsHaveTheOptionsOfTheHelp) {
  const std::string zsh = text_of(kPages / "zsh" / "_gridiron");
  const std::string fish = text_of(kPages / "fish" / "gridiron.fish");
  for (const std::string& command : kCommands) {
    const Names options = options_of_help(command);
    const Words bash = parts_of(parts_of(bash_line("_gridiron_options " + command), '\n').front(), ' ');
    EXPECT_EQ(Names(bash.begin(), bash.end()), options) << command;

    Names of_zsh, of_fish;
    for (const std::string& names : found_in(between(zsh, "        " + command + ")\n", ";;\n"), R"('\((-[^)]*)\)')")) {
      for (const std::string& name : parts_of(names, ' ')) of_zsh.insert(name);
    }
    EXPECT_EQ(of_zsh, options) << command;
    for (const std::string& line : parts_of(fish, '\n')) {
      const std::string start = "complete -c gridiron -n '__gridiron_command_is " + command + "'";
      if (!line.starts_with(start)) continue;
      const std::string names = line.substr(start.size(), line.find(" -d ") - start.size());
      for (const std::string& name : found_in(names, " -s ([a-z])")) of_fish.insert("-" + name);
      for (const std::string& name : found_in(names, " -l ([a-z-]+)")) of_fish.insert("--" + name);
    }
    EXPECT_EQ(of_fish, options) << command;
  }
}

TEST(Manual, ChoicesMachinesAndFilesOfTheHelpAreOffered) {
  std::size_t choice_count = 0, name_count = 0;
  for (const std::string& command : kCommands) {
    for (const auto& [option, rest] : option_lines(command)) {
      const std::string name = parts_of(option, ',').back();
      const std::string type = rest.empty() || rest.substr(0, 2) == "  " ? "" : rest.substr(1, rest.find(' ', 1) - 1);
      const ScriptResult value =
          run_script("bash -c '. " + (kPages / "bash" / "gridiron").string() + "; _gridiron_value " + command + " " +
                     name + " && echo \"$words:$endings\"'");
      EXPECT_EQ(value.exit_code, type.empty() ? 1 : 0) << command << " " << name << " " << type;
      if (type.empty()) continue;
      const std::size_t colon = value.output.find(':');
      const std::string words = value.output.substr(0, colon);
      const std::string endings = value.output.substr(colon + 1);
      if (std::regex_match(type, std::regex("[a-z0-9-]+(\\|[a-z0-9-]+)+(\\|FILE)?"))) {
        std::string expected;
        for (const std::string& word : parts_of(type, '|'))
          expected += word == "FILE" ? "" : (expected.empty() ? "" : " ") + word;
        EXPECT_EQ(words, expected) << command << " " << name;
        ++choice_count;
      }
      if (type.ends_with("FILE") || type == "DIR" || type == "MACHINE") {
        EXPECT_NE(endings, "\n") << command << " " << name;
        ++name_count;
      } else {
        EXPECT_EQ(endings, "\n") << command << " " << name;
      }
    }
  }
  EXPECT_GE(choice_count, 30u);
  EXPECT_GE(name_count, 25u);
}

// What bash offers for a line, parted as bash does it: the word of the cursor is the last one.
std::string completed(const fs::path& folder, const Words& line) {
  std::string words;
  for (const std::string& word : line) words += " \"" + word + "\"";
  return bash_line("cd " + folder.string() + "; COMP_WORDS=(" + words +
                   "); COMP_CWORD=" + std::to_string(line.size() - 1) +
                   "; _gridiron; printf \"%s\\n\" \"${COMPREPLY[@]}\" | sort | paste -s -d \" \"");
}

TEST(Manual, BashCompletesLines) {
  const ScratchDirectory scratch;
  for (const char* name : {"a.ply", "B.PLY", "ball.nff", "notes.txt", "view.camera", "my.machine", "old.png", "d.pfm",
                           "two words.ply", "frames/x.ply", "odd/mesh.dat", "a.job", "a.result"}) {
    scratch.write(name, "");
  }
  const std::pair<Words, const char*> cases[] = {
      {{"gridiron", "re"}, "render result\n"},
      {{"gridiron", ""}, "animate experiment help info job machines pack render result\n"},
      {{"gridiron", "--v"}, "--version\n"},
      {{"gridiron", "help", "ma"}, "machines\n"},
      {{"gridiron", "help", ""}, "animate experiment info job machines pack render result\n"},
      {{"gridiron", "render", "--mach"}, "--machine\n"},
      {{"gridiron", "render", "--machine", "ce"}, "cell-2006 cell-ps3 cell-ps3-2gb cell-ps3-dram cell-ps3-tlb\n"},
      {{"gridiron", "render", "--machine", "=", "cell-ps3-d"}, "cell-ps3-dram\n"},
      {{"gridiron", "render", "--machine=cell-ps3-d"}, "--machine=cell-ps3-dram\n"},
      {{"gridiron", "info", "--machine", "m"}, "my.machine\n"},
      {{"gridiron", "machines", "fu"}, "fu540\n"},
      {{"gridiron", "render", "--configuration", ""}, "best deep grid reference\n"},
      {{"gridiron", "info", "a.ply", "--accuracy", "e"}, "exact\n"},
      {{"gridiron", "pack", "--format", ""}, "lattice projection vertices\n"},
      {{"gridiron", "render", ""}, "B.PLY a.ply ball.nff frames odd two words.ply\n"},
      {{"gridiron", "render", "b"}, "ball.nff\n"},
      {{"gridiron", "render", "odd/"}, "odd/mesh.dat\n"},
      {{"gridiron", "render", "--eye", "-1,2,3", "a"}, "a.ply\n"},
      {{"gridiron", "render", "--eye", ""}, "\n"},
      {{"gridiron", "render", "a.ply", "--camera", ""}, "frames odd view.camera\n"},
      {{"gridiron", "render", "a.ply", "-o", ""}, "d.pfm frames odd old.png\n"},
      {{"gridiron", "render", "a.ply", "--depth", ""}, "d.pfm frames odd\n"},
      {{"gridiron", "render", "a.ply", "--no-"}, "--no-culling --no-empty-skip --no-mailbox --no-subpackets\n"},
      {{"gridiron", "render", "a.ply", "--no-culling", "--no-"}, "--no-empty-skip --no-mailbox --no-subpackets\n"},
      {{"gridiron", "render", "--quiet", "--", "--"}, "\n"},
      {{"gridiron", "machines", "fu540", ""}, "--help --json --quiet -h\n"},
      {{"gridiron", "result", "a"}, "a.job\n"},
      {{"gridiron", "result", "a.job", "a"}, "a.result\n"},
      {{"gridiron", "animate", "a.ply", "B"}, "B.PLY\n"},
      {{"gridiron", "animate", "-o", ""}, "frames odd\n"},
      {{"gridiron", "experiment", ""}, "accuracy dynamic effects paper\n"},
      {{"gridiron", "experiment", "paper", "-o", "f"}, "frames\n"},
      {{"gridiron", "paint", ""}, "\n"},
  };
  for (const auto& [line, expected] : cases) {
    std::string words;
    for (const std::string& word : line) words += word + " ";
    EXPECT_EQ(completed(scratch.path(), line), expected) << words;
  }
}

TEST(Manual, BashStartsTheCompletionOfTheProgram) {
  EXPECT_EQ(bash_line("complete -p gridiron"), "complete -F _gridiron gridiron\n");
  EXPECT_EQ(bash_line("set -u; COMP_WORDS=(gridiron pa); COMP_CWORD=1; _gridiron; echo ${COMPREPLY[*]}"), "pack\n");
}

// The program for MPI has the same completions under its own name, and both may be loaded.
TEST(Manual, TheProgramForMpiIsCompletedAsTheOther) {
  const fs::path mpi = kPages / "mpi";
  for (const auto& [own, other] : {std::pair("bash/gridiron_mpi", "bash/gridiron"),
                                   std::pair("zsh/_gridiron_mpi", "zsh/_gridiron"),
                                   std::pair("fish/gridiron_mpi.fish", "fish/gridiron.fish")}) {
    const std::regex name("(Completion of |#compdef |complete -c |complete -F _gridiron )gridiron_mpi\\b");
    const std::string text = text_of(mpi / own);
    EXPECT_TRUE(std::regex_search(text, name)) << own;
    EXPECT_EQ(std::regex_replace(text, name, "$1gridiron"), text_of(kPages / other)) << own;
  }
  const std::string both = ". " + (mpi / "bash" / "gridiron_mpi").string() + "; ";
  EXPECT_EQ(bash_line(both + "complete -p gridiron_mpi"), "complete -F _gridiron gridiron_mpi\n");
  EXPECT_EQ(bash_line(both + "COMP_WORDS=(gridiron_mpi pa); COMP_CWORD=1; _gridiron; echo ${COMPREPLY[*]}"), "pack\n");
  EXPECT_EQ(text_of(mpi / "zsh" / "_gridiron_mpi").find("#compdef gridiron_mpi\n"), 0u);
  EXPECT_NE(text_of(mpi / "fish" / "gridiron_mpi.fish").find("\ncomplete -c gridiron_mpi -f\n"), std::string::npos);
  EXPECT_NE(text_of(mpi / "man1" / "gridiron_mpi.1").find("gridiron (1)"), std::string::npos);
}

TEST(Manual, ZshReadsItsFunctionAndItsPatterns) {
  if (!has_program("zsh")) GTEST_SKIP() << "zsh is not installed";
  const std::string function = (kPages / "zsh" / "_gridiron").string();
  const ScriptResult result = run_script("zsh -n '" + function + "'");
  EXPECT_EQ(result.exit_code, 0) << result.output;
  EXPECT_EQ(result.output, "");
  // Outside of a completion, with functions that print what they are to offer in place of zsh's.
  const ScratchDirectory scratch;
  for (const char* name : {"a.ply", "ball.nff", "notes.txt", "view.camera"}) scratch.write(name, "");
  const std::pair<const char*, const char*> cases[] = {
      {"\"x y\" \"\"", "x\ny\n"},
      {"\"\" camera", "view.camera\n"},
      {"z \"ply|nff|gri\"", "z\na.ply\nball.nff\n"},
      {"\"\" /", "folders\n"},
  };
  for (const auto& [offer, expected] : cases) {
    const ScriptResult offered =
        run_script("cd '" + scratch.path().string() +
                   "' && zsh -f -c 'compadd() { shift; print -l -- \"$@\"; }; _arguments() { : ; }; " +
                   "_files() { if [[ $1 = -g ]]; then print -l -- ${~2}; else print folders; fi; }; . " + function +
                   "; _gridiron_offer " + offer + "'");
    EXPECT_EQ(offered.output, expected) << offer;
  }
}

TEST(Manual, FishCompletesLines) {
  if (!has_program("fish")) GTEST_SKIP() << "fish is not installed";
  const ScratchDirectory scratch;
  for (const char* name : {"a.ply", "ball.nff", "notes.txt", "view.camera", "my.machine"}) scratch.write(name, "");
  const std::pair<const char*, const char*> cases[] = {
      {"re", "render result"},
      {"render ", "a.ply ball.nff"},
      {"render a.ply --mach", "--machine"},
      {"render a.ply --machine fu", "fu540"},
      {"render a.ply --machine=my", "--machine=my.machine"},
      {"render a.ply --camera ", "view.camera"},
      {"info a.ply --accuracy st", "standard"},
      {"experiment d", "dynamic"},
      {"help ex", "experiment"},
  };
  for (const auto& [line, expected] : cases) {
    const std::string fish = "HOME=$PWD XDG_CONFIG_HOME=$PWD/config XDG_DATA_HOME=$PWD/data fish --no-config";
    const std::string source = "source " + (kPages / "fish" / "gridiron.fish").string();
    const ScriptResult result =
        run_script("cd '" + scratch.path().string() + "' && (" + fish + " -c '" + source + "; complete -C \"gridiron " +
                   line + "\"' | cut -f 1 | grep -v / | sort | paste -s -d ' ')");
    EXPECT_EQ(result.output, std::string(expected) + "\n") << line;
  }
}

}  // namespace
}  // namespace gridiron::test
