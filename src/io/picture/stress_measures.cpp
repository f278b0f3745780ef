#include "io/picture/stress_measures.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "math/principal.hpp"

namespace breccia {
namespace {

constexpr std::array stress_measures{"stress_largest", "stress_smallest", "stress_mean",
                                     "stress_mises", "stress_shear"};

const FrameField* part_named(const std::vector<FrameField>& fields, const std::string& name) {
  const auto found = std::find_if(fields.begin(), fields.end(),
                                  [&](const FrameField& field) { return field.name == name; });
  return found == fields.end() ? nullptr : &*found;
}

/// The principal values in the plane of triangles, of others the outer two.
std::array<double, 2> outer_principal(const Sym3& s, bool plane) {
  if (!plane) {
    const std::array<double, 3> all = principal_values(s);
    return {all[0], all[2]};
  }
  const double mean = 0.5 * (s.xx + s.yy), half = 0.5 * (s.xx - s.yy);
  const double radius = std::sqrt(half * half + s.xy * s.xy);
  return {mean + radius, mean - radius};
}

double measure_of(const Sym3& s, std::size_t measure, bool plane) {
  if (measure == 2) return trace(s) / 3.0;
  if (measure == 3) return von_mises(s);
  const auto [largest, smallest] = outer_principal(s, plane);
  return measure == 0 ? largest : measure == 1 ? smallest : 0.5 * (largest - smallest);
}

}  // namespace

Stresses::Stresses(const Frame& frame)
    : carrier_(!frame.tetrahedra.empty() ? Carrier::tetrahedra
               : frame.triangles.empty() ? Carrier::points
                                         : Carrier::triangles) {
  const std::vector<FrameField>& fields = carrier_ == Carrier::tetrahedra ? frame.tetrahedron_fields
                                          : carrier_ == Carrier::points   ? frame.point_fields
                                                                          : frame.triangle_fields;
  if (const FrameField* tensor = part_named(fields, "stress");
      tensor != nullptr && tensor->components == 6) {
    parts_ = {tensor};
    return;
  }
  const std::size_t needed = carrier_ == Carrier::tetrahedra ? 6 : 3;
  for (const char* part : {"xx", "yy", "xy", "zz", "yz", "xz"}) {
    const FrameField* const field = part_named(fields, std::string("stress_") + part);
    if (field == nullptr) break;
    parts_.push_back(field);
  }
  if (parts_.size() < needed) parts_.clear();
}

std::size_t Stresses::count() const {
  return known() ? parts_[0]->values.size() / (parts_.size() == 1 ? 6 : 1) : 0;
}

Sym3 Stresses::at(std::size_t item) const {
  const auto value = [&](std::size_t field, std::size_t at) {
    return static_cast<double>(parts_[field]->values[at]);
  };
  if (parts_.size() == 1) {
    const auto one = [&](std::size_t k) { return value(0, 6 * item + k); };
    return {one(0), one(1), one(2), one(4), one(5), one(3)};
  }
  const auto of = [&](std::size_t k) { return k < parts_.size() ? value(k, item) : 0.0; };
  return {of(0), of(1), of(3), of(4), of(5), of(2)};
}

bool is_stress_measure(const std::string& name) {
  return std::find(stress_measures.begin(), stress_measures.end(), name) != stress_measures.end();
}

std::optional<FrameField> stress_measure(const Frame& frame, const std::string& name) {
  const auto measure = std::find(stress_measures.begin(), stress_measures.end(), name);
  const Stresses stresses(frame);
  if (measure == stress_measures.end() || !stresses.known()) return {};
  FrameField field{name, stresses.unit(), 1, {}};
  field.values.reserve(stresses.count());
  for (std::size_t i = 0; i < stresses.count(); ++i)
    field.values.push_back(static_cast<float>(
        measure_of(stresses.at(i), static_cast<std::size_t>(measure - stress_measures.begin()),
                   stresses.carrier() == Carrier::triangles)));
  return field;
}

}  // namespace breccia
