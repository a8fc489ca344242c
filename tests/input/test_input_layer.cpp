#include <unistd.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "drivers/input/reader.hpp"

using namespace grainlaw::input;

namespace {

/// The message of the InputError that an action throws.
std::string error_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

std::string parse_error(const std::string& text) {
  return error_of([&] { parse_yaml(text, "x.yaml"); });
}

std::string set_error(const std::string& yaml, const std::string& assignment) {
  Node root = parse_yaml(yaml, "x.yaml");
  return error_of([&] { apply_set(root, assignment); });
}

double value_of(const std::string& typed, std::string_view unit) {
  Node root = parse_yaml("k: " + typed, "x.yaml");
  return quantity(*root.find("k"), "k", unit);
}

std::string value_error(const std::string& typed, std::string_view unit) {
  return error_of([&] { value_of(typed, unit); });
}

std::vector<std::string> texts(const Node& list) {
  std::vector<std::string> result;
  for (const Node& item : list.items) result.push_back(item.text);
  return result;
}

using Words = std::vector<std::string>;
using Catch::Matchers::Contains;
using Catch::Matchers::EndsWith;
using Catch::Matchers::StartsWith;

}  // namespace

TEST_CASE("A message shows place, line, caret and help", "[input]") {
  CHECK(parse_error("law:\n  d: 1\n  d: 2\n") ==
        "x.yaml:3:3: error: the key 'd' is given twice\n"
        "    3 |   d: 2\n"
        "      |   ^\n"
        "      = it is already given at x.yaml:2:3; keep one of them");
}

TEST_CASE("The caret stands below the character, whatever stands before it", "[input]") {
  SECTION("a tab counts as one blank") {
    CHECK(parse_error("a:\t\"ok\" b") ==
          "x.yaml:1:9: error: nothing may follow here, the value is complete\n"
          "    1 | a: \"ok\" b\n"
          "      |         ^\n"
          "      = put quotes around the whole text; "
          "a unit stands behind each number, or behind a [list]");
  }
  SECTION("letters of several bytes count once") {
    CHECK_THAT(parse_error("{größe: 1, größe: 2}"), StartsWith("x.yaml:1:12: error: the key 'größe' is given twice\n"
                                                               "    1 | {größe: 1, größe: 2}\n"
                                                               "      |            ^\n"));
  }
  SECTION("a long line is cut around the caret") {
    std::string error = parse_error("{a: \"" + std::string(500, 'x') + "\", a: 2}");
    CHECK_THAT(error, StartsWith("x.yaml:1:509: error"));
    size_t excerpt = error.find("    1 | "), below = error.find("\n      | ", excerpt);
    size_t caret = error.find('^') - below - 1;
    CHECK(error[excerpt + caret] == 'a');
    CHECK(below - excerpt < 120);
  }
  SECTION("control characters never reach the terminal") {
    std::string error = parse_error("a: \x1b[31m");
    CHECK_THAT(error, StartsWith("x.yaml:1:4: error: a control character (code 27)"));
    CHECK(error.find('\x1b') == std::string::npos);
  }
}

