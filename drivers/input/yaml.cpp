#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <iterator>
#include <sstream>
#include <system_error>

#include "list_units.hpp"
#include "node.hpp"
#include "units.hpp"

namespace grainlaw::input {
namespace {

constexpr size_t max_depth = 64;

enum class Style { block_or_flow, flow };

/// Builds the tree from yaml-cpp's events and refuses what the format leaves out of YAML.
class Builder : public YAML::EventHandler {
 public:
  Builder(std::shared_ptr<const Source> from, ListUnits behind_lists, Style allowed)
      : source(std::move(from)), units(std::move(behind_lists)), style(allowed) {}

  Node root;
  bool found = false;

  Mark place(const YAML::Mark& mark) const {
    auto last = static_cast<int>(source->lines.size()) - 1;
    if (mark.line < 0 || last < 0) return {source, -1, -1};
    if (mark.line <= last) return {source, mark.line, mark.column};
    while (last > 0 && source->lines[static_cast<size_t>(last)].empty()) --last;
    return {source, last, static_cast<int>(source->lines[static_cast<size_t>(last)].size())};
  }

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (!std::exchange(in_document, true)) return;
    Mark at = place(mark);
    if (at.line >= 0 && rest_of_line(at).starts_with("---")) {
      fail(at, "several documents in one file are not supported", "write one file per document, without '---'");
    }
    fail(at, root.is_null() ? "this is not valid YAML" : "nothing may follow here, the value is complete",
         "check the indentation, the quotes and the brackets");
  }
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    refuse_anchor(mark, anchor);
    Node node = begin(Node::Kind::null, mark);
    // yaml-cpp marks an absent value where the next token stands, which may be lines below.
    bool typed = rest_of_line(node.mark).starts_with("~") || rest_of_line(node.mark).starts_with("null") ||
                 rest_of_line(node.mark).starts_with("N");
    if (!expects_key() && !open.empty() && open.back().node.is_map()) {
      const Mark& key = open.back().node.entries.back().key_mark;
      if (!typed || key.line != node.mark.line) node.mark = key;
    }
    add(std::move(node));
  }

  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override { refuse_alias(mark); }

  [[noreturn]] void refuse_alias(const YAML::Mark& mark) const {
    fail(place(mark), "aliases ('*name') are not supported",
         "write the value out again; a text that starts with '*' needs quotes");
  }

  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    refuse_tag(mark, tag);
    refuse_anchor(mark, anchor);
    Node node = begin(Node::Kind::scalar, mark);
    node.text = value;
    node.quoted = tag == "!";
    add(std::move(node));
  }

  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value given) override {
    start(Node::Kind::sequence, mark, tag, anchor, given);
  }
  void OnSequenceEnd() override { end(); }

  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value given) override {
    start(Node::Kind::map, mark, tag, anchor, given);
  }
  void OnMapEnd() override { end(); }

 private:
  struct Open {
    Node node;
    bool has_key = false;
  };

  std::string_view rest_of_line(const Mark& at) const {
    if (at.line < 0) return {};
    std::string_view text = source->lines[static_cast<size_t>(at.line)];
    return text.substr(std::min(static_cast<size_t>(at.column), text.size()));
  }

  bool expects_key() const { return !open.empty() && open.back().node.is_map() && !open.back().has_key; }

  Node begin(Node::Kind kind, const YAML::Mark& mark) const {
    Node node;
    node.kind = kind;
    node.mark = place(mark);
    return node;
  }

  void refuse_anchor(const YAML::Mark& mark, YAML::anchor_t anchor) const {
    if (anchor == YAML::NullAnchor) return;
    fail(place(mark), "anchors ('&name') are not supported",
         "write the value out where it is needed; a text that starts with '&' needs quotes");
  }

  void refuse_tag(const YAML::Mark& mark, const std::string& tag) const {
    if (tag.empty() || tag == "?" || tag == "!") return;
    fail(place(mark), "tags ('!name') are not supported", "remove the tag; a text that starts with '!' needs quotes");
  }

  void start(Node::Kind kind, const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
             YAML::EmitterStyle::value given) {
    refuse_tag(mark, tag);
    refuse_anchor(mark, anchor);
    Node node = begin(kind, mark);
    if (expects_key()) refuse_key(node);
    if (style == Style::flow && given != YAML::EmitterStyle::Flow) {
      fail(node.mark, "a map or a list needs its brackets here",
           "write {key: value} or [a, b]; a text that contains ': ' needs quotes");
    }
    if (open.size() >= max_depth) {
      fail(node.mark, fmt::format("nested deeper than {} levels", max_depth), "flatten the input");
    }
    open.push_back({std::move(node)});
  }

  void end() {
    Node node = std::move(open.back().node);
    open.pop_back();
    auto unit = units.find({node.mark.line, node.mark.column});
    if (node.is_sequence() && unit != units.end()) hand_down(node, unit->second);
    add(std::move(node));
  }

  [[noreturn]] void refuse_key(const Node& node) const {
    fail(node.mark, fmt::format("a key must be a word, not {}", describe(node)), "write 'key: value'");
  }

  void add_key(const Node& node) {
    if (!node.is_scalar() || node.text.empty()) refuse_key(node);
    if (node.text == "<<") {
      fail(node.mark, "merge keys ('<<') are not supported", "write the keys out here");
    }
    for (const Node::Entry& entry : open.back().node.entries) {
      if (entry.key != node.text) continue;
      fail(node.mark, fmt::format("the key '{}' is given twice", node.text),
           fmt::format("it is already given at {}; keep one of them", locate(entry.key_mark)));
    }
    open.back().node.entries.push_back({node.text, node.mark, {}});
    open.back().has_key = true;
  }

  void add(Node node) {
    if (open.empty()) {
      root = std::move(node);
      found = true;
    } else if (open.back().node.is_sequence()) {
      open.back().node.items.push_back(std::move(node));
    } else if (expects_key()) {
      add_key(node);
    } else {
      open.back().node.entries.back().value = std::move(node);
      open.back().has_key = false;
    }
  }

  void hand_down(Node& list, const ListUnit& unit) const {
    if (list.items.empty()) fail(unit.mark, "the list before this unit is empty", "remove the unit or add numbers");
    for (Node& item : list.items) {
      if (item.is_sequence()) {
        hand_down(item, unit);
        continue;
      }
      auto [number, rest] = split_number(item.text);
      if (number.empty() || item.quoted) {
        fail(item.mark, fmt::format("{} is not a number, but a unit stands behind the list", describe(item)),
             fmt::format("remove the unit '{}', or write it behind each number", unit.text));
      }
      if (rest.empty()) item.text = number + " " + unit.text;
    }
  }

  std::shared_ptr<const Source> source;
  ListUnits units;
  Style style;
  std::vector<Open> open;
  bool in_document = false;
};

