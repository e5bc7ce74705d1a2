// Man pages. SPDX-License-Identifier: Apache-2.0
#include "man_pages.h"

#include <sstream>
#include <string_view>
#include <utility>

#include "base/failure.h"

namespace gridiron::tool {
namespace {

// Text as roff prints it: a minus that can be copied, no escapes, no request at the start of a line. A line may break
// behind a bar of a long list of choices.
std::string roff(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '\\':
        out += "\\e";
        break;
      case '-':
        out += "\\-";
        break;
      case '|':
        out += "|\\:";
        break;
      case '\'':
        out += "\\(aq";
        break;
      default:
        out += c;
    }
  }
  return out.starts_with('.') ? "\\&" + out : out;
}

std::string bold(std::string_view text) {
  return "\\fB" + roff(text) + "\\fR";
}

std::string italic(std::string_view text) {
  return "\\fI" + roff(text) + "\\fR";
}

std::string section(std::string_view name) {
  return ".SH " + std::string(name) + "\n";
}

// A term and what it means.
std::string entry(const std::string& term, std::string_view meaning) {
  return ".TP\n" + term + "\n" + roff(meaning) + "\n";
}

// "-o FILE, --output FILE" is written "-o, --output FILE".
std::string term_of(const OptionFacts& option) {
  if (option.is_argument()) {
    return italic(option.names.front()) + (option.type.empty() ? "" : " (" + roff(option.type) + ")");
  }
  std::string term;
  for (const std::string& name : option.names) term += (term.empty() ? "" : ", ") + bold(name);
  return option.type.empty() ? term : term + " " + italic(option.type);
}

std::string sentence(std::string text) {
  if (text.front() >= 'a' && text.front() <= 'z') text.front() = static_cast<char>(text.front() - 'a' + 'A');
  return text.ends_with('.') ? text : text + ".";
}

std::string meaning_of(const OptionFacts& option) {
  if (option.is_required && !option.is_argument()) return "Required: " + option.help + ".";
  const std::vector<std::string>& choices = option.offer.words;
  const bool begins_with_choice = !choices.empty() && option.help.starts_with(choices.front());  // it is a name
  return begins_with_choice ? option.help + "." : sentence(option.help);
}

// Lines of a help's footer: "key: meaning" is an entry, indented lines are an example, others are text.
std::string footer_text(const std::string& footer) {
  std::string out;
  std::istringstream lines(footer);
  std::string line;
  bool is_example = false;
  while (std::getline(lines, line)) {
    if (line.starts_with("  ") != is_example && !line.empty()) {
      out += is_example ? ".EE\n" : ".PP\n.EX\n";
      is_example = !is_example;
    }
    const std::size_t colon = line.find(": ");
    if (line.empty()) {
      if (!is_example) out += ".PP\n";
    } else if (!is_example && colon != std::string::npos && line.find(' ') > colon) {
      out += entry(bold(line.substr(0, colon)), line.substr(colon + 2));
    } else {
      // A sentence behind entries is no part of the last one.
      if (!is_example && out.rfind(".TP\n") != std::string::npos && out.rfind(".TP\n") > out.rfind(".PP\n"))
        out += ".PP\n";
      out += roff(line) + "\n";
    }
  }
  return out + (is_example ? ".EE\n" : "");
}

std::string heading(const ProgramFacts& facts, std::string_view name, std::string_view summary) {
  std::string upper(name);
  for (char& c : upper) c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  return ".\\\" Written by tools/manual from the options of the program. SPDX-License-Identifier: Apache-2.0\n"
         ".TH " +
         roff(upper) + " 1 \"\" \"Gridiron " + facts.version + "\" \"Gridiron\"\n" +
         ".nh\n.ad l\n" +  // names are not to be parted, nor lines to be stretched for them
         section("NAME") + roff(name) + " \\- " +
         roff(summary.ends_with('.') ? summary.substr(0, summary.size() - 1) : summary) + "\n";
}

std::string entries_of(const std::vector<OptionFacts>& options) {
  std::string out;
  for (const OptionFacts& option : options) out += entry(term_of(option), meaning_of(option));
  return out;
}

std::string exit_status() {
  const std::pair<ExitCode, const char*> codes[] = {
      {ExitCode::kDone, "Done."},
      {ExitCode::kBadInput,
       "An input is missing or wrong, a scene does not fit the machine, or an output cannot be written."},
      {ExitCode::kUsage, "The command line makes no sense."},
      {ExitCode::kCheckFailed,
       "The simulator found a broken rule, a budget does not hold, or a device's frame failed or differs."},
      {ExitCode::kHungUp, "SIGHUP ended the command."},
      {ExitCode::kInterrupted, "SIGINT ended the command."},
      {ExitCode::kTerminated, "SIGTERM ended the command."},
  };
  std::string out = section("EXIT STATUS");
  for (const auto& [code, meaning] : codes) out += entry(bold(std::to_string(static_cast<int>(code))), meaning);
  return out;
}

std::string reference(const std::string& page) {
  return ".BR " + roff(page) + " (1)";
}

