#include "io/case/toml_error.hpp"

#include <array>
#include <utility>

namespace breccia {
namespace {

/// The text between two others, if both are there.
std::string_view between(std::string_view text, std::string_view before, std::string_view after) {
  const std::size_t start = text.find(before);
  if (start == std::string_view::npos) return {};
  text.remove_prefix(start + before.size());
  return text.substr(0, text.find(after));
}

std::string replaced(std::string text, std::string_view from, std::string_view to) {
  for (std::size_t at = text.find(from); at != std::string::npos;
       at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
  return text;
}

constexpr std::array<std::pair<std::string_view, std::string_view>, 4> whole{
    {{"could not determine value type",
      "this is no value; a text is written in quotes, as in \"rock\""},
     {"unescaped control characters", "a text ends with a quote in the line that it begins in"},
     {"expected a comment or whitespace",
      "something follows the value; a quantity with a unit is written in quotes, as in \"40 mm\""},
     {"leading zeroes are prohibited", "a number must not begin with 0 and another digit"}}};

}  // namespace

std::string plain_toml_error(std::string_view description) {
  for (const auto& [said, plain] : whole)
    if (description.find(said) != std::string_view::npos) return std::string(plain);
  if (const std::string_view saw = between(description, "digit, saw '", "'");
      !saw.empty() && saw != "\\n" && saw != "\\r")
    return "this is no number; a quantity with a unit is written in quotes, as in \"40 mm\"";
  if (description.find("cannot redefine existing") != std::string_view::npos) {
    const std::string name(between(description, "'", "'"));
    const bool tables = description.find("as array-of-tables") != std::string_view::npos;
    return name + (tables ? " is given both as [" + name + "] and as [[" + name + "]]; write [[" +
                                name + "]] for each of several"
                          : " is given twice");
  }
  constexpr std::string_view start = "Error while parsing ";
  if (description.starts_with(start)) description.remove_prefix(start.size());
  std::string text(description);
  text = replaced(text, "saw '\\n'", "but the line ends");
  text = replaced(text, "saw '\\r'", "but the line ends");
  text = replaced(text, "encountered end-of-file", "the file ends before it does");
  return replaced(text, "\n", "");
}

}  // namespace breccia
