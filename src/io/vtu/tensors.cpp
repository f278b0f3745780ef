#include "io/vtu/tensors.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

namespace breccia {
namespace {

constexpr std::array tensor_parts{"_xx", "_yy", "_zz", "_xy", "_yz", "_xz"};
constexpr std::size_t six = tensor_parts.size(), of_plane = 4;

/// How many fields from `first` on are the parts of a tensor: 6, 4 or 0.
std::size_t parts_at(const std::vector<FrameField>& fields, std::size_t first,
                     const std::string& name) {
  std::size_t parts = 0;
  for (; parts < six && first + parts < fields.size(); ++parts) {
    const FrameField& f = fields[first + parts];
    const bool fits = f.name == name + tensor_parts[parts] && f.components == 1 && !f.integers &&
                      f.values.size() == fields[first].values.size();
    if (!fits) break;
  }
  return parts == six ? six : parts >= of_plane ? of_plane : 0;
}

}  // namespace

std::vector<FrameField> tensors_joined(const std::vector<FrameField>& fields) {
  std::vector<FrameField> joined;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const std::string& start = fields[i].name;
    const std::string name =
        start.ends_with(tensor_parts[0]) ? start.substr(0, start.size() - 3) : "";
    const std::size_t parts = name.empty() ? 0 : parts_at(fields, i, name);
    if (parts == 0) {
      joined.push_back(fields[i]);
      continue;
    }
    const std::size_t count = fields[i].values.size();
    FrameField tensor{name, fields[i].unit, six, std::vector<float>(six * count, 0.0F)};
    for (std::size_t k = 0; k < parts; ++k)
      for (std::size_t item = 0; item < count; ++item)
        tensor.values[six * item + k] = fields[i + k].values[item];
    joined.push_back(std::move(tensor));
    i += parts - 1;
  }
  return joined;
}

std::vector<FrameField> tensors_parted(std::vector<FrameField> fields, bool plane) {
  std::vector<FrameField> parted;
  for (FrameField& field : fields) {
    if (field.components != static_cast<int>(six)) {
      parted.push_back(std::move(field));
      continue;
    }
    const std::size_t count = field.values.size() / six;
    for (std::size_t k = 0; k < (plane ? of_plane : six); ++k) {
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
