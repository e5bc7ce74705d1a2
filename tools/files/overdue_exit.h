// Overdue exit: ends the program where an interrupt has not been noticed for a quarter of a second. Long calls, of the
// grid's builder or the encoder of pictures say, so need not look at the flag.
// Memory: a list of names in static storage. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

namespace gridiron::tool {

/// Watches from now on. Where the host has no timer for it, an interrupt is noticed by whoever looks at the flag only.
void begin_overdue_exit();

/// Called by the handler of a signal: the program leaves with `exit_code` when it is still there a moment later. What
/// has been remembered is removed then, and standard error says that the command was interrupted.
void expect_exit(int exit_code);

/// While one lives, on any thread, the program does not leave so: what it encloses is done whole or not at all. Short.
class Undivided {
 public:
  Undivided();
  ~Undivided();
  Undivided(const Undivided&) = delete;
  Undivided& operator=(const Undivided&) = delete;
};

/// A temporary file, or a folder that may be empty, which must not outlive an interrupted command.
///
/// Precondition: remember() and forget() are called while an Undivided lives, which also encloses the call that makes
/// the file, renames or removes it.
class Leftover {
 public:
  Leftover() = default;
  ~Leftover();
  Leftover(const Leftover&) = delete;
  Leftover& operator=(const Leftover&) = delete;

  void remember(std::string path);
  void forget();

 private:
  friend void remove_leftovers();

  std::string path_;  ///< empty: nothing is remembered
  Leftover* next_ = nullptr;
};

/// Says how many files have got their names, for the words at the end. Precondition: an Undivided lives.
void note_written_files(std::size_t count);

/// From now on an interrupt comes too late: all files are written, and the command ends as if none had come.
/// Precondition: an Undivided lives.
void outputs_are_complete();

/// Says on standard error how the command ended, unless an overdue exit has done so.
void say_last_words(const char* words);

}  // namespace gridiron::tool