// Where packages install the documents.
std::string documents(const std::string& page = "tools/README.md") {
  return section("FILES") +
         entry(italic("PREFIX/share/doc/gridiron/README.md"), "What Gridiron is, and where to read on. " + page +
                                                                  " beside it explains all commands, files and "
                                                                  "figures of this program.");
}

}  // namespace

std::string page_name(const CommandFacts& command) {
  return "gridiron-" + command.name;
}

std::string program_page(const ProgramFacts& facts) {
  std::string page = heading(facts, "gridiron", facts.program.help);
  page += section("SYNOPSIS") + bold("gridiron") + " " + italic("COMMAND") + " [" + italic("OPTION") + " ...] [" +
          italic("ARGUMENT") + " ...]\n.br\n" + bold("gridiron help") + " [" + italic("COMMAND") + "]\n.br\n" +
          bold("gridiron --version") + "\n";
  page += section("COMMANDS");
  for (const CommandFacts& command : facts.commands) page += entry(bold(command.name), sentence(command.help));
  page += section("OPTIONS") + entries_of(facts.program.options) + ".PP\n" + roff(facts.program.footer) + "\n";
  page += exit_status();
  page += section("EXAMPLES");
  const std::pair<const char*, const char*> examples[] = {
      {"gridiron render scene.ply -o picture.png", "A picture, and what the frame costs on the chip."},
      {"gridiron render scene.ply --mode plain", "The picture alone, fast: nothing is simulated."},
      {"gridiron info scene.ply", "What a scene holds and what it needs."},
      {"gridiron machines", "The chips that can be simulated."},
  };
  for (const auto& [command, meaning] : examples) page += entry(bold(command), meaning);
  page += documents() + section("SEE ALSO");
  std::string references;
  for (const CommandFacts& command : facts.commands) {
    if (command.name == "help") continue;  // these pages are its text
    references += (references.empty() ? "" : ",\n") + reference(page_name(command));
  }
  return page + references + "\n";
}

std::string mpi_page(const ProgramFacts& facts) {
  std::string page = heading(facts, "gridiron_mpi", "one command of gridiron by many processes");
  page += section("SYNOPSIS") + bold("mpirun -n") + " " + italic("N") + " " + bold("gridiron_mpi") + " " +
          italic("COMMAND") + " [" + italic("OPTION") + " ...] [" + italic("ARGUMENT") + " ...]\n";
  page += section("DESCRIPTION") +
          roff(
              "It takes the commands, options and arguments of gridiron and writes the same files. The processes of an "
              "MPI, the ranks, share the work of render, animate and experiment. Rank 0 runs every other command "
              "alone.") +
          "\n";
  page += section("DIFFERENCES");
  const std::pair<const char*, const char*> differences[] = {
      {"Inputs",
       "Files that several ranks read, such as those of --machine and the frames of animate, must lie where all "
       "nodes see them."},
      {"Outputs",
       "Rank 0 alone writes and prints. A picture cannot go to -, since mpirun gives rank 0 a terminal; text can."},
      {"Times",
       "The times of the host in reports, and the files host_* of an experiment, differ from those of "
       "gridiron."},
      {"--threads", "The threads of each rank. Without it, ranks with the same processors divide them."},
      {"Progress", "A line every 10 seconds."},
  };
  for (const auto& [term, meaning] : differences) page += entry(bold(term), meaning);
  page += section("EXIT STATUS") +
          roff("That of gridiron, whichever rank failed. Where a signal ended a rank: that of mpirun.") + "\n";
  page += section("EXAMPLES") + entry(bold("mpirun -n 4 gridiron_mpi animate bunny.ply -o turn --turntable 48"),
                                      "48 pictures, 12 of each rank.");
  return page + documents("tools/mpi/README.md") + section("SEE ALSO") + reference("gridiron") + ",\n" +
         reference("mpirun") + "\n";
}

std::string command_page(const ProgramFacts& facts, const CommandFacts& command) {
  std::string page = heading(facts, page_name(command), command.help);
  page += section("SYNOPSIS") + bold("gridiron " + command.name);
  for (const OptionFacts& option : command.options) {
    if (option.is_required) page.append(" ").append(bold(option.names.front())).append(" ").append(italic(option.type));
  }
  page.append(" [").append(italic("OPTION")).append(" ...]");
  for (const OptionFacts& argument : command.arguments) {
    const std::string name = italic(argument.names.front()) + (argument.takes_many ? " ..." : "");
    page += argument.is_required ? " " : " [";
    page += name;
    if (!argument.is_required) page += "]";
  }
  page += "\n";
  if (!command.arguments.empty()) page += section("ARGUMENTS") + entries_of(command.arguments);
  page += section("OPTIONS") + entries_of(command.options);
  if (!command.footer.empty()) page += section("MACHINE FILES") + footer_text(command.footer);
  return page + exit_status() + documents() + section("SEE ALSO") + reference("gridiron") + "\n";
}

}  // namespace gridiron::tool
