#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace grainlaw::report {

using Json = nlohmann::ordered_json;

/// The member as text ("" when it is missing or null; numbers are written out).
std::string text(const Json& object, const std::string& key);

/// The member as a number, or the fallback when it is missing or null.
double number(const Json& object, const std::string& key, double fallback);

/// The member as a list, empty when it is missing or null; throws when it is anything else.
const Json& list(const Json& object, const std::string& key);

/// The member as an object, empty when it is missing or null; throws when it is anything else.
const Json& object(const Json& parent, const std::string& key);

}  // namespace grainlaw::report
