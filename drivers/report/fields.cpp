#include "fields.hpp"

#include <stdexcept>

namespace grainlaw::report {
namespace {

const Json& member(const Json& object, const std::string& key) {
  static const Json none;
  if (!object.is_object()) throw std::runtime_error("expected an object with the field '" + key + "'");
  const auto found = object.find(key);
  return found == object.end() ? none : *found;
}

}  // namespace

std::string text(const Json& object, const std::string& key) {
  const Json& value = member(object, key);
  if (value.is_null()) return "";
  return value.is_string() ? value.get<std::string>() : value.dump();
}

double number(const Json& object, const std::string& key, double fallback) {
  const Json& value = member(object, key);
  if (value.is_null()) return fallback;
  if (!value.is_number()) throw std::runtime_error("the field '" + key + "' should be a number");
  return value.get<double>();
}

const Json& list(const Json& object, const std::string& key) {
  static const Json empty = Json::array();
  const Json& value = member(object, key);
  if (value.is_null()) return empty;
  if (!value.is_array()) throw std::runtime_error("the field '" + key + "' should be a list");
  return value;
}

const Json& object(const Json& parent, const std::string& key) {
  static const Json empty = Json::object();
  const Json& value = member(parent, key);
  if (value.is_null()) return empty;
  if (!value.is_object()) throw std::runtime_error("the field '" + key + "' should be an object");
  return value;
}

}  // namespace grainlaw::report
