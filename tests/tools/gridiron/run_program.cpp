// Runs the gridiron program. SPDX-License-Identifier: Apache-2.0
#include "run_program.h"

#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <thread>

#include "temporary_folder.h"

namespace gridiron::test {
namespace {

// A file without a name: the program's folder must hold nothing that the program did not write.
int open_nameless() {
  std::string name = (std::filesystem::temp_directory_path() / "gridiron_output.XXXXXX").string();
  const int descriptor = ::mkostemp(name.data(), O_CLOEXEC);
  EXPECT_GE(descriptor, 0) << name;
  ::unlink(name.c_str());
  return descriptor;
}

std::string take_text(int descriptor) {
  std::string text;
  char buffer[4096];
  ::lseek(descriptor, 0, SEEK_SET);
  for (ssize_t got = 0; (got = ::read(descriptor, buffer, sizeof buffer)) > 0;) {
    text.append(buffer, static_cast<std::size_t>(got));
  }
  ::close(descriptor);
  return text;
}

}  // namespace

RunningProgram::RunningProgram(const std::filesystem::path& folder, const Words& arguments)
    : out_(open_nameless()), err_(open_nameless()) {
  std::vector<std::string> words = {GRIDIRON_PROGRAM};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> values;
  for (std::string& word : words) values.push_back(word.data());
  values.push_back(nullptr);
  process_ = ::fork();
  if (process_ == 0) {
    ::signal(SIGINT, SIG_DFL);  // tests may run in the background, where shells ignore it
    ::dup2(out_, STDOUT_FILENO);
    ::dup2(err_, STDERR_FILENO);
    if (::chdir(folder.c_str()) == 0) ::execv(values[0], values.data());
    ::_exit(127);
  }
}

RunningProgram::~RunningProgram() {
  if (process_ > 0) (void)wait();
}

void RunningProgram::send(int signal) const {
  ::kill(process_, signal);
}

void RunningProgram::wait_until_caught(int signal) const {
  const std::string status = "/proc/" + std::to_string(process_) + "/status";
  const std::string key = "SigCgt:";  // 64 bits in hexadecimal, the lowest is signal 1
  for (int i = 0; i < 12000; ++i) {
    std::ifstream file(status);
    for (std::string line; std::getline(file, line);) {
      if (!line.starts_with(key)) continue;
      const unsigned long long caught = std::stoull(line.substr(key.size()), nullptr, 16);
      if ((caught >> (signal - 1) & 1u) != 0) return;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  ADD_FAILURE() << "signal " << signal << " is not caught";
}

pid_t RunningProgram::stop_child() const {
  const std::string id = std::to_string(process_);
  const std::string own = read_file("/proc/" + id + "/cmdline");
  for (int i = 0; i < 60000; ++i) {
    std::ifstream file("/proc/" + id + "/task/" + id + "/children");
    if (pid_t child = -1; file >> child) {
      // Before its exec the parent waits for it inside of vfork, where no signal reaches either.
      const std::string words = read_file("/proc/" + std::to_string(child) + "/cmdline");
      if (!words.empty() && words != own) {
        ::kill(child, SIGSTOP);
        return child;
      }
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return -1;
}

ProgramResult RunningProgram::wait() {
  int status = 0;
  ::waitpid(process_, &status, 0);
  process_ = -1;
  ProgramResult result;
  result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  result.out = take_text(out_);
  result.err = take_text(err_);
  return result;
}

ProgramResult RunningProgram::wait(std::chrono::milliseconds most) {
  const auto end = std::chrono::steady_clock::now() + most;
  siginfo_t info{};
  const auto has_ended = [&] {
    return ::waitid(P_PID, static_cast<id_t>(process_), &info, WEXITED | WNOHANG | WNOWAIT) == 0 && info.si_pid != 0;
  };
  while (!has_ended() && std::chrono::steady_clock::now() < end) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  if (!has_ended()) send(SIGKILL);
  return wait();
}

ProgramResult run_shell(const std::filesystem::path& folder, const std::string& line) {
  const TemporaryFolder outside;
  const std::string out = outside.path("out").string(), err = outside.path("err").string();
  const std::string script = outside.write("line", "GRIDIRON='" GRIDIRON_PROGRAM "'\n" + line + "\n").string();
  const std::string command = "cd '" + folder.string() + "' && bash '" + script + "' > '" + out + "' 2> '" + err + "'";
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status), read_file(out), read_file(err)};
}

ProgramResult run_program(const std::filesystem::path& folder, const Words& arguments) {
  RunningProgram program(folder, arguments);
  return program.wait();
}

Words operator+(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

Words with_reference(Words words) {
  if (std::ranges::find(words, "--configuration") != words.end()) return words;
  return std::move(words) + Words{"--configuration", "reference"};
}

ProgramResult run(const TemporaryFolder& folder, const Words& arguments) {
  const ProgramResult result = run_program(folder.folder(), arguments);
  EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
  return result;
}

void expect_failure(const TemporaryFolder& folder, const Words& arguments, int exit_code, const std::string& words) {
  constexpr int kCheckFailed = 3;  // differences are reported as a result
  SCOPED_TRACE(testing::PrintToString(arguments));
  const Words before = folder.names();
  const ProgramResult result = run_program(folder.folder(), arguments);
  EXPECT_EQ(result.exit_code, exit_code) << result.err;
  EXPECT_NE(result.err.find(words), std::string::npos) << result.err << "\nlacks: " << words;
  if (exit_code != kCheckFailed) {
    EXPECT_EQ(result.out, "");
  }
  EXPECT_EQ(folder.names(), before) << "a file was left behind or lost";
}

}  // namespace gridiron::test
