#pragma once
// JSON and regular expressions, whose parsers are instantiated once, in texts.cpp: each costs one
// to three seconds of compiling.

#include <nlohmann/json.hpp>
#include <string>

namespace breccia {

nlohmann::json parsed_json(const std::string& text);
nlohmann::ordered_json parsed_in_order(const std::string& text);

/// The first part of a text that a regular expression matches; empty: none does.
std::string first_match(const std::string& text, const std::string& expression);
/// Whether it matches the whole text.
bool matches(const std::string& text, const std::string& expression);

}  // namespace breccia
