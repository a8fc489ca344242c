// SPDX-License-Identifier: BSD-3-Clause
#include "sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace grainlaw::element {

using input::Node;

namespace {

struct List {
  std::vector<std::size_t> path;  ///< positions of entries or items from the root
  std::string key;
  const Node* node;
  bool names_runs;
};

bool is_sweep(const Node& node) {
  return node.is_sequence() && std::none_of(node.items.begin(), node.items.end(),
                                            [](const Node& n) { return n.is_map() || n.is_sequence(); });
}

void collect_in_maps(const Node& node, const std::string& key, bool names_runs, std::vector<std::size_t>& path,
                     std::vector<List>& lists);

void collect(const Node& node, const std::string& key, bool names_runs, std::vector<std::size_t>& path,
             std::vector<List>& lists) {
  if (node.is_map()) {
    for (std::size_t i = 0; i < node.entries.size(); ++i) {
      path.push_back(i);
      collect(node.entries[i].value, node.entries[i].key, names_runs, path, lists);
      path.pop_back();
    }
  } else if (is_sweep(node)) {
    if (node.items.empty())
      input::fail(node.mark, fmt::format("'{}' is an empty list", key), "give at least one value");
    lists.push_back({path, key, &node, names_runs});
  } else if (node.is_sequence()) {
    collect_in_maps(node, key, names_runs, path, lists);
  }
}

/// The lists inside a list of maps. A list of lists is a matrix, one value.
void collect_in_maps(const Node& node, const std::string& key, bool names_runs, std::vector<std::size_t>& path,
                     std::vector<List>& lists) {
  for (std::size_t i = 0; i < node.items.size(); ++i) {
    if (!node.items[i].is_map()) continue;
    path.push_back(i);
    collect(node.items[i], key, names_runs, path, lists);
    path.pop_back();
  }
}

Node& descend(Node& root, const std::vector<std::size_t>& path) {
  Node* at = &root;
  for (const std::size_t i : path) at = at->is_map() ? &at->entries[i].value : &at->items[i];
  return *at;
}

std::string without_spaces(std::string text) {
  std::erase_if(text, [](char c) { return c == ' ' || c == '\t'; });
  return text;
}

}  // namespace

std::string file_stem(const std::string& run) {
  std::string stem = run;
  std::replace_if(
      stem.begin(), stem.end(), [](char c) { return c == '/' || c == '\\' || static_cast<unsigned char>(c) < 32; },
      '_');
  return stem;
}

std::vector<SingleRun> expand(const Node& file) {
  std::vector<List> lists;
  bool product = false;
  if (file.is_map()) {
    for (std::size_t i = 0; i < file.entries.size(); ++i) {
      const auto& [key, mark, value] = file.entries[i];
      std::vector<std::size_t> path{i};
      if (key == "material" || key == "test" || key == "integrator") collect(value, key, true, path, lists);
      if (key == "compare" || key == "expect") collect_in_maps(value, key, false, path, lists);
      if (key == "sweep") {
        if (!value.is_scalar() || (value.text != "zip" && value.text != "product")) {
          input::fail(value.mark, fmt::format("sweep is {}", input::describe(value)),
                      "expected zip (lists side by side) or product (all combinations)");
        }
        product = value.text == "product";
      }
    }
  }
  std::stable_sort(lists.begin(), lists.end(),
                   [](const List& a, const List& b) { return a.names_runs > b.names_runs; });
  const auto naming =
      std::size_t(std::count_if(lists.begin(), lists.end(), [](const List& l) { return l.names_runs; }));

  std::size_t runs = 1;
  if (product) {
    for (std::size_t i = 0; i < naming; ++i) {
      runs *= lists[i].node->items.size();
      if (runs > 100000)
        input::fail(lists[i].node->mark, "the product of the lists makes more than 100000 runs", "shorten a list");
    }
  } else if (naming > 0) {
    runs = lists[0].node->items.size();
  }
  for (std::size_t i = 0; i < lists.size(); ++i) {
    const std::size_t length = lists[i].node->items.size();
    const bool multiplied = product && i < naming;
    if (multiplied || length == runs) continue;
    if (naming == 0) {
      input::fail(lists[i].node->mark, fmt::format("'{}' is a list of {} but there is one run", lists[i].key, length),
                  fmt::format("lists here follow the runs: give one value, or a list in the test; --set '{}=[]' drops "
                              "all of it",
                              file.entries[lists[i].path[0]].key));
    }
    input::fail(lists[i].node->mark,
                fmt::format("'{}' has {} values but '{}' makes {} runs", lists[i].key, length, lists[0].key, runs),
                fmt::format("lists are taken side by side and must be equally long ('{}' stands at {}); `sweep: "
                            "product` makes all combinations",
                            lists[0].key, input::locate(lists[0].node->mark)));
  }

  std::vector<SingleRun> result;
  std::set<std::string> names;
  for (std::size_t r = 0; r < runs; ++r) {
    SingleRun single{"run", file};
    std::size_t rest = r, block = runs;
    std::string name;
    for (std::size_t i = 0; i < lists.size(); ++i) {
      std::size_t pick = r;
      if (product && i < naming) {
        block /= lists[i].node->items.size();
        pick = rest / block;
        rest %= block;
      }
      const Node item = lists[i].node->items[pick];
      descend(single.tree, lists[i].path) = item;
      if (i == 0 && naming > 0) name = lists[i].key + "=" + without_spaces(item.text);
      if (product && i > 0 && i < naming) name += "," + lists[i].key + "=" + without_spaces(item.text);
    }
    if (!name.empty()) single.name = name;
    for (int copy = 2; !names.insert(single.name).second; ++copy) single.name = fmt::format("{}#{}", name, copy);
    result.push_back(std::move(single));
  }
  return result;
}

}  // namespace grainlaw::element
