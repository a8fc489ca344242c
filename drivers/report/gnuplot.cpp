#include "gnuplot.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <fstream>
#include <iterator>
#include <regex>
#include <sstream>

namespace grainlaw::report {
namespace {

using Clock = std::chrono::steady_clock;
constexpr auto time_limit = std::chrono::seconds(30);
constexpr int not_found = 127;
constexpr const char* drawn_mark = "figure drawn";

/// How a program ended: its exit status (128 + n for signal n) and what it printed.
struct Ending {
  int status = 0;
  bool timed_out = false;
  std::string output;
};

/// Starts a program found on PATH and collects what it prints until it ends or the deadline passes.
Ending run(std::vector<std::string> command, Clock::time_point deadline) {
  std::vector<char*> arguments;
  arguments.reserve(command.size() + 1);
  for (std::string& word : command) arguments.push_back(word.data());
  arguments.push_back(nullptr);

  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) return {.status = not_found, .timed_out = false, .output = ""};
  const pid_t child = fork();
  if (child == 0) {
    const int nothing = open("/dev/null", O_RDONLY);
    dup2(nothing, STDIN_FILENO);
    dup2(ends[1], STDOUT_FILENO);
    dup2(ends[1], STDERR_FILENO);
    close(ends[0]);
    close(ends[1]);
    execvp(arguments[0], arguments.data());
    _exit(not_found);
  }
  close(ends[1]);
  Ending ending;
  if (child < 0) {
    close(ends[0]);
    ending.status = not_found;
    return ending;
  }
  for (;;) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
    pollfd waiting{.fd = ends[0], .events = POLLIN, .revents = 0};
    const int ready = left > 0 ? poll(&waiting, 1, static_cast<int>(left)) : 0;
    if (ready < 0 && errno == EINTR) continue;
    if (ready <= 0) {
      ending.timed_out = true;
      kill(child, SIGKILL);
      break;
    }
    std::array<char, 4096> buffer{};
    const ssize_t count = read(ends[0], buffer.data(), buffer.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) break;
    ending.output.append(buffer.data(), static_cast<std::size_t>(count));
  }
  close(ends[0]);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  ending.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return ending;
}

/// One gnuplot run for all: each script in its own folder, followed by a mark that tells how far the run came.
std::vector<std::string> command_for(const std::vector<Figure*>& figures) {
  std::vector<std::string> command{"gnuplot", "-d"};
  for (const Figure* figure : figures) {
    const std::string folder = std::filesystem::absolute(figure->dir).string();
    command.insert(command.end(), {"-e", "cd '" + std::regex_replace(folder, std::regex("'"), "''") + "'",
                                   "plots/" + figure->id + ".gp", "-e", fmt::format("print '{}'", drawn_mark)});
  }
  return command;
}

/// How many figures were finished, and gnuplot's last other line.
std::pair<std::size_t, std::string> read_progress(const std::string& output) {
  std::istringstream lines(output);
  std::size_t finished = 0;
  std::string last;
  for (std::string line; std::getline(lines, line);) {
    line.erase(0, line.find_first_not_of(" \t"));
    if (line == drawn_mark) {
      ++finished;
    } else if (!line.empty()) {
      last = line;
    }
  }
  return {finished, last};
}

/// The picture as it may stand in a page: no prolog, no tooltip, no fixed size, ids that no other figure has.
std::string inline_svg(const Figure& figure, std::size_t place) {
  std::ifstream in(figure.dir / "plots" / (figure.id + ".svg"), std::ios::binary);
  const std::string file{std::istreambuf_iterator<char>(in), {}};
  const auto start = file.find("<svg");
  if (start == std::string::npos || file.find("</svg>") == std::string::npos) return "";
  std::string svg = file.substr(start);

  const auto head_end = svg.find('>');
  std::string head = svg.substr(0, head_end);
  head = std::regex_replace(head, std::regex(R"re(\s(width|height)="[^"]*")re"), "");
  svg.replace(0, head_end, head + " role=\"img\"");
  const auto drop = [&svg](const std::string& open, const std::string& close) {
    const auto first = svg.find(open);
    const auto last = svg.find(close);
    if (first != std::string::npos && last != std::string::npos) svg.erase(first, last + close.size() - first);
  };
  drop("<title>", "</title>");
  drop("<desc>", "</desc>");
  const std::string prefix = fmt::format("f{}-", place);
  svg = std::regex_replace(svg, std::regex(R"re((\sid=["'])([^"']+["']))re"), "$1" + prefix + "$2");
  svg = std::regex_replace(svg, std::regex(R"re((xlink:href=["']#|url\(#))re"), "$1" + prefix);
  return svg;
}

}  // namespace

std::string draw(std::vector<Figure*> figures) {
  std::string message;
  std::erase_if(figures, [](const Figure* figure) { return figure->series.empty(); });
  const auto deadline = Clock::now() + time_limit;
  for (std::size_t place = 1; !figures.empty();) {
    const Ending ending = run(command_for(figures), deadline);
    const auto [printed, said] = read_progress(ending.output);
    const std::size_t finished = std::min(printed, figures.size());
    for (std::size_t i = 0; i < finished; ++i) figures[i]->svg = inline_svg(*figures[i], place++);
    figures.erase(figures.begin(), figures.begin() + static_cast<std::ptrdiff_t>(finished));
    if (figures.empty()) break;

    if (ending.status == not_found || ending.timed_out) {
      message = ending.timed_out ? fmt::format("gnuplot was stopped after {} s", time_limit.count())
                                 : "gnuplot not found: install gnuplot-nox";
      for (Figure* figure : figures) figure->problems.push_back(message);
      break;
    }
    // gnuplot gives up at its first error: name the figure that caused it and go on with those after it.
    const std::string reason = said.empty() ? fmt::format("ended with status {}", ending.status) : said;
    figures.front()->problems.push_back("gnuplot: " + reason);
    if (message.empty()) message = fmt::format("gnuplot could not draw {}: {}", figures.front()->id, reason);
    figures.erase(figures.begin());
  }
  return message;
}

}  // namespace grainlaw::report
