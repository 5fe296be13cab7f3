#include "cli/command.h"

#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <iostream>
#include <memory>
#include <stop_token>

#include <fmt/format.h>
#include <unistd.h>

namespace marey::cli {
namespace {

std::stop_source& interruptSource() {
  static std::stop_source source;
  return source;
}

/// The first Ctrl-C asks to stop cleanly; the second ends the program at once.
extern "C" void onInterrupt(int signal) {
  interruptSource().request_stop();
  std::signal(signal, SIG_DFL);
}

std::string clockText(double seconds) {
  const long total = std::lround(seconds);
  if (total >= 3600)
    return fmt::format("{}:{:02}:{:02}", total / 3600, total / 60 % 60, total % 60);
  return fmt::format("{}:{:02}", total / 60, total % 60);
}

/// Draws at most ten times a second on a terminal, every ten seconds elsewhere.
class ProgressLine {
 public:
  explicit ProgressLine(std::string what) : m_what(std::move(what)) {}
  ~ProgressLine() {
    if (m_terminal && m_drawn) std::fputc('\n', stderr);
  }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  void show(double fraction, std::string_view message) {
    const auto now = Clock::now();
    const bool last = fraction >= 1.0;
    const auto gap = m_terminal ? std::chrono::milliseconds(100) : std::chrono::milliseconds(10000);
    if (m_finished || (!last && now - m_shown < gap)) return;
    m_shown = now;
    m_finished = last;
    const double elapsed = std::chrono::duration<double>(now - m_begin).count();
    const double left = fraction > 0.0 ? elapsed * (1.0 - fraction) / fraction : 0.0;
    const std::string text =
        fmt::format("{} {:3.0f} %  {}{}", m_what, 100.0 * fraction, message,
                    last ? "  in " + clockText(elapsed) : "  " + clockText(left) + " left");
    // \r and "erase to the end of the line" redraw in place.
    fmt::print(stderr, "{}{}{}", m_terminal ? "\r" : "", text, m_terminal ? "\033[K" : "\n");
    std::fflush(stderr);
    m_drawn = true;
  }

 private:
  using Clock = std::chrono::steady_clock;
  std::string m_what;
  bool m_terminal = ::isatty(STDERR_FILENO) != 0;
  bool m_drawn = false, m_finished = false;
  Clock::time_point m_begin = Clock::now(), m_shown = Clock::now();
};

}  // namespace

Json finiteOrNull(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

void Context::print(const Json& result, const std::string& text) const {
  if (json)
    std::cout << jsonText(result) << '\n';
  else if (!quiet)
    std::cout << text << (text.ends_with('\n') ? "" : "\n");
  std::cout.flush();
}

Progress Context::progress(const std::string& what) const {
  std::signal(SIGINT, onInterrupt);
  std::signal(SIGTERM, onInterrupt);
  if (quiet) return Progress({}, interruptSource().get_token());
  auto line = std::make_shared<ProgressLine>(what);
  return Progress(
      [line](double fraction, std::string_view message) { line->show(fraction, message); },
      interruptSource().get_token());
}

CLI::App* addCommand(CLI::App& app, Context& context, const std::string& name,
                     const std::string& summary, const std::string& example,
                     std::function<void()> run, Processes processes) {
  CLI::App* command = app.add_subcommand(name, summary);
  command->add_flag("--json", context.json, "Print one JSON object on stdout");
  command->add_flag("--quiet", context.quiet, "Print errors only");
  command->add_option("--seed", context.seed, "Seed of everything random")->capture_default_str();
  command->add_option("--threads", context.threads, "Threads to compute with (0: one per core)")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->footer("Example:\n  " + example);
  command->callback([&context, name, run = std::move(run), processes] {
    context.command = name;
    context.processes = processes;
    context.run = run;
  });
  return command;
}

}  // namespace marey::cli