std::string advice(std::string_view reason) {
  auto says = [&](std::string_view part) { return reason.find(part) != std::string_view::npos; };
  if (says("tab")) return "indent with spaces";
  if (says("block entry")) return "begin a list on its own line, or write [a, b]";
  if (says("map value")) return "check the indentation; a text that contains ': ' needs quotes";
  if (says("end of map")) return "the keys of one map start in the same column, and each ends with ': '";
  if (says("end of seq")) return "the entries of one list start in the same column, each with '- '";
  if (says("flow")) return "separate entries by ',' and close every bracket";
  if (says("unknown token") || says("illegal character")) return "a text that starts with this character needs quotes";
  if (says("escape")) return "write '\\\\' for a backslash, or use single quotes";
  return "check the indentation, the quotes and the brackets around this place";
}

std::vector<std::string> split_lines(const std::string& text) {
  std::vector<std::string> lines{{}};
  for (size_t i = 0; i < text.size(); ++i) {
    bool pair = text[i] == '\r' && i + 1 < text.size() && text[i + 1] == '\n';
    if (pair) continue;
    if (text[i] == '\n' || text[i] == '\r') {
      lines.emplace_back();
    } else {
      lines.back() += text[i];
    }
  }
  if (lines.size() > 1 && lines.back().empty()) lines.pop_back();
  return lines;
}

/// The length of the UTF-8 character that begins here, 0 when none does.
size_t character_length(std::string_view text) {
  auto byte = [&](size_t i) { return static_cast<unsigned>(static_cast<unsigned char>(text[i])); };
  if (byte(0) < 0x80) return 1;
  size_t length = byte(0) >= 0xC2 && byte(0) < 0xE0 ? 2 : byte(0) >= 0xE0 && byte(0) < 0xF0 ? 3 : 4;
  if (byte(0) < 0xC2 || byte(0) > 0xF4 || length > text.size()) return 0;
  for (size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0U) != 0x80U) return 0;
  }
  return length;
}

void check_characters(const std::shared_ptr<const Source>& source) {
  for (size_t i = 0; i < source->lines.size(); ++i) {
    std::string_view line = source->lines[i];
    for (size_t column = 0; column < line.size();) {
      Mark at{source, static_cast<int>(i), static_cast<int>(column)};
      auto byte = static_cast<unsigned char>(line[column]);
      size_t length = character_length(line.substr(column));
      if (length == 0) fail(at, "this is not UTF-8 text", "save the file as UTF-8");
      // yaml-cpp takes the character 4 for the end of the file and drops the rest.
      if ((byte < 0x20 && byte != '\t') || byte == 0x7F) {
        fail(at, fmt::format("a control character (code {}) stands here", byte), "remove it");
      }
      column += length;
    }
  }
}