TEST_CASE("What the format leaves out of YAML is refused at its place", "[input]") {
  struct Row {
    std::string text, place, phrase;
  };
  auto row = GENERATE(values<Row>({
      {"a: 1\na: 2", "2:1", "it is already given at x.yaml:1:1"},
      {"a: {b: 1, b: 2}", "1:11", "it is already given at x.yaml:1:5"},
      {"- a: 1\n  'a': 2", "2:3", "the key 'a' is given twice"},
      {"x: 1\n<<: {a: 1}", "2:1", "merge keys ('<<') are not supported"},
      {"a: &x 1\nb: *x", "1:4", "anchors ('&name') are not supported"},
      {"a: &x [1]", "1:4", "anchors ('&name') are not supported"},
      {"b: *x", "1:4", "aliases ('*name') are not supported"},
      {"a: !foo 1", "1:4", "tags ('!name') are not supported"},
      {"a: !foo [1]", "1:4", "tags ('!name') are not supported"},
      {"a: !!str 1", "1:4", "tags ('!name') are not supported"},
      {"a: 1\n---\nb: 2", "2:1", "several documents in one file are not supported"},
      {"[a]: b", "1:1", "a key must be a word, not a list"},
      {"? {a: 1}\n: b", "1:3", "a key must be a word, not a map"},
      {"~: 1", "1:1", "a key must be a word"},
      {"a:\n\tb: 1", "2:1", "a tab stands in the indentation"},
      {"a: b: c", "1:5", "a text that contains ': ' needs quotes"},
      {"a: [1, 2\nb: 3", "1:4", "this '[' is never closed"},
      {"a: {b: [1, 2]", "1:4", "this '{' is never closed"},
      {"a: [1, 2}", "1:9", "'}' closes a '[' of line 1"},
      {"b: 1\na: \"x", "2:4", "this quotation mark is never closed"},
      {"a: 'it''s", "1:4", "this quotation mark is never closed"},
      {"a: {x: 1} kPa", "1:11", "a unit stands behind each number"},
      {"a: \"b\" c", "1:8", "the value is complete"},
      {"[1, 2]\n\"foo\"", "2:1", "the value is complete"},
      {"a: @x", "1:4", "a text that starts with this character needs quotes"},
      {"a: \"\\q\"", "1:7", "write '\\\\' for a backslash"},
      {"a:\n    b: 1\n  c: 2", "3:3", "start in the same column"},
      {"a: - b", "1:4", "begin a list on its own line"},
      {"a: 1\nb: \xff", "2:4", "this is not UTF-8 text"},
      {"a: 1\nb: \x04 2", "2:4", "a control character (code 4)"},
  }));
  CAPTURE(row.text);
  CHECK_THAT(parse_error(row.text), StartsWith("x.yaml:" + row.place + ": error: "));
  CHECK_THAT(parse_error(row.text), Contains(row.phrase));
}

TEST_CASE("An input without anything in it is an error that names the file", "[input]") {
  auto text = GENERATE(as<std::string>(), "", "# only a comment\n", "---\n", "~\n", "\xEF\xBB\xBF");
  CHECK_THAT(parse_error(text), StartsWith("x.yaml: error: there is nothing in it"));
}

TEST_CASE("Deep nesting is an error, not a crash", "[input]") {
  auto repeat = [](const std::string& piece, int n) {
    std::string result;
    for (int i = 0; i < n; ++i) result += piece;
    return result;
  };
  std::string phrase = "nested deeper than 64 levels";
  CHECK_THAT(parse_error(repeat("[", 65) + repeat("]", 65)), StartsWith("x.yaml:1:65: error: " + phrase));
  CHECK_THAT(parse_error(repeat("- ", 65) + "1"), StartsWith("x.yaml:1:129: error: " + phrase));
  CHECK_THAT(parse_error(repeat("[", 100000) + repeat("]", 100000)), Contains(phrase));
  CHECK(parse_error(repeat("[", 64) + repeat("]", 64)) == "no error");
}

TEST_CASE("A byte order mark and CRLF move no column", "[input]") {
  CHECK_THAT(parse_error("\xEF\xBB\xBF"
                         "a: 1\r\na: 2\r\n"),
             StartsWith("x.yaml:2:1: error"));
  CHECK_THAT(parse_error("\xEF\xBB\xBF"
                         "{a: 1, a: 2}\r\n"),
             StartsWith("x.yaml:1:8: error"));
  CHECK(parse_yaml("a: x\r\nb: y\r\n", "x").find("a")->text == "x");
}

