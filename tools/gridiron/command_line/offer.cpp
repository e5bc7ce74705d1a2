// Offers. SPDX-License-Identifier: Apache-2.0
#include "offer.h"

#include <gridiron/sim/machine_profile.h>

#include <CLI/CLI.hpp>
#include <sstream>
#include <utility>

namespace gridiron::tool {
namespace {

// CLI11's options have no place for data of ours but the names of their validators. One that is not active checks
// nothing; its name begins with this line, and has a line for each word (w), ending (e) and kind of name (f, d).
constexpr const char* kMark = "offer";

std::string text_of(const Offer& offer) {
  std::string text = kMark;
  for (const std::string& word : offer.words) text += "\nw" + word;
  for (const std::string& ending : offer.endings) text += "\ne" + ending;
  if (offer.has_files) text += "\nf";
  if (offer.has_folders) text += "\nd";
  return text;
}

// The validator that has the offer; null: none.
CLI::Validator* holder_of(CLI::Option& option) {
  for (int i = 0;; ++i) {
    try {
      CLI::Validator* validator = option.get_validator(i);
      if (validator->get_name().starts_with(kMark)) return validator;
    } catch (const CLI::OptionNotFound&) {
      return nullptr;  // there are no more
    }
  }
}

}  // namespace

void set_offer(CLI::Option& option, const Offer& offer) {
  if (CLI::Validator* holder = holder_of(option)) {
    holder->name(text_of(offer));
    return;
  }
  CLI::Validator holder;
  holder.name(text_of(offer));
  holder.active(false);
  option.check(std::move(holder));
}

Offer offer_of(CLI::Option& option) {
  Offer offer;
  const CLI::Validator* holder = holder_of(option);
  if (holder == nullptr) return offer;
  std::istringstream lines(holder->get_name());
  std::string line;
  std::getline(lines, line);  // the mark
  while (std::getline(lines, line)) {
    switch (line.front()) {
      case 'w':
        offer.words.push_back(line.substr(1));
        break;
      case 'e':
        offer.endings.push_back(line.substr(1));
        break;
      case 'f':
        offer.has_files = true;
        break;
      default:
        offer.has_folders = true;
    }
  }
  return offer;
}

void offer_files(CLI::Option& option, std::vector<std::string> endings) {
  set_offer(option, {.words = {}, .endings = std::move(endings), .has_files = true});
}

void offer_folders(CLI::Option& option) {
  set_offer(option, {.words = {}, .endings = {}, .has_folders = true});
}

void offer_machines(CLI::Option& option) {
  Offer offer{.words = {}, .endings = {"machine"}, .has_files = true};
  for (const sim::MachineProfile& profile : sim::machine_profiles()) offer.words.emplace_back(profile.name);
  set_offer(option, offer);
}

}  // namespace gridiron::tool