Node parse(std::vector<std::string> lines, const std::shared_ptr<const Source>& source, Style style) {
  check_characters(source);
  ListUnits units = take_list_units(lines, source);
  std::istringstream stream(fmt::format("{}\n", fmt::join(lines, "\n")));
  Builder builder(source, std::move(units), style);
  try {
    YAML::Parser parser(stream);
    while (parser.HandleNextDocument(builder)) {
    }
  } catch (const YAML::Exception& e) {
    if (e.msg == YAML::ErrorMsg::UNKNOWN_ANCHOR) builder.refuse_alias(e.mark);
    fail(builder.place(e.mark), fmt::format("this is not valid YAML ({})", e.msg), advice(e.msg));
  }
  if (!builder.found || builder.root.is_null()) {
    fail({source, -1, -1}, "there is nothing in it", "write 'key: value' lines");
  }
  return std::move(builder.root);
}

std::string read_file(const std::filesystem::path& file) {
  Mark at{std::make_shared<Source>(Source{file.string(), {}}), -1, -1};
  std::error_code error;
  auto status = std::filesystem::status(file, error);
  if (status.type() == std::filesystem::file_type::not_found) {
    fail(at, "there is no such file", "check the name and the current directory");
  }
  if (std::filesystem::is_directory(status)) fail(at, "this is a directory", "name a file in it");
  std::ifstream stream(file, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(stream), {}};
  if (!stream.is_open() || stream.bad()) fail(at, "the file cannot be read", "check its permissions");
  return text;
}

struct Step {
  std::string key;
  Mark mark;
};

constexpr std::string_view set_help = "write key.path=value, for example --set 'test.initial.pressure=50 kPa'";

/// The keys of "test.initial.pressure" and where each stands.
std::vector<Step> split_path(std::string_view path, const std::shared_ptr<const Source>& source) {
  std::vector<Step> steps;
  for (size_t begin = 0; begin <= path.size();) {
    size_t end = std::min(path.find('.', begin), path.size());
    size_t first = std::min(path.find_first_not_of(' ', begin), end);
    std::string key(path.substr(first, end - first));
    while (key.ends_with(' ')) key.pop_back();
    Mark at{source, 0, static_cast<int>(first)};
    if (key.empty()) fail(at, "a key is missing here", set_help);
    steps.push_back({key, at});
    begin = end + 1;
  }
  return steps;
}

Node& entry_of_list(Node& list, const Step& step, std::string_view path) {
  size_t index = 0;
  const char* end = step.key.data() + step.key.size();
  auto [rest, error] = std::from_chars(step.key.data(), end, index);
  if (error == std::errc{} && rest == end && index < list.items.size()) return list.items[index];
  if (list.items.empty()) fail(step.mark, fmt::format("the list '{}' is empty", path), "set the whole list");
  fail(step.mark, fmt::format("the list '{}' has no entry '{}'", path, step.key),
       fmt::format("its entries are numbered 0 to {}", list.items.size() - 1));
}

Node& child(Node& node, const Step& step, std::string_view path) {
  if (node.is_sequence()) return entry_of_list(node, step, path);
  if (node.is_scalar()) {
    fail(step.mark, fmt::format("'{}' is {}, so it has no '{}'", path, describe(node), step.key),
         fmt::format("set '{}' itself", path));
  }
  if (node.is_null()) {
    node.kind = Node::Kind::map;
    node.mark = step.mark;
  }
  if (Node* known = node.find(step.key)) return *known;
  Node nothing;
  nothing.mark = step.mark;
  return node.entries.emplace_back(Node::Entry{step.key, step.mark, nothing}).value;
}

}  // namespace

Node read_yaml(const std::filesystem::path& file) { return parse_yaml(read_file(file), file.string()); }

Node parse_yaml(std::string text, std::string name) {
  if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
  std::vector<std::string> lines = split_lines(text);
  auto source = std::make_shared<const Source>(Source{std::move(name), lines});
  return parse(std::move(lines), source, Style::block_or_flow);
}

void apply_set(Node& root, const std::string& assignment) {
  auto source = std::make_shared<const Source>(Source{"--set", {assignment}});
  check_characters(source);
  size_t equals = assignment.find('=');
  if (equals == std::string::npos) fail({source, 0, 0}, "there is no '=' in it", set_help);
  std::vector<Step> steps = split_path(std::string_view(assignment).substr(0, equals), source);
  std::string value = assignment.substr(equals + 1);
  if (value.find_first_not_of(" \t") == std::string::npos) {
    fail({source, 0, static_cast<int>(equals) + 1}, "there is no value behind '='", set_help);
  }

  // The key becomes blanks, so that every column of the value stays where it was typed.
  Node parsed = parse({std::string(equals + 1, ' ') + value}, source, Style::flow);
  Node* target = &root;
  std::string path;
  for (const Step& step : steps) {
    target = &child(*target, step, path);
    path += (path.empty() ? "" : ".") + step.key;
  }
  *target = std::move(parsed);
}

}  // namespace grainlaw::input
