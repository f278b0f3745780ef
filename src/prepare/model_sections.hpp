#pragma once
// The sections of a model file, shared by the models of all methods.

#include <fmt/format.h>

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "exec/error.hpp"
#include "exec/memory.hpp"
#include "io/checkpoint.hpp"

namespace breccia::model_sections {

template <class T, class Memory>
void save_array(CheckpointWriter& writer, const std::string& name,
                const std::vector<T, Memory>& items) {
  writer.section("model." + name, items.data(), items.size(), sizeof(T));
}

template <class T, class Memory = std::allocator<T>>
std::vector<T, Memory> load_array(const CheckpointReader& reader, const std::string& name) {
  const CheckpointReader::Section& section = reader.section("model." + name, sizeof(T));
  std::vector<T, Memory> items(section.count);
  copy_bytes(items.data(), Space::host, section.bytes.data(), Space::host, section.bytes.size());
  return items;
}

/// A number of a model that the case must know.
inline void refuse_unknown(const char* array, std::span<const std::int16_t> numbers,
                           std::int16_t least, std::size_t known) {
  for (const std::int16_t n : numbers)
    if (n < least || n >= static_cast<std::int64_t>(known))
      throw CheckpointError(
          fmt::format("the model's {} holds {}, of which the case knows nothing", array, n));
}

inline std::string lines_of(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += name + '\n';
  return text;
}

inline std::vector<std::string> lines_in(const std::string& text) {
  std::vector<std::string> names;
  std::string name;
  for (const char c : text) {
    if (c != '\n') {
      name += c;
      continue;
    }
    names.push_back(name);
    name.clear();
  }
  return names;
}

}  // namespace breccia::model_sections
