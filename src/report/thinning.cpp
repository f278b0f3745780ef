#include "report/thinning.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <unordered_set>

namespace breccia::report {
namespace {

/// Every second of the frames, with the first and the last.
std::vector<std::size_t> halved(const std::vector<std::size_t>& frames) {
  std::vector<std::size_t> kept;
  for (std::size_t k = 0; k < frames.size(); k += 2) kept.push_back(frames[k]);
  if (kept.back() != frames.back()) kept.push_back(frames.back());
  return kept;
}

class Cells {
 public:
  Cells(const Shot& shot, double size) : size_(size) {
    for (const Vec3& p : shot.corner) occupied_.insert(key(cell_of(p)));
  }
  bool is_surrounded(const Vec3& p) const {
    const std::array<std::int64_t, 3> cell = cell_of(p);
    for (std::int64_t i = -1; i <= 1; ++i)
      for (std::int64_t j = -1; j <= 1; ++j)
        for (std::int64_t k = -1; k <= 1; ++k)
          if (!occupied_.contains(key({cell[0] + i, cell[1] + j, cell[2] + k}))) return false;
    return true;
  }

 private:
  std::array<std::int64_t, 3> cell_of(const Vec3& p) const {
    return {std::llround(p.x / size_), std::llround(p.y / size_), std::llround(p.z / size_)};
  }
  static std::uint64_t key(const std::array<std::int64_t, 3>& cell) {
    std::uint64_t number = 0;
    for (const std::int64_t c : cell)
      number = number << 21 | (static_cast<std::uint64_t>(c) & 0x1fffffU);
    return number;
  }

  double size_;
  std::unordered_set<std::uint64_t> occupied_;
};

/// Whether each element belongs to the largest group.
std::vector<bool> in_largest_group(const Shot& shot) {
  std::vector<bool> inside(shot.elements(), true);
  const FrameField* const group = field_named(shot.element_fields, "group");
  if (group == nullptr) return inside;
  std::map<float, std::size_t> sizes;
  for (const float g : group->values) ++sizes[g];
  const auto largest = std::max_element(
      sizes.begin(), sizes.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  for (std::size_t i = 0; i < inside.size(); ++i) inside[i] = group->values[i] == largest->first;
  return inside;
}

/// Tetrahedra with an exposed face, now or at the end; those that lie on another side of a crack
/// have one.
std::vector<bool> with_faces(const Survey& survey) {
  std::vector<bool> seen(survey.elements, true);
  const FrameField* const first = field_named(survey.first.element_fields, "exposed");
  const FrameField* const last = field_named(survey.last.element_fields, "exposed");
  for (std::size_t i = 0; first != nullptr && last != nullptr && i < seen.size(); ++i)
    seen[i] = first->values[i] > 0.0F || last->values[i] > 0.0F;
  return seen;
}

/// Spheres that have none about them on some side, at first or at last.
std::vector<bool> not_surrounded(const Survey& survey) {
  const double size = 2.5 * survey.size;
  const Cells at_first(survey.first, size), at_last(survey.last, size);
  std::vector<bool> seen(survey.elements);
  for (std::size_t i = 0; i < seen.size(); ++i)
    seen[i] = !at_first.is_surrounded(survey.first.corner[i]) ||
              !at_last.is_surrounded(survey.last.corner[i]);
  return seen;
}

}  // namespace

std::vector<std::uint32_t> visible_elements(const Survey& survey) {
  const std::vector<bool> bulk = in_largest_group(survey.first);
  const std::vector<bool> seen = survey.solid ? with_faces(survey) : not_surrounded(survey);
  const FrameField* const damage = field_named(survey.last.element_fields, "damage");
  std::vector<std::uint32_t> visible;
  for (std::uint32_t i = 0; i < survey.elements; ++i) {
    const bool damaged = damage != nullptr && damage->values[i] > 0.05F;
    if (!bulk[i] || damaged || seen[i]) visible.push_back(i);
  }
  return visible;
}

Selection Selection::whole(const Survey& survey) {
  Selection all;
  all.frames.resize(survey.frames.size());
  std::iota(all.frames.begin(), all.frames.end(), std::size_t{0});
  all.elements.resize(survey.elements);
  std::iota(all.elements.begin(), all.elements.end(), 0U);
  return all;
}

bool Selection::tighten(const Survey& survey) {
  if (line_forces) {
    line_forces = false;
  } else if (components) {
    components = false;
  } else if (frames.size() > 21) {
    frames = halved(frames);
  } else if (fine) {
    fine = false;
  } else if (frames.size() > 11) {
    frames = halved(frames);
  } else if (hidden && !survey.plane) {
    hidden = false;
    elements = visible_elements(survey);
  } else if (all_fields) {
    all_fields = false;
  } else if (frames.size() > 3) {
    frames = halved(frames);
  } else if (elements.size() > 1000) {
    stride *= 2;
    std::vector<std::uint32_t> kept;
    for (std::size_t k = 0; k < elements.size(); k += 2) kept.push_back(elements[k]);
    elements = std::move(kept);
  } else {
    return false;
  }
  return true;
}

bool Selection::takes(const FieldSurvey& field) const {
  if (field.of_lines) return line_forces || field.category || field.name == "damage";
  return all_fields || field.name == "group" || field.name == "damage" || field.name == "exposed";
}

std::vector<std::string> Selection::notes(const Survey& survey) const {
  std::vector<std::string> notes;
  if (frames.size() < survey.frames.size())
    notes.push_back(fmt::format("{} of {} frames are shown.", frames.size(), survey.frames.size()));
  if (!hidden || stride > 1)
    notes.push_back(fmt::format(
        "{} of {} elements are shown: {}.", elements.size(), survey.elements,
        hidden       ? fmt::format("one in {}", stride)
        : stride > 1 ? fmt::format("one in {} of those that can be seen from outside", stride)
                     : "those that can be seen from outside, are damaged, or belong to the "
                       "smaller bodies"));
  if (!components) notes.push_back("Of vectors only the length is here.");
  if (!line_forces) notes.push_back("Forces of links are not here.");
  if (!all_fields) notes.push_back("Of the fields only damage is here.");
  return notes;
}

double Selection::estimate(const Survey& survey) const {
  // Shares of the raw bytes that packing left over in the shipped cases.
  constexpr double of_positions = 0.6, of_fields = 0.8, of_lines = 0.3, in_text = 4.0 / 3.0;
  const double wide = fine ? 2.0 : 1.0;
  double element = of_positions * (survey.plane   ? 3.0
                                   : survey.solid ? 9.0
                                                  : 6.0),
         line = survey.plane   ? 8.0
                : survey.solid ? 18.0
                               : 0.0;
  for (const FieldSurvey& field : survey.fields) {
    if (!takes(field) || field.constant) continue;
    if (field.of_lines)
      line += of_lines;
    else
      element += of_fields * (field.category ? 0.3 : wide) *
                 (components ? static_cast<double>(field.components) : 1.0);
  }
  const double share = static_cast<double>(elements.size()) / static_cast<double>(survey.elements);
  double bytes = 0.0;
  for (const std::size_t k : frames)
    bytes += element * static_cast<double>(elements.size()) +
             line * share * static_cast<double>(survey.frames[k].lines);
  if (survey.spheres()) bytes += 2.5 * share * static_cast<double>(survey.frames.front().lines);
  return in_text * bytes;
}

}  // namespace breccia::report
