#include "io/vtu/plane_tensors.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

namespace breccia {
namespace {

constexpr std::array tensor_parts{"_xx", "_yy", "_zz", "_xy"};  ///< the first places of a tensor
constexpr std::size_t six = 6;

/// Name of the tensor whose parts begin at a field; empty: none.
std::string tensor_at(const std::vector<FrameField>& fields, std::size_t first) {
  const std::string& start = fields[first].name;
  if (!start.ends_with(tensor_parts[0]) || first + tensor_parts.size() > fields.size()) return "";
  const std::string name = start.substr(0, start.size() - 3);
  for (std::size_t k = 0; k < tensor_parts.size(); ++k) {
    const FrameField& f = fields[first + k];
    const bool fits = f.name == name + tensor_parts[k] && f.components == 1 && !f.integers &&
                      f.values.size() == fields[first].values.size();
    if (!fits) return "";
  }
  return name;
}

}  // namespace

std::vector<FrameField> tensors_joined(const std::vector<FrameField>& fields) {
  std::vector<FrameField> joined;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const std::string name = tensor_at(fields, i);
    if (name.empty()) {
      joined.push_back(fields[i]);
      continue;
    }
    const std::size_t count = fields[i].values.size();
    FrameField tensor{name, fields[i].unit, six, std::vector<float>(six * count, 0.0F)};
    for (std::size_t k = 0; k < tensor_parts.size(); ++k)
      for (std::size_t item = 0; item < count; ++item)
        tensor.values[six * item + k] = fields[i + k].values[item];
    joined.push_back(std::move(tensor));
    i += tensor_parts.size() - 1;
  }
  return joined;
}

std::vector<FrameField> tensors_parted(std::vector<FrameField> fields) {
  std::vector<FrameField> parted;
  for (FrameField& field : fields) {
    if (field.components != static_cast<int>(six)) {
      parted.push_back(std::move(field));
      continue;
    }
    const std::size_t count = field.values.size() / six;
    for (std::size_t k = 0; k < tensor_parts.size(); ++k) {
      FrameField& part =
          parted.emplace_back(FrameField{field.name + tensor_parts[k], field.unit, 1, {}});
      part.values.reserve(count);
      for (std::size_t item = 0; item < count; ++item)
        part.values.push_back(field.values[six * item + k]);
    }
  }
  return parted;
}

}  // namespace breccia
