#include "report/survey.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/quantity.hpp"
#include "exec/error.hpp"

namespace breccia::report {
namespace {

double mean_size_of(const Shot& shot) {
  double sum = 0.0;
  if (shot.spheres()) {
    for (const double r : shot.radius) sum += r;
  } else {
    const std::size_t each = shot.corners_of_element();
    for (std::size_t t = 0; t < shot.elements(); ++t)
      sum += norm(shot.corner[each * t + 1] - shot.corner[each * t]);
  }
  return shot.elements() == 0 ? 0.0 : sum / static_cast<double>(shot.elements());
}

void widen(Survey& survey, const Shot& shot) {
  for (std::size_t i = 0; i < shot.corner.size(); ++i) {
    const double r = shot.spheres() ? shot.radius[i] : 0.0;
    const Vec3& p = shot.corner[i];
    survey.low = {std::min(survey.low.x, p.x - r), std::min(survey.low.y, p.y - r),
                  std::min(survey.low.z, p.z - r)};
    survey.high = {std::max(survey.high.x, p.x + r), std::max(survey.high.y, p.y + r),
                   std::max(survey.high.z, p.z + r)};
  }
}

void note_fields(Survey& survey, const std::vector<FrameField>& fields, bool of_lines,
                 const std::vector<FrameField>& first) {
  for (const FrameField& field : fields) {
    if (field.name == "id") continue;
    auto known = std::find_if(
        survey.fields.begin(), survey.fields.end(),
        [&](const FieldSurvey& f) { return f.name == field.name && f.of_lines == of_lines; });
    if (known == survey.fields.end()) {
      survey.fields.push_back(
          {field.name, field.unit, of_lines, field.components, is_name_of_things(field.name)});
      known = survey.fields.end() - 1;
    }
    double sum = 0.0;
    for (const float value : field.values) {
      if (!std::isfinite(value)) continue;
      known->low = std::min(known->low, value);
      known->high = std::max(known->high, value);
      sum += std::abs(static_cast<double>(value));
    }
    if (!field.values.empty()) known->mean_size = sum / static_cast<double>(field.values.size());
    const FrameField* const before = field_named(first, field.name);
    if (before == nullptr || before->values != field.values) known->constant = false;
  }
}

std::vector<std::size_t> broken_by_kind(const Shot& shot) {
  const FrameField* const kind = field_named(shot.line_fields, "kind");
  const std::vector<std::uint8_t> broken = broken_lines(shot);
  std::vector<std::size_t> counts(1, 0);
  for (std::size_t l = 0; l < broken.size(); ++l) {
    if (broken[l] == 0) continue;
    const float value = kind == nullptr ? 0.0F : kind->values[l];
    const std::size_t k = value > 0.0F && value < 100.0F ? static_cast<std::size_t>(value) : 0;
    if (k >= counts.size()) counts.resize(k + 1, 0);
    ++counts[k];
  }
  return counts;
}

}  // namespace

Survey survey_of(const std::string& folder, std::size_t count) {
  Survey survey;
  for (std::size_t k = 0; k < count; ++k) {
    Shot shot = read_shot(folder, static_cast<int>(k));
    if (k == 0) {
      survey.plane = shot.plane;
      survey.solid = shot.solid;
      survey.elements = shot.elements();
      survey.groups = shot.groups;
      survey.size = mean_size_of(shot);
      if (!shot.corner.empty()) survey.low = survey.high = shot.corner.front();
      survey.first = shot;
    }
    if (!match(shot, survey.first))
      throw IoError(
          fmt::format("{}: cannot be drawn: frame {} has {} elements, the first frame has {}",
                      folder, k, shot.elements(), survey.elements));
    widen(survey, shot);
    note_fields(survey, shot.element_fields, false, survey.first.element_fields);
    note_fields(survey, shot.line_fields, true, survey.first.line_fields);
    survey.contacts = std::max(survey.contacts, shot.contacts.size());
    if (!shot.contacts.empty())
      survey.contact_force = std::max(survey.contact_force, norm(shot.contacts.front().force));
    survey.bolts = std::max(survey.bolts, shot.bolts.size());
    for (const FrameBar& bolt : shot.bolts)
      if (std::isfinite(bolt.force))
        survey.bolt_force = std::max(survey.bolt_force, std::abs(static_cast<double>(bolt.force)));
    if (!shot.spheres() || shot.ends != survey.first.ends) survey.lines_constant = false;
    survey.frames.push_back(
        {static_cast<int>(k), shot.step, shot.time, shot.lines(), broken_by_kind(shot)});
    if (k + 1 == count) survey.last = std::move(shot);
  }
  if (count == 1) survey.last = survey.first;
  return survey;
}

}  // namespace breccia::report
