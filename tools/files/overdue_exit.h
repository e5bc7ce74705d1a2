// Overdue exit: ends the program if an interrupt has not been noticed for a quarter of a second. Long calls, for
// example of the grid's builder or the encoder of pictures, therefore need not check the flag.
// Memory: a list of names in static storage. Threads: any. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

namespace gridiron::tool {

/// Starts the watch. If the host has no timer for it, only checks of the flag notice an interrupt.
void begin_overdue_exit();

/// Called by a signal's handler: if the program is still running a moment later, it exits with `exit_code`. Remembered
/// files are removed then, and standard error says that the command was interrupted.
void expect_exit(int exit_code);

/// While one exists, on any thread, the program does not exit so: the enclosed work is done completely or not at all.
/// Short.
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

/// Sets the number of files that have got their names, for the last message. Precondition: an Undivided exists.
void note_written_files(std::size_t count);

/// From now on interrupts have no effect: all files are written, and the command ends normally. Precondition: an
/// Undivided exists.
void outputs_are_complete();

/// From now on an overdue exit prints there. Before any signal that should.
void say_overdue_exits_on(int descriptor);

/// Prints on standard error how the command ended, unless an overdue exit has done so.
void say_last_words(const char* words);

}  // namespace gridiron::tool
