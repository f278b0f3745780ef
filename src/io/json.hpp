#pragma once
// JSON of results and messages: one type for all of it, compiled once.

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

extern template class nlohmann::basic_json<nlohmann::ordered_map>;

namespace breccia {

/// Keys stay in their order.
using Json = nlohmann::ordered_json;

/// is_discarded() if the text is no JSON.
Json read_json(std::string_view text);

/// In one line, or with lines indented by so many places; bytes that are no UTF-8 are replaced.
std::string json_text(const Json& json, int indent = -1);

}  // namespace breccia
