#include "program.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <sstream>
#include <thread>

extern char** environ;

namespace evenmesh::test {
namespace {

std::string drain(int file) {
  std::string bytes;
  char buffer[65536];
  for (ssize_t n = 0; (n = read(file, buffer, sizeof buffer)) > 0;) bytes.append(buffer, static_cast<std::size_t>(n));
  close(file);
  return bytes;
}

void feed(int file, const std::string& bytes) {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t n = ::write(file, bytes.data() + done, bytes.size() - done);
    if (n <= 0) break;
    done += static_cast<std::size_t>(n);
  }
}

struct Pipe {
  int ends[2] = {-1, -1};
  Pipe() { EXPECT_EQ(pipe2(ends, O_CLOEXEC), 0); }
};

}  // namespace

Outcome run_program(const std::vector<std::string>& arguments, const std::filesystem::path& folder,
                    const Spawn& spawn) {
  signal(SIGPIPE, SIG_IGN);  // a program that ends without reading its input must not end us
  Pipe in, out, err;
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, in.ends[0], 0);
  posix_spawn_file_actions_adddup2(&actions, out.ends[1], 1);
  posix_spawn_file_actions_adddup2(&actions, err.ends[1], 2);
  posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
  std::vector<std::string> words{spawn.program};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  pid_t child = -1;
  EXPECT_EQ(posix_spawn(&child, spawn.program.c_str(), &actions, nullptr, argv.data(), environ), 0);
  posix_spawn_file_actions_destroy(&actions);
  for (const int end : {in.ends[0], out.ends[1], err.ends[1]}) close(end);

  Outcome outcome;
  std::thread reads_out([&] { outcome.out = drain(out.ends[0]); });
  std::thread reads_err([&] { outcome.err = drain(err.ends[0]); });
  feed(in.ends[1], spawn.input);
  if (!spawn.hold_input_open) close(in.ends[1]);
  if (spawn.signal_after_ms >= 0) {
    std::this_thread::sleep_for(std::chrono::milliseconds(spawn.signal_after_ms));
    kill(child, SIGINT);
  }
  int state = 0;
  waitpid(child, &state, 0);
  reads_out.join();
  reads_err.join();
  if (spawn.hold_input_open) close(in.ends[1]);
  outcome.status = WIFEXITED(state) ? WEXITSTATUS(state) : 128 + WTERMSIG(state);
  return outcome;
}

void ProgramTest::SetUp() {
  std::string pattern = (std::filesystem::temp_directory_path() / "evenmesh-test-XXXXXX").string();
  ASSERT_NE(mkdtemp(pattern.data()), nullptr);
  folder = pattern;
}

void ProgramTest::TearDown() {
  std::error_code ignored;
  std::filesystem::permissions(folder, std::filesystem::perms::owner_all, ignored);
  std::filesystem::remove_all(folder, ignored);
}

void ProgramTest::write(const std::string& name, const std::string& bytes) const {
  std::ofstream(folder / name, std::ios::binary) << bytes;
}

std::string ProgramTest::read(const std::string& name) const {
  std::ostringstream bytes;
  bytes << std::ifstream(folder / name, std::ios::binary).rdbuf();
  return bytes.str();
}

std::vector<std::string> ProgramTest::names() const {
  std::vector<std::string> found;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) found.push_back(entry.path().filename());
  std::sort(found.begin(), found.end());
  return found;
}

std::string ProgramTest::info(const std::string& name) const {
  const Outcome outcome = run({"info", name, "--json"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  return outcome.out;
}

}  // namespace evenmesh::test
