// The gridiron_mpi program: one of the processes that mpirun starts. Rank 0 prints and writes files; the others print
// nothing. SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <gridiron/version.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>

#include "base/kept_notes.h"
#include "base/numbers.h"
#include "files/command_files.h"
#include "files/overdue_exit.h"
#include "gridiron/program.h"
#include "import/model_import.h"
#include "measured_ranks.h"
#include "mpi_ranks.h"

// Tests build a program of another version.
#ifndef GRIDIRON_MPI_VERSION
#define GRIDIRON_MPI_VERSION gridiron::kVersion
#endif

namespace {

using namespace gridiron::tool;

// Results of other ranks than 0 go nowhere. @returns standard error, for last words.
int silence() {
  const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  (void)::dup2(nowhere, STDOUT_FILENO);
  (void)::close(nowhere);
  return keep_notes();
}

std::string joined(int count, const char* const* values) {
  std::string text;
  for (int i = 1; i < count; ++i) text += std::string(values[i]) + '\n';
  return text;
}

// `--costs FILE` before the command records what each rank does between messages (tools/mpi/scaling).
std::optional<std::string> costs_file(int& count, char**& values) {
  if (count < 3 || std::string_view(values[1]) != "--costs") return std::nullopt;
  std::string file = values[2];
  values[2] = values[0];
  values += 2;
  count -= 2;
  return file;
}

// A launcher of another MPI starts processes of which each takes itself for the only one: all would do the whole work,
// and write the same files.
void require_own_launcher(const MpiRanks& ranks) {
  if (ranks.count() > 1 || std::getenv("OMPI_COMM_WORLD_SIZE") != nullptr) return;
  for (const char* const name : {"PMI_SIZE", "SLURM_STEP_NUM_TASKS"}) {
    const char* const value = std::getenv(name);
    const std::optional<std::uint32_t> tasks = value != nullptr ? parse_count(value) : std::nullopt;
    if (!tasks || *tasks <= 1) continue;
    throw Failure(ExitCode::kUsage, "the launcher started " + std::to_string(*tasks) + " processes (" + name +
                                        "), of which each is alone: it serves another MPI than that of this program"
                                        " (with srun: --mpi=pmix)");
  }
}

// What is left is to wait for the others, or to say how this rank has failed.
void end_interrupts() {
  const Undivided step;
  outputs_are_complete();
}

// A command that failed anywhere has failed everywhere.
ProgramEnd run(MpiRanks& ranks, std::optional<MeasuredRanks>& measured, int count, const char* const* values) {
  try {
    require_own_launcher(ranks);
    ranks.require_alike(GRIDIRON_MPI_VERSION, joined(count, values));
    ProgramEnd end = run_program(count, values);
    if (end.code == ExitCode::kDone && measured) measured->write();
    if (end.code != ExitCode::kDone) return end;
    end_interrupts();
    ranks.finish();
    return end;
  } catch (const Failure& failure) {
    return end_of(failure);
  }
}

}  // namespace

int main(int count, char** values) {
  if (const std::optional<int> code = serve_import(count, values)) return *code;
  std::optional<MpiRanks> ranks;
  try {
    ranks.emplace();
  } catch (const Failure& failure) {
    std::fprintf(stderr, "gridiron_mpi: %s\n", failure.what());
    return static_cast<int>(failure.code());
  }
  const std::optional<std::string> costs = costs_file(count, values);
  std::optional<MeasuredRanks> measured;
  if (costs) measured.emplace(*ranks, *costs);
  const RanksInUse in_use(measured ? static_cast<Ranks&>(*measured) : *ranks);
  const int error = ranks->is_first() ? STDERR_FILENO : silence();
  say_overdue_exits_on(error);
  ProgramEnd end;
  {
    const CommandFiles files;
    end = run(*ranks, measured, count, values);
    if (end.code == ExitCode::kDone) return 0;
    end.words += "\n";
    if (ranks->is_first()) say_last_words(end.words.c_str());
  }
  if (!ranks->is_first()) {
    end_interrupts();
    end.words.pop_back();
    ranks->report_failure(end.code, end.words);
    // Rank 0 has not heard: it is in a long call, or has ended.
    const std::string words = ranks->name() + ": " + end.words + "\n";
    (void)!::write(error, words.data(), words.size());
  }
  MpiRanks::abort(static_cast<int>(end.code));
}
