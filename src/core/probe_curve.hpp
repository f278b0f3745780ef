#pragma once
// A probe over another one, as output.curves names it: "force over deflection", "-force over -way".

#include <optional>
#include <string>

namespace breccia {

struct ProbeCurve {
  struct Axis {
    std::string probe;
    double sign = 1.0;  ///< -1: turned  [-]
  };
  Axis y, x;

  /// None: the text is no such curve.
  static std::optional<ProbeCurve> parsed(const std::string& text) {
    static const std::string word = " over ";
    const std::size_t at = text.find(word);
    if (at == std::string::npos || text.find(word, at + 1) != std::string::npos)
      return std::nullopt;
    const ProbeCurve curve{axis_of(text.substr(0, at)), axis_of(text.substr(at + word.size()))};
    if (curve.y.probe.empty() || curve.x.probe.empty()) return std::nullopt;
    return curve;
  }

 private:
  static Axis axis_of(const std::string& text) {
    const std::size_t first = text.find_first_not_of(' '), last = text.find_last_not_of(' ');
    if (first == std::string::npos) return {};
    const bool turned = text[first] == '-';
    const std::size_t begin = first + (turned ? 1 : 0);
    return {text.substr(begin, last + 1 - begin), turned ? -1.0 : 1.0};
  }
};

}  // namespace breccia
