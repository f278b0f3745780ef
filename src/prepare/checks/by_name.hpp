#pragma once
// Items of a case by their names.

#include <algorithm>
#include <string>

namespace breccia::prepare {

/// The names of all items, for messages; "none" without items.
template <class Items>
std::string all_names(const Items& items) {
  std::string text;
  for (const auto& item : items) text += (text.empty() ? "" : ", ") + item.name;
  return text.empty() ? "none" : text;
}

/// The item of this name; nullptr if there is none.
template <class Items>
auto item_named(const Items& items, const std::string& name) {
  const auto found =
      std::find_if(items.begin(), items.end(), [&](const auto& i) { return i.name == name; });
  return found == items.end() ? nullptr : &*found;
}

}  // namespace breccia::prepare
