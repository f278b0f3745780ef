#pragma once
// Items of a case by their names.

#include <algorithm>
#include <string>
#include <vector>

#include "core/nearest_name.hpp"

namespace breccia::prepare {

/// The names of all items, for messages; "none" without items.
template <class Items>
std::string all_names(const Items& items) {
  std::string text;
  for (const auto& item : items) text += (text.empty() ? "" : ", ") + item.name;
  return text.empty() ? "none" : text;
}

/// Likewise, and the one that a name which none of them has may have meant.
template <class Items>
std::string all_names(const Items& items, const std::string& unknown) {
  std::vector<std::string> names;
  for (const auto& item : items) names.push_back(item.name);
  return all_names(items) + meant_name(unknown, names);
}

/// The item of this name; nullptr if there is none.
template <class Items>
auto item_named(const Items& items, const std::string& name) {
  const auto found =
      std::find_if(items.begin(), items.end(), [&](const auto& i) { return i.name == name; });
  return found == items.end() ? nullptr : &*found;
}

}  // namespace breccia::prepare
