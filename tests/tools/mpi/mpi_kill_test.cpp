// Ranks killed at random moments: the job ends, no picture is half written, and --resume completes it. A full disk.
// Longer tests, of the ctest label `full`. SPDX-License-Identifier: Apache-2.0
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <random>
#include <thread>

#include "mpi_run.h"

namespace gridiron::test {
namespace {

namespace fs = std::filesystem;

class MpiKill : public MpiFull {
 protected:
  // Starts a line of the shell in a process of its own, its words going to `err`.
  [[nodiscard]] pid_t start(const std::string& line) {
    const pid_t process = ::fork();
    if (process != 0) return process;
    const std::string script = "cd '" + folder_.folder().string() + "' && exec env " + line + " > out.txt 2> err.txt";
    ::execl("/bin/bash", "bash", "-c", script.c_str(), nullptr);
    ::_exit(127);
  }

  // The ranks that mpirun has started so far, in no order.
  [[nodiscard]] static std::vector<pid_t> ranks_of(pid_t mpirun) {
    const std::string id = std::to_string(mpirun);
    std::ifstream file("/proc/" + id + "/task/" + id + "/children");
    std::vector<pid_t> children;
    for (pid_t child = 0; file >> child;) children.push_back(child);
    return children;
  }

  // Waits for mpirun, two minutes at most: Open MPI 4.1 sometimes hangs in its own end when a rank dies while it
  // connects. By then all ranks must have ended. @returns its exit code; 1 if it was killed.
  [[nodiscard]] static int wait_for(pid_t mpirun, const std::vector<pid_t>& ranks) {
    int status = 0;
    for (int wait = 0; wait < 12000; ++wait) {
      if (::waitpid(mpirun, &status, WNOHANG) == mpirun) return WIFEXITED(status) ? WEXITSTATUS(status) : 1;
      ::usleep(10000);
    }
    for (const pid_t rank : ranks) {
      const std::string state = read_state(rank);
      EXPECT_TRUE(state.empty() || state == "Z") << "rank " << rank << " runs on: " << state;
    }
    ::kill(mpirun, SIGKILL);
    (void)::waitpid(mpirun, &status, 0);
    return 1;
  }

  [[nodiscard]] static std::string read_state(pid_t process) {
    std::ifstream file("/proc/" + std::to_string(process) + "/stat");
    std::string id, name, state;
    file >> id >> name >> state;
    return state;
  }

  const TemporaryFolder folder_{"a.ply", make_sphere(60, 80, 1.0f)};
};

TEST_F(MpiKill, AtTenMomentsAndResumed) {
  const std::string turn = " animate a.ply --turntable 12 --size 512x512 --threads 1 -o ";
  ASSERT_EQ(run_shell(folder_.folder(), "\"$GRIDIRON\"" + turn + "alone").exit_code, 0);
  const std::map<std::string, std::string> whole = files_of(folder_.path("alone"));
  std::mt19937 random(27);
  int ended_early = 0;
  const auto pictures = [this] {
    std::size_t count = 0;
    if (!fs::exists(folder_.path("out"))) return count;
    for (const auto& entry : fs::directory_iterator(folder_.path("out"))) count += entry.path().extension() == ".png";
    return count;
  };
  for (int i = 0; i < 10; ++i) {
    SCOPED_TRACE("moment " + std::to_string(i));
    const bool begins = i % 3 == 0;  // else it goes on with what the last one left
    if (begins) fs::remove_all(folder_.path("out"));
    const pid_t mpirun = start(ranks_line(3) + turn + "out" + (begins ? "" : " --resume"));
    std::vector<pid_t> ranks;
    for (int wait = 0; wait < 2000 && (ranks = ranks_of(mpirun)).size() < 3; ++wait) ::usleep(5000);
    ASSERT_EQ(ranks.size(), 3u);
    // By pictures, not by the clock: some time after the next one, two or three. Of twelve, three rounds leave some.
    const std::size_t wanted = pictures() + 1 + random() % 3;
    while (pictures() < wanted && ::kill(mpirun, 0) == 0 && !read_state(ranks[0]).empty()) ::usleep(1000);
    std::this_thread::sleep_for(std::chrono::milliseconds(random() % 20));
    ::kill(ranks[random() % 3], random() % 2 == 0 ? SIGKILL : SIGTERM);
    const int code = wait_for(mpirun, ranks);
    const std::string words = read_file(folder_.path("err.txt"));
    if (code != 0) {
      ++ended_early;
      EXPECT_NE(words, "");
    }
    // A picture is whole or not there. A file that SIGKILL interrupts may stay under its temporary name.
    for (const auto& [name, bytes] : fs::exists(folder_.path("out")) ? files_of(folder_.path("out")) : whole) {
      if (!name.ends_with(".png")) continue;
      EXPECT_TRUE(bytes == whole.at(name)) << name << "\n" << words;
    }
  }
  EXPECT_GE(ended_early, 5) << "the moments are too late for this host";
  const ProgramResult result = run_shell(folder_.folder(), ranks_line(3) + turn + "out --resume");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  std::map<std::string, std::string> files = files_of(folder_.path("out"));
  std::erase_if(files, [](const auto& file) { return file.first.starts_with(".gridiron."); });
  EXPECT_EQ(files, whole);
}

TEST_F(MpiKill, AFullDiskEndsAnAnimation) {
  const std::string mount = "mkdir -p disk && mount -t tmpfs -o size=64k none disk";
  const std::string line = "unshare -m bash -c \"" + mount + " && exec env " + ranks_line(3) +
                           " animate a.ply --turntable 12 --size 256x256 -o disk/out\"";
  if (run_shell(folder_.folder(), "unshare -m bash -c '" + mount + "'").exit_code != 0) {
    GTEST_SKIP() << "no right to mount a small disk";
  }
  const ProgramResult result = run_shell(folder_.folder(), line);
  EXPECT_EQ(result.exit_code, 1) << result.err;
  EXPECT_NE(result.err.find("cannot write: No space left on device"), std::string::npos) << result.err;
}

}  // namespace
}  // namespace gridiron::test
