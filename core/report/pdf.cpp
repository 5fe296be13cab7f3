#include "report/pdf.h"

#include <array>
#include <cerrno>
#include <chrono>
#include <thread>

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace marey::report {

namespace {
/// Exit status of a finished process, or -1 after the time limit (it is killed then).
int waitFor(pid_t process, double limitS) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(limitS);
  int status = 0;
  while (waitpid(process, &status, WNOHANG) == 0) {
    if (std::chrono::steady_clock::now() > end) {
      kill(process, SIGKILL);
      waitpid(process, &status, 0);
      return -1;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 255;
}
}  // namespace

PdfResult writePdf(const std::filesystem::path& html, const std::filesystem::path& pdf,
                   double limitS, const std::string& program) {
  const std::string from = html.string(), to = pdf.string();
  std::string name = program, quiet = "--quiet";
  std::array<char*, 5> arguments = {name.data(), quiet.data(), const_cast<char*>(from.c_str()),
                                    const_cast<char*>(to.c_str()), nullptr};
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t process = 0;
  const int failed =
      posix_spawnp(&process, program.c_str(), &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  // Some systems report a missing program here, others by exit status 127.
  const int status = failed == 0 ? waitFor(process, limitS) : 127;
  std::error_code ignored;
  if (status == 0 && std::filesystem::file_size(pdf, ignored) > 0 && !ignored) return {true, ""};
  std::filesystem::remove(pdf, ignored);
  if (status == 127) {
    return {
        false,
        fmt::format(
            "No PDF was written: the program {} is not installed (on Debian: apt-get install {}). "
            "report.html prints well from any browser.",
            program, program)};
  }
  if (status == -1)
    return {false, fmt::format("No PDF was written: {} took longer than {:g} s.", program, limitS)};
  return {false, fmt::format("No PDF was written: {} ended with status {}.", program, status)};
}

}  // namespace marey::report
