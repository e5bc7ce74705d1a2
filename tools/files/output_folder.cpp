// Output folder. SPDX-License-Identifier: Apache-2.0
#include "output_folder.h"

#include <system_error>
#include <utility>

#include "base/failure.h"
#include "command_files.h"

namespace gridiron::tool {
namespace {

namespace fs = std::filesystem;

// Why a folder could not be made: the kind of file in its place, or the error.
std::string words_of(const std::error_code& error, const fs::path& path) {
  std::error_code ignored;
  if (fs::exists(path, ignored)) return "a file of that name is there";
  if (!fs::is_symlink(path, ignored)) return error.message();
  return "it is a link to '" + fs::read_symlink(path, ignored).string() + "', which is not there";
}

}  // namespace

OutputFolder::OutputFolder(std::filesystem::path path, const std::vector<std::string>& names) : path_(std::move(path)) {
  if (path_ == "-") usage_error("-o -: a folder cannot be standard output");
  std::error_code error;
  {
    const Undivided step;
    made_ = std::filesystem::create_directory(path_, error);
    if (made_) leftover_.remember(path_);
  }
  if (error) {
    input_error(path_, "cannot make the folder: " + words_of(error, path_));
  }
  try {
    std::vector<Output> outputs;
    for (const std::string& name : names) outputs.push_back({"", path_ / name, OutputKind::kText});
    declare_outputs(outputs);
  } catch (...) {
    remove_if_made();
    throw;
  }
}

void OutputFolder::keep() {
  const Undivided step;
  kept_ = true;
  leftover_.forget();
}

void OutputFolder::remove_if_made() {
  std::error_code ignored;
  if (made_ && !kept_) std::filesystem::remove(path_, ignored);  // only where empty
}

}  // namespace gridiron::tool
