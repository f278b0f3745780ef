#pragma once
// Items of a case by their names.

#include <algorithm>
#include <string>
#include <vector>

#include "core/nearest_name.hpp"

namespace breccia {

/// The item of that name, or null.
template <class Item>
Item* find_named(std::vector<Item>& items, const std::string& name) {
  const auto found =
      std::find_if(items.begin(), items.end(), [&](const Item& item) { return item.name == name; });
  return found == items.end() ? nullptr : &*found;
}

template <class Item>
std::vector<std::string> names_of(const std::vector<Item>& items) {
  std::vector<std::string> names;
  for (const Item& item : items) names.push_back(item.name);
  return names;
}

/// Adds a sentence if a name that a key gives is none of those that there are.
inline void add_unknown(const std::string& key, const std::string& name, const std::string& kind,
                        const std::vector<std::string>& known, std::vector<std::string>& problems) {
  if (std::find(known.begin(), known.end(), name) != known.end()) return;
  std::string all;
  for (const std::string& one : known) all += (all.empty() ? "" : ", ") + one;
  problems.push_back(key + " = \"" + name + "\" is no " + kind +
                     "; there are: " + (all.empty() ? "none" : all) + meant_name(name, known));
}

}  // namespace breccia
