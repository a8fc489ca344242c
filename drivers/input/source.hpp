#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace grainlaw::input {

/// A file, or the text of one --set, as its author typed it.
struct Source {
  std::string name;
  std::vector<std::string> lines;
};

/// A place in a source, zero based and counted in bytes; without a line it means the source as a whole.
struct Mark {
  std::shared_ptr<const Source> source;
  int line = 0;
  int column = 0;
};

/// Something the author of an input can correct; what() is the complete message with excerpt, caret and help.
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// "file:line:column", one based and counted in characters.
std::string locate(const Mark& at);

/// "file:line:column: severity: what", then the line, a caret and the help.
std::string message(const Mark& at, std::string_view severity, std::string_view what, std::string_view help);

/// Throws the InputError that shows this place.
[[noreturn]] void fail(const Mark& at, std::string_view what, std::string_view help);

/// "did you mean 'x'?" when a known word is near, otherwise "known: a, b, c".
std::string did_you_mean(std::string_view typed, const std::vector<std::string>& known);

/// The known word that was probably meant, or an empty string.
std::string nearest(std::string_view typed, const std::vector<std::string>& known);

/// "a, b, c".
std::string join(const std::vector<std::string>& words);

}  // namespace grainlaw::input
