// SPDX-License-Identifier: BSD-3-Clause
#pragma once
// The program as its users meet it: a child process in a folder of its own.
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace program {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

inline std::string read(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// A fresh folder that goes away with its owner.
class Folder {
 public:
  Folder() {
    std::string name = (fs::temp_directory_path() / "grainlaw_test_XXXXXX").string();
    if (!mkdtemp(name.data())) throw std::runtime_error("no temporary folder");
    path = name;
  }
  ~Folder() {
    std::error_code none;
    fs::remove_all(path, none);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  fs::path operator/(const fs::path& name) const { return path / name; }
  void write(const fs::path& name, const std::string& text) const {
    fs::create_directories((path / name).parent_path());
    std::ofstream(path / name, std::ios::binary) << text;
  }
  /// Everything in it, by relative path.
  std::set<std::string> content(const fs::path& under = ".") const {
    std::set<std::string> names;
    for (const auto& entry : fs::recursive_directory_iterator(path / under))
      names.insert(fs::relative(entry.path(), path / under).string());
    return names;
  }

  fs::path path;
};

struct Outcome {
  int code;
  std::string out, err;
};

/// One run of the program; standard output and error go to files without a name.
class Child {
 public:
  Child(const fs::path& folder, Words words, const std::string& search_path = "") {
    words.insert(words.begin(), "grainlaw");
    std::vector<char*> arguments, environment;
    for (auto& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    std::string path = "PATH=" + search_path;
    for (char** entry = environ; *entry != nullptr; ++entry) {
      const std::string name = *entry;
      if (!name.starts_with("GRAINLAW_DATA=") && (search_path.empty() || !name.starts_with("PATH=")))
        environment.push_back(*entry);
    }
    if (!search_path.empty()) environment.push_back(path.data());
    environment.push_back(nullptr);

    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
    posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, fileno(out), 1);
    posix_spawn_file_actions_adddup2(&actions, fileno(err), 2);
    const int failed = posix_spawn(&id, GRAINLAW_PROGRAM, &actions, nullptr, arguments.data(), environment.data());
    posix_spawn_file_actions_destroy(&actions);
    if (failed != 0) throw std::runtime_error("the program cannot be started");
  }
  ~Child() {
    if (id > 0) kill(id, SIGKILL), waitpid(id, nullptr, 0);
    std::fclose(out);
    std::fclose(err);
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  void interrupt() const { kill(id, SIGINT); }
  Outcome wait() {
    int status = 0;
    waitpid(id, &status, 0);
    id = 0;
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status), text(out), text(err)};
  }

 private:
  static std::string text(std::FILE* file) {
    std::rewind(file);
    std::string all;
    for (int c; (c = std::fgetc(file)) != EOF;) all += char(c);
    return all;
  }
  std::FILE* out = std::tmpfile();
  std::FILE* err = std::tmpfile();
  pid_t id = 0;
};

inline Outcome grainlaw(const Folder& folder, Words words, const std::string& search_path = "") {
  return Child(folder.path, std::move(words), search_path).wait();
}

/// A text with its one occurrence of a part replaced.
inline std::string edited(std::string text, const std::string& from, const std::string& to) {
  if (from.empty()) return to;
  const auto at = text.find(from);
  if (at == std::string::npos || text.find(from, at + 1) != std::string::npos)
    throw std::logic_error("'" + from + "' does not stand there exactly once");
  return text.replace(at, from.size(), to);
}

/// A table as the program writes it: comments, names with units, numbers as typed.
struct Table {
  Words comments, names;
  std::vector<Words> rows;

  explicit Table(const fs::path& file) {
    std::ifstream in(file);
    for (std::string line; std::getline(in, line);) {
      if (line.starts_with('#')) {
        comments.push_back(line);
        continue;
      }
      Words cells;
      std::istringstream split(line);
      for (std::string cell; std::getline(split, cell, ',');) cells.push_back(cell);
      names.empty() ? names = cells : rows.emplace_back(cells);
    }
  }
  bool has(const std::string& name) const { return index(name) < names.size(); }
  double at(std::size_t row, const std::string& name) const { return std::stod(rows.at(row).at(index(name))); }
  double last(const std::string& name) const { return at(rows.size() - 1, name); }

 private:
  std::size_t index(const std::string& name) const {
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (names[i] == name) return i;
    }
    return names.size();
  }
};

}  // namespace program
