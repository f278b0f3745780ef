#include "texts.hpp"

#include <regex>

namespace breccia {

nlohmann::json parsed_json(const std::string& text) {
  return nlohmann::json::parse(text);
}
nlohmann::ordered_json parsed_in_order(const std::string& text) {
  return nlohmann::ordered_json::parse(text);
}

std::string first_match(const std::string& text, const std::string& expression) {
  std::smatch found;
  return std::regex_search(text, found, std::regex(expression)) ? found.str() : "";
}
bool matches(const std::string& text, const std::string& expression) {
  return std::regex_match(text, std::regex(expression));
}

}  // namespace breccia