TEST_CASE("Files that cannot be read are named", "[input]") {
  auto folder = std::filesystem::temp_directory_path() / ("grainlaw_input_" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  auto read_error = [](const std::filesystem::path& file) { return error_of([&] { read_yaml(file); }); };
  CHECK_THAT(read_error(folder / "none.yaml"),
             StartsWith((folder / "none.yaml").string() + ": error: there is no such file"));
  CHECK_THAT(read_error(folder), StartsWith(folder.string() + ": error: this is a directory"));
  std::ofstream(folder / "one.yaml") << "a: 1\na: 2\n";
  CHECK_THAT(read_error(folder / "one.yaml"), StartsWith((folder / "one.yaml").string() + ":2:1: error"));
  std::filesystem::remove_all(folder);
}

TEST_CASE("Values are kept as typed", "[input]") {
  Node root = parse_yaml("a: 0.890\nb: 'x'\nc:\nd: [1, {e: true}]\nf: |\n  text\n", "x.yaml");
  CHECK(root.find("a")->text == "0.890");
  CHECK_FALSE(root.find("a")->quoted);
  CHECK(root.find("b")->quoted);
  CHECK(root.find("c")->is_null());
  CHECK(root.find("c")->mark.line == 2);
  CHECK(root.find("c")->mark.column == 0);
  CHECK(root.find("d")->items[1].find("e")->text == "true");
  CHECK(root.find("f")->text == "text\n");
  CHECK(root.find("g") == nullptr);
  Node flow = parse_yaml("{a: , b: ~}", "x.yaml");
  CHECK(locate(flow.find("a")->mark) == "x.yaml:1:2");
  CHECK(locate(flow.find("b")->mark) == "x.yaml:1:10");
}

TEST_CASE("A unit behind a list belongs to every number in it", "[input]") {
  SECTION("lists, matrices, maps and several lines") {
    Node root = parse_yaml(
        "L: [[0.3, -0.2], [0.4, -0.5]] 1/s\n"
        "p: [50, 100 Pa] kPa   # a comment\n"
        "m: {q: [1, 2] %, r: [3], 's':[4]mm}\n"
        "n:\n"
        "- [5,\n"
        "   6] Pa s\n"
        "- - [7] kg/m^3\n"
        "  - k: [[8] m, [9]] mm\n",
        "x.yaml");
    CHECK(texts(root.find("L")->items[1]) == Words{"0.4 1/s", "-0.5 1/s"});
    CHECK(texts(*root.find("p")) == Words{"50 kPa", "100 Pa"});
    CHECK(texts(*root.find("m")->find("q")) == Words{"1 %", "2 %"});
    CHECK(texts(*root.find("m")->find("r")) == Words{"3"});
    CHECK(texts(*root.find("m")->find("s")) == Words{"4 mm"});
    CHECK(texts(root.find("n")->items[0]) == Words{"5 Pa s", "6 Pa s"});
    CHECK(texts(root.find("n")->items[1].items[0]) == Words{"7 kg/m^3"});
    CHECK(texts(root.find("n")->items[1].items[1].find("k")->items[0]) == Words{"8 m"});
    CHECK(texts(root.find("n")->items[1].items[1].find("k")->items[1]) == Words{"9 mm"});
  }
  SECTION("text that only looks like it stays as it is") {
    Node root = parse_yaml(
        "a: see [1, 2] kPa\n"
        "b: \"[1, 2] kPa\"\n"
        "c: |\n  [1, 2] kPa\n\n  [3] kPa\n"
        "d: 'it''s [1] kPa'\n"
        "e: some\n  [1] kPa\n"
        "# [1] kPa\n"
        "f: {g: it's, h: [1] kPa}\n"
        "i: [over two\n  'lines, 1]\n",
        "x.yaml");
    CHECK(root.find("a")->text == "see [1, 2] kPa");
    CHECK(root.find("b")->text == "[1, 2] kPa");
    CHECK(root.find("c")->text == "[1, 2] kPa\n\n[3] kPa\n");
    CHECK(root.find("d")->text == "it's [1] kPa");
    CHECK(root.find("e")->text == "some [1] kPa");
    CHECK(texts(*root.find("f")->find("h")) == Words{"1 kPa"});
    CHECK(texts(*root.find("i")) == Words{"over two 'lines", "1"});
  }
  SECTION("no column moves") {
    CHECK_THAT(parse_error("{a: [1] kPa, a: [2] kPa}"), StartsWith("x.yaml:1:14: error: the key 'a'"));
    CHECK_THAT(parse_error("{a: [1] kPa, a: [2] kPa}"), Contains("    1 | {a: [1] kPa, a: [2] kPa}\n"));
  }
  SECTION("a unit that applies to nothing is an error") {
    CHECK_THAT(parse_error("a: [x, 1] kPa"), StartsWith("x.yaml:1:5: error: 'x' is not a number"));
    CHECK_THAT(parse_error("a: [{b: 1}] kPa"), StartsWith("x.yaml:1:5: error: a map is not a number"));
    CHECK_THAT(parse_error("a: [] kPa"), StartsWith("x.yaml:1:7: error: the list before this unit is empty"));
    CHECK_THAT(parse_error("a: [1] 2"), StartsWith("x.yaml:1:8: error: nothing may follow here"));
  }
  SECTION("an unknown unit is reported at the number") {
    Node root = parse_yaml("p: [50, 100] kpa", "x.yaml");
    CHECK_THAT(error_of([&] { quantity(root.find("p")->items[1], "p", "Pa"); }), StartsWith("x.yaml:1:9: error"));
  }
}

TEST_CASE("--set replaces values and makes missing maps", "[input]") {
  Node root = parse_yaml("test: {p: 1 Pa}\nexpect:\n- {value: 1}\n- {value: 2}\nempty:\n", "x.yaml");
  apply_set(root, "test.p=50 kPa");
  apply_set(root, "test.initial.stress={xx: -1 Pa}");
  apply_set(root, "expect.1.value=[1, 2] kPa");
  apply_set(root, "empty.key = x");
  apply_set(root, "title=Hello, world = a");
  CHECK(root.find("test")->find("p")->text == "50 kPa");
  CHECK(root.find("test")->find("initial")->find("stress")->find("xx")->text == "-1 Pa");
  CHECK(texts(*root.find("expect")->items[1].find("value")) == Words{"1 kPa", "2 kPa"});
  CHECK(root.find("expect")->items[0].find("value")->text == "1");
  CHECK(root.find("empty")->find("key")->text == "x");
  CHECK(root.find("title")->text == "Hello, world = a");
}

TEST_CASE("Errors in a --set point into what was typed", "[input]") {
  SECTION("a bad value") {
    Node root = parse_yaml("test: {}\n", "x.yaml");
    apply_set(root, "test.p=50 kpa");
    CHECK(error_of([&] { quantity(*root.find("test")->find("p"), "test.p", "Pa"); }) ==
          "--set:1:8: error: test.p = '50 kpa': no unit is called 'kpa', expected a pressure [Pa]\n"
          "    1 | test.p=50 kpa\n"
          "      |        ^\n"
          "      = did you mean 'kPa'?");
  }
  SECTION("an unknown key") {
    Node root = parse_yaml("a: 1\n", "x.yaml");
    apply_set(root, "b=1");
    Reader reader(root, "");
    reader.known({"a"});
    CHECK_THAT(error_of([&] { reader.finish(); }), StartsWith("--set:1:1: error: unknown key 'b'"));
  }
  SECTION("malformed") {
    struct Row {
      std::string assignment, start;
    };
    auto row = GENERATE(values<Row>({
        {"b", "--set:1:1: error: there is no '=' in it"},
        {"b=", "--set:1:3: error: there is no value behind '='"},
        {"=1", "--set:1:1: error: a key is missing here"},
        {"b..c=1", "--set:1:3: error: a key is missing here"},
        {"b.=1", "--set:1:3: error: a key is missing here"},
        {"b.c=1", "--set:1:3: error: 'b' is '3', so it has no 'c'"},
        {"a.2=1", "--set:1:3: error: the list 'a' has no entry '2'"},
        {"a.x=1", "--set:1:3: error: the list 'a' has no entry 'x'"},
        {"q=a: b", "--set:1:3: error: a map or a list needs its brackets here"},
        {"q=- 1", "--set:1:3: error: a map or a list needs its brackets here"},
        {"q=[1", "--set:1:3: error: this '[' is never closed"},
        {"q={x: 1, x: 2}", "--set:1:10: error: the key 'x' is given twice"},
        {"q=\"a b\" c", "--set:1:9: error: nothing may follow here"},
        {"q=*x", "--set:1:3: error: aliases"},
        {"q=1\nr=2", "--set:1:4: error: a control character (code 10)"},
    }));
    CAPTURE(row.assignment);
    CHECK_THAT(set_error("a: [1, 2]\nb: 3\n", row.assignment), StartsWith(row.start));
  }
}

TEST_CASE("What is written parses back to the same tree", "[input]") {
  Node root = parse_yaml(
      "title: 'a: b # c'\n"
      "empty: ''\nnothing:\nword: 'null'\ntilde: '~'\ntrailing: 'x '\ncolon: 'a:'\ncomma: a, b\n"
      "quotes: \"it's \\\"so\\\" \\\\ \\n\\t\\x01 é\"\nminus: '-'\nbang: '!x'\ndots: '...'\nnumber: 1e-3\n"
      "'key: odd': 1\n"
      "L: [[0.3, -0.2, 1.1], [0.4, -0.5, 0.6]] 1/s\n"
      "none: []\nvoid: {}\n"
      "list:\n- {a: 1, b: [1, 2]}\n- a: {b: {c: {d: 1}}}\n- - [x]\n  - y\n- ~\n"
      "long: [" +
          std::string(60, 'a') + ", " + std::string(60, 'b') + "]\n",
      "x.yaml");
  std::string written = to_yaml(root);
  CAPTURE(written);
  CHECK(same_tree(root, parse_yaml(written, "y.yaml")));
  CHECK(to_yaml(parse_yaml(written, "y.yaml")) == written);
  CHECK_THAT(written, Contains("L: [[0.3 1/s, -0.2 1/s, 1.1 1/s], [0.4 1/s, -0.5 1/s, 0.6 1/s]]\n"));
  CHECK_THAT(written, Contains("number: 1e-3\n"));
  CHECK_THAT(written, Contains("  - {a: 1, b: [1, 2]}\n"));
  Node other = root;
  other.entries[0].value.text = "else";
  CHECK_FALSE(same_tree(root, other));
}

TEST_CASE("A text that YAML would read otherwise is written in quotes", "[input]") {
  auto text = GENERATE(as<std::string>(), "null", "~", "", "...", "-", "- a", "a: b", "a:", "a #b", "#a", "[a", "a, b",
                       "&a", "*a", "!a", "%a", "@a", "a?", " a", "a ", "a\nb", "'a'", "\"a\"", "--- a", "\x7f", "\\");
  Node root;
  root.kind = Node::Kind::map;
  root.entries.push_back({"key", {}, scalar(text)});
  CAPTURE(text, to_yaml(root));
  CHECK(same_tree(root, parse_yaml(to_yaml(root), "y.yaml")));
  CHECK(same_tree(scalar(text), parse_yaml(to_yaml(scalar(text)), "y.yaml")));
}

TEST_CASE("Units convert to the double nearest to what was typed", "[input]") {
  struct Row {
    std::string typed, unit;
    double si;
  };
  constexpr double pi = std::numbers::pi;
  auto row = GENERATE(values<Row>({
      {"0.5", "-", 0.5},
      {"50 %", "-", 0.5},
      {"3%", "-", 0.03},
      {"100 kPa", "Pa", 1e5},
      {"0.1 MPa", "Pa", 1e5},
      {"1 GPa", "Pa", 1e9},
      {"2 bar", "Pa", 2e5},
      {"3 hPa", "Pa", 300},
      {"3 mbar", "Pa", 300},
      {"4 N/m^2", "Pa", 4},
      {"4 N/m2", "Pa", 4},
      {"1 psi", "Pa", 6894.757293168361},
      {"0.3 kPa", "Pa", 300},
      {"1.1 kPa", "Pa", 1100},
      {"-0.0018 1/kPa", "1/Pa", -1.8e-6},
      {"7 1/MPa", "1/Pa", 7e-6},
      {"7 1/Pa", "1/Pa", 7},
      {"3 ms", "s", 0.003},
      {"3 us", "s", 3e-6},
      {"1.5 min", "s", 90},
      {"2 h", "s", 7200},
      {"10 1/s", "1/s", 10},
      {"2 1/ms", "1/s", 2000},
      {"6 1/min", "1/s", 0.1},
      {"36 1/h", "1/s", 0.01},
      {"1 %/s", "1/s", 0.01},
      {"6 %/min", "1/s", 1e-3},
      {"36 %/h", "1/s", 1e-4},
      {"50 Hz", "1/s", 50},
      {"180 deg", "rad", pi},
      {"1.5 rad", "rad", 1.5},
      {"60 rpm", "rad/s", 2 * pi},
      {"180 deg/s", "rad/s", pi},
      {"4 1/s", "rad/s", 4},
      {"4 rad/s", "rad/s", 4},
      {"0.53 mm", "m", 0.53e-3},
      {"3 cm", "m", 0.03},
      {"53 um", "m", 53e-6},
      {"53 µm", "m", 53e-6},
      {"2 km", "m", 2000},
      {"7 mm/s", "m/s", 0.007},
      {"7 cm/s", "m/s", 0.07},
      {"9.81 m/s^2", "m/s^2", 9.81},
      {"2650 kg/m3", "kg/m^3", 2650},
      {"2.65 g/cm^3", "kg/m^3", 2650},
      {"2.65 t/m³", "kg/m^3", 2650},
      {"0.2 kg/m", "kg/m", 0.2},
      {"3 g/m", "kg/m", 0.003},
      {"0.2 Pa s^2", "kg/m", 0.2},
      {"0.2 Pa*s^2", "kg/m", 0.2},
      {"1 mPa s", "Pa s", 0.001},
      {"1 kPa*s", "Pa s", 1000},
      {"1 Pa·s", "Pa s", 1},
      {"2 kg", "kg", 2},
      {"5 kN", "N", 5000},
      {"20 kN/m^3", "N/m^3", 2e4},
      {"3 J/kg", "J/kg", 3},
      {"3 m^2/s^2", "J/kg", 3},
      {"100kPa", "Pa", 1e5},
      {"100   kPa", "Pa", 1e5},
      {"5 kg / m ^ 3", "kg/m^3", 5},
      {"100\u00A0kPa", "Pa", 1e5},
      {"\" 5 Pa \"", "Pa", 5},
      {"10   1/s", "1/s", 10},
      {"+5 Pa", "Pa", 5},
      {".5 Pa", "Pa", 0.5},
      {"5. Pa", "Pa", 5},
      {"1E-3 Pa", "Pa", 1e-3},
      {"1e+5 Pa", "Pa", 1e5},
      {"010 Pa", "Pa", 10},
      {"0 Pa", "Pa", 0},
      {"0e999 Pa", "Pa", 0},
      {"1e-310 Pa", "Pa", 1e-310},
      {"1e306 kPa", "Pa", std::numeric_limits<double>::infinity()},
  }));
  CAPTURE(row.typed, row.unit);
  if (std::isinf(row.si)) {
    CHECK_THAT(value_error(row.typed, row.unit), Contains("too large for a double"));
  } else {
    CHECK(value_of(row.typed, row.unit) == row.si);
  }
}

TEST_CASE("What is not a number with its unit says why", "[input]") {
  struct Row {
    std::string typed, unit, phrase;
  };
  auto row = GENERATE(values<Row>({
      {"100", "Pa", "k = '100' has no unit, expected a pressure [Pa]"},
      {"100", "Pa", "for example '100 kPa'; accepted: Pa, hPa, kPa, MPa"},
      {"0", "Pa", "k = '0' has no unit"},
      {"5 mm", "Pa", "k = '5 mm' is a length, expected a pressure [Pa]"},
      {"5 Pa s", "Pa", "is a viscosity, expected a pressure [Pa]"},
      {"5 Pa", "m", "is a pressure, expected a length [m]"},
      {"3 Hz", "rad/s", "is a rate, expected an angular velocity [rad/s]"},
      {"2 rad/s", "1/s", "is an angular velocity, expected a rate [1/s]"},
      {"5 kPa", "-", "is a pressure, expected a plain number"},
      {"5 kPa", "-", "remove the unit 'kPa'"},
      {"100 kpa", "Pa", "did you mean 'kPa'?"},
      {"100 kPaa", "Pa", "did you mean 'kPa'?"},
      {"5 furlong", "Pa", "expected one of: Pa, hPa"},
      {"1.5abc", "-", "k = '1.5abc' is not a number"},
      {"1.5abc", "Pa", "no unit is called 'abc'"},
      {"1.2.3 Pa", "Pa", "is not a number"},
      {"--5 Pa", "Pa", "is not a number"},
      {"e5 Pa", "Pa", "is not a number"},
      {". Pa", "Pa", "is not a number"},
      {"2*3", "-", "is not a number"},
      {"nan", "Pa", "the number must be finite"},
      {".nan", "-", "the number must be finite"},
      {"inf Pa", "Pa", "the number must be finite"},
      {"-.inf", "-", "the number must be finite"},
      {"0x10 Pa", "Pa", "only decimal numbers are understood"},
      {"0o17", "-", "only decimal numbers are understood"},
      {"1_000", "-", "digits are not grouped"},
      {"1_000 Pa", "Pa", "digits are not grouped"},
      {"1,000 Pa", "Pa", "digits are not grouped"},
      {"0,5", "-", "the decimal sign is a point"},
      {"1 000 Pa", "Pa", "a blank stands inside the number"},
      {"−5 Pa", "Pa", "the minus sign is a typographic one"},
      {"1e999", "-", "too large for a double"},
      {"1e99999999999999999999", "-", "too large for a double"},
      {"1e-400 Pa", "Pa", "too small for a double"},
      {"-1e-99999999999999999999", "-", "too small for a double"},
      {"~", "Pa", "k is empty, expected a pressure [Pa]"},
      {"[1 Pa]", "Pa", "k is a list, expected a pressure [Pa]"},
      {"{a: 1}", "-", "k is a map, expected a plain number"},
      {"''", "-", "k = '' is not a number"},
  }));
  CAPTURE(row.typed, row.unit);
  CHECK_THAT(value_error(row.typed, row.unit), StartsWith("x.yaml:1:4: error: k "));
  CHECK_THAT(value_error(row.typed, row.unit), Contains(row.phrase));
}

TEST_CASE("Separate units convert as units behind numbers do", "[input]") {
  CHECK(to_si(3.0, "%", "-") == 0.03);
  CHECK(to_si(3.0, "percent", "-") == 0.03);
  CHECK(to_si(3.0, "", "-") == 3.0);
  CHECK(to_si(100.0, "kPa", "Pa") == 1e5);
  CHECK(to_si(100.0, "kPa", "m") == std::nullopt);
  CHECK(to_si(100.0, "", "Pa") == std::nullopt);
  CHECK(unit_typed(scalar("5 kPa")) == "kPa");
  CHECK(unit_typed(scalar("5")).empty());
  CHECK(unit_typed(scalar("word")).empty());
}

TEST_CASE("A suggestion is near or absent", "[input]") {
  Words known{"mu_s", "mu_2", "pressure", "kind"};
  CHECK(did_you_mean("mu2", known) == "did you mean 'mu_2'?");
  CHECK(did_you_mean("Pressure", known) == "did you mean 'pressure'?");
  CHECK(did_you_mean("rpessure", known) == "did you mean 'pressure'?");
  CHECK(did_you_mean("presre", known) == "did you mean 'pressure'?");
  CHECK(did_you_mean("knid", known) == "did you mean 'kind'?");
  CHECK(did_you_mean("x", known) == "known: mu_s, mu_2, pressure, kind");
  CHECK(did_you_mean("duration", known) == "known: mu_s, mu_2, pressure, kind");
}

TEST_CASE("A reader hands out what it is asked for", "[input]") {
  Node root = parse_yaml(
      "n: 3\np: 5 kPa\nps: [1, 2] kPa\none: 7 Pa\nw: fast\nt: some text\nf: true\n"
      "m: {x: 1}\nl: [a, b]\nms:\n- {y: 1}\n- {y: 2}\n",
      "x.yaml");
  Reader reader(root, "");
  CHECK(reader.integer("n") == 3);
  CHECK(reader.integer_or("absent", 4) == 4);
  CHECK(reader.number("p", "Pa", positive) == 5000.0);
  CHECK(reader.number_or("absent", "Pa", 2.5) == 2.5);
  CHECK_FALSE(reader.maybe_number("absent", "Pa"));
  CHECK(reader.numbers("ps", "Pa") == std::vector<double>{1000.0, 2000.0});
  CHECK(reader.numbers("one", "Pa") == std::vector<double>{7.0});
  CHECK(reader.word("w", {"slow", "fast"}) == "fast");
  CHECK(reader.word_or("absent", {"slow"}, "slow") == "slow");
  CHECK(reader.text("t") == "some text");
  CHECK(reader.text_or("absent", "none") == "none");
  CHECK(reader.flag_or("f", false));
  CHECK_FALSE(reader.flag_or("absent", false));
  CHECK(reader.map("m").number("x", "-") == 1.0);
  CHECK_FALSE(reader.maybe_map("absent"));
  CHECK(reader.list("l").size() == 2);
  CHECK(reader.list("absent").empty());
  auto maps = reader.maps("ms");
  REQUIRE(maps.size() == 2);
  CHECK(maps[1].path("y") == "ms.1.y");
  CHECK(maps[1].number("y", "-") == 2.0);
  reader.finish();
  CHECK_THROWS_AS(maps[0].finish(), InputError);
}

TEST_CASE("A reader names what does not fit", "[input]") {
  struct Row {
    std::string place, phrase;
    std::function<void(Reader&)> action;
  };
  auto row = GENERATE(values<Row>({
      {"2:3", "'test.shear_rate' is missing", [](Reader& r) { r.number("shear_rate", "1/s"); }},
      {"2:3", "for example 'shear_rate: 0.01 1/s'", [](Reader& r) { r.number("shear_rate", "1/s"); }},
      {"2:3", "is 'presure' at x.yaml:2:3 a misspelling of it?", [](Reader& r) { r.number("pressure", "Pa"); }},
      {"3:9", "test.kind = 'simple_shaer' is not a known choice",
       [](Reader& r) {
         r.word("kind", {"triaxial", "simple_shear"});
       }},
      {"3:9", "did you mean 'simple_shear'?",
       [](Reader& r) {
         r.word("kind", {"triaxial", "simple_shear"});
       }},
      {"4:3", "test.hold is empty, expected a word", [](Reader& r) { r.word("hold", {"volume"}); }},
      {"4:3", "test.hold is empty, expected a plain number", [](Reader& r) { r.number("hold", "-"); }},
      {"4:3", "test.hold is empty, expected a text", [](Reader& r) { r.text_or("hold", ""); }},
      {"4:3", "test.hold is empty, expected a map with keys", [](Reader& r) { r.map("hold"); }},
      {"4:3", "test.hold is empty, expected a list", [](Reader& r) { r.list("hold"); }},
      {"5:9", "test.flag is 'yes', expected true or false", [](Reader& r) { r.flag_or("flag", false); }},
      {"6:9", "test.list is a list, expected a map with keys", [](Reader& r) { r.maybe_map("list"); }},
      {"6:9", "test.list is a list, expected a plain number", [](Reader& r) { r.number("list", "-"); }},
      {"6:9", "test.list is a list, expected a word", [](Reader& r) { r.word_or("list", {"a"}, "a"); }},
      {"6:10", "test.list.0 = '-1' is outside its range", [](Reader& r) { r.numbers("list", "-", positive); }},
      {"6:10", "test.list.0 is '-1', expected a map with keys", [](Reader& r) { r.maps("list"); }},
      {"5:9", "test.flag is 'yes', expected a list", [](Reader& r) { r.list("flag"); }},
      {"7:9", "test.rate = '-5 %/s' is outside its range", [](Reader& r) { r.number("rate", "1/s", positive); }},
      {"7:9", "expected a rate [1/s] above 0 1/s", [](Reader& r) { r.number("rate", "1/s", positive); }},
      {"7:9", "at least 0 1/s and below 2 1/s",
       [](Reader& r) { r.number_or("rate", "1/s", 1.0, {.low = 0.0, .high = 2.0, .high_open = true}); }},
      {"8:11", "test.cycles = '2.5' is not a whole number", [](Reader& r) { r.integer("cycles"); }},
      {"8:3", "'test.cycles' would change nothing here", [](Reader& r) { r.inert("cycles", "there is no load"); }},
      {"8:3", "= there is no load", [](Reader& r) { r.inert("cycles", "there is no load"); }},
      {"2:3", "unknown key 'test.presure'", [](Reader& r) { r.finish(); }},
      {"2:3", "did you mean 'pressure'?", [](Reader& r) { r.find("pressure"), r.finish(); }},
      {"3:3", "known: presure, a, b",
       [](Reader& r) {
         r.find("presure");
         r.known({"a", "b"});
         r.finish();
       }},
  }));
  Node root = parse_yaml(
      "test:\n  presure: 1 Pa\n  kind: simple_shaer\n  hold:\n  flag: yes\n  list: [-1]\n  rate: -5 %/s\n"
      "  cycles: 2.5\n",
      "x.yaml");
  Reader reader(*root.find("test"), "test");
  CAPTURE(row.phrase);
  std::string error = error_of([&] { row.action(reader); });
  CHECK_THAT(error, StartsWith("x.yaml:" + row.place + ": error: "));
  CHECK_THAT(error, Contains(row.phrase));
}

TEST_CASE("A range bound is inside unless it is open", "[input]") {
  Node root = parse_yaml("a: 0\nb: 1\n", "x.yaml");
  Reader reader(root, "");
  CHECK(reader.number("a", "-", not_negative) == 0.0);
  CHECK_THROWS_AS(reader.number("a", "-", positive), InputError);
  CHECK(reader.number("b", "-", {.high = 1.0}) == 1.0);
  CHECK_THROWS_AS(reader.number("b", "-", {.high = 1.0, .high_open = true}), InputError);
}

TEST_CASE("A key without a blank behind its colon is explained", "[input]") {
  Node root = parse_yaml("{a:1}", "x.yaml");
  Reader reader(root, "");
  reader.find("a");
  CHECK_THAT(error_of([&] { reader.finish(); }), EndsWith("a blank is missing behind ':'"));
}

TEST_CASE("An input that is no map is refused", "[input]") {
  Node root = parse_yaml("just text", "x.yaml");
  CHECK_THAT(error_of([&] { Reader(root, ""); }),
             StartsWith("x.yaml:1:1: error: the input is 'just text', expected a map with keys"));
}

TEST_CASE("A key that is absent is not inert", "[input]") {
  Node root = parse_yaml("{}", "x.yaml");
  Reader reader(root, "");
  CHECK_NOTHROW(reader.inert("a", "why"));
  CHECK_NOTHROW(reader.finish());
}
