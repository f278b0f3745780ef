#pragma once
// How a configuration lists itself once (`each_key`): name, value, unit, allowed range, meaning.
//
// A struct with keys has
//
//   template <class Visit> void each_key(Visit&& key) {
//     key("safety", safety, "-", Range{0.0, 1.0, Open::low}, "share of the critical step that is
//     used");
//   }
//
// and a visitor is called with the forms below; io/case_file reads, checks, prints and documents
// from it:
//
//   key(name, value, unit, Range, meaning)     value: double, int, std::int64_t, Vec3,
//   std::vector<double>,
//                                              std::optional<double>; unit: "Pa", "m/s", "-",
//                                              "rad", ...
//   key(name, value, meaning)                  value: bool, std::string, std::vector<std::string>
//   key(name, text, OneOf{...}, meaning)       text: std::string, one of the words
//   key.table(name, config, meaning)           a sub-table [name]
//   key.list(name, configs, meaning)           std::vector<Config>: an array of tables [[name]]
//   key.named(name, configs, meaning)          std::vector<Config> with a member `name`: [name.<its
//   name>] key.required(name)                         the key listed under `name` before has no
//   default
//
// The value a member has when it is constructed is its default.

#include <initializer_list>
#include <limits>
#include <string>
#include <vector>

namespace breccia {

inline constexpr double no_limit = std::numeric_limits<double>::infinity();

/// Which ends of a range do not belong to it.
enum class Open { none, low, high, both };

/// The allowed values of a number, in SI units.
struct Range {
  double low = -no_limit;
  double high = no_limit;
  Open open = Open::none;
  bool holds(double value) const {
    const bool above = open == Open::low || open == Open::both ? value > low : value >= low;
    const bool below = open == Open::high || open == Open::both ? value < high : value <= high;
    return above && below;
  }
};

/// The allowed words of a text.
struct OneOf {
  std::vector<std::string> words;
  OneOf(std::initializer_list<const char*> list) : words(list.begin(), list.end()) {}
};

inline const Range positive{0.0, no_limit, Open::low};
inline const Range not_negative{0.0, no_limit};
inline const Range any_number{};

}  // namespace breccia
