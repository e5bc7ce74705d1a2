// Command facts. SPDX-License-Identifier: Apache-2.0
#include "command_facts.h"

#include <gridiron/version.h>

#include "gridiron/command_line/command_table.h"

namespace gridiron::tool {
namespace {

OptionFacts facts_of(CLI::Option& option) {
  OptionFacts facts;
  for (const std::string& name : option.get_snames()) facts.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) facts.names.push_back("--" + name);
  if (facts.names.empty()) facts.names.push_back(option.get_name(/*positional=*/true));
  facts.takes_value = option.get_items_expected_max() > 0;
  if (facts.takes_value) facts.type = option.get_type_name();
  facts.help = option.get_description();
  facts.is_required = option.get_required();
  facts.takes_many = option.get_items_expected_max() > 1;
  facts.offer = offer_of(option);
  return facts;
}

CommandFacts facts_of(CLI::App& app) {
  CommandFacts facts{app.get_name(), app.get_description(), app.get_footer(), {}, {}};
  for (CLI::Option* option : app.get_options()) {
    OptionFacts each = facts_of(*option);
    (each.is_argument() ? facts.arguments : facts.options).push_back(std::move(each));
  }
  return facts;
}

}  // namespace

ProgramFacts program_facts() {
  CommandTable table;
  ProgramFacts facts{kVersion, facts_of(table.app), {}};
  facts.program.name.clear();
  for (CLI::App* command : table.app.get_subcommands([](const CLI::App*) { return true; })) {
    facts.commands.push_back(facts_of(*command));
  }
  return facts;
}

}  // namespace gridiron::tool
