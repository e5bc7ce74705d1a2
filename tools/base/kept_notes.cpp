// Kept notes. SPDX-License-Identifier: Apache-2.0
#include "kept_notes.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

namespace gridiron::tool {
namespace {

bool are_kept = false;

}  // namespace

int keep_notes() {
  const int before = ::fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 3);
  int notes = ::memfd_create("notes", MFD_CLOEXEC);
  are_kept = notes >= 0;
  if (!are_kept) notes = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  (void)::dup2(notes, STDERR_FILENO);
  (void)::close(notes);
  return before;
}

std::string take_notes() {
  if (!are_kept) return "";
  std::string notes;
  char piece[4096];
  for (::ssize_t count = 0;
       (count = ::pread(STDERR_FILENO, piece, sizeof piece, static_cast<::off_t>(notes.size()))) > 0;) {
    notes.append(piece, static_cast<std::size_t>(count));
  }
  (void)!::ftruncate(STDERR_FILENO, 0);
  (void)::lseek(STDERR_FILENO, 0, SEEK_SET);
  return notes;
}

}  // namespace gridiron::tool
