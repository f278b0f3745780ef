#include "report/film.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "io/json.hpp"
#include "report/packed_bytes.hpp"
#include "report/thinning.hpp"

namespace breccia::report {
namespace {

using Numbers = std::vector<std::uint32_t>;

/// How positions become whole numbers.
struct Grid {
  Vec3 low;
  double step = 1.0;  ///<  [m]
  int width = 2;      ///<  [bytes]
  int axes = 3;

  Grid(const Survey& survey, bool fine) : low(survey.low), axes(survey.plane ? 2 : 3) {
    const Vec3 box = survey.high - survey.low;
    const double extent = std::max({box.x, box.y, box.z, 1e-12});
    // A hundredth of an element cannot be seen; displacements of bodies may be shown enlarged.
    const bool wide = (!survey.spheres() && fine) || extent / 65535.0 > 0.02 * survey.size;
    width = wide ? 3 : 2;
    step = extent / static_cast<double>((1U << (8 * width)) - 1);
  }
  Numbers of(const std::vector<Vec3>& points, int axis) const {
    Numbers numbers;
    numbers.reserve(points.size());
    for (const Vec3& p : points) {
      const double place = axis == 0 ? p.x - low.x : axis == 1 ? p.y - low.y : p.z - low.z;
      const double last = static_cast<double>((1U << (8 * width)) - 1);
      numbers.push_back(
          static_cast<std::uint32_t>(std::llround(std::clamp(place / step, 0.0, last))));
    }
    return numbers;
  }
};

/// A field as the film stores it.
struct StoredField {
  const FieldSurvey* field;
  int components;  ///< 1 where only the length of a vector is kept
  Scale scale;
};

StoredField stored(const FieldSurvey& field, const Selection& selection) {
  StoredField made{&field, selection.components ? field.components : 1, {}};
  Scale& scale = made.scale;
  scale.low = field.low;
  scale.high = field.high;
  const double largest = std::max(std::abs(field.low), std::abs(field.high));
  if (field.category) {
    scale.low = 0.0F;
    scale.last = std::max(1U, static_cast<std::uint32_t>(std::max(field.high, 0.0F)));
    scale.high = static_cast<float>(scale.last);
    return made;
  }
  if (made.components < field.components) {
    scale.low = 0.0F;
    scale.high = static_cast<float>(largest * std::sqrt(field.components));
  }
  const bool fine = selection.fine && field.name != "spin";  // seldom looked at, and never alike
  scale.last = field.of_lines ? 63 : fine ? 511 : 255;
  scale.root = field.mean_size < 0.1 * largest;
  if (field.unit == "-" && field.low >= 0.0F && field.high <= 1.0F) {  // a share
    scale = {0.0F, 1.0F, field.of_lines ? 63U : 255U, false};
  }
  return made;
}

/// Positions of each frame as differences from the first: of triangles and tetrahedra less those of
/// the first corner that began at the same place, since corners of whole rock move together.
class Positions {
 public:
  Positions(const Grid& grid, bool together) : grid_(grid), together_(together) {}

  void add(Planes& planes, const std::vector<Vec3>& points) {
    const bool first = reference_.empty();
    std::vector<Numbers> now;
    for (int axis = 0; axis < grid_.axes; ++axis) now.push_back(grid_.of(points, axis));
    for (int axis = 0; axis < grid_.axes; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      Numbers differences = now[a];
      if (!first) {
        const Numbers& start = reference_[a];
        for (std::size_t i = 0; i < differences.size(); ++i) {
          std::uint32_t moved = now[a][i] - start[i];
          if (const std::size_t m = leader(i); m != i) moved -= now[a][m] - start[m];
          differences[i] = zigzag(moved, grid_.width);
        }
      }
      planes.add(differences, grid_.width);
    }
    if (!first) return;
    reference_ = std::move(now);
    if (together_) find_leaders();
  }

 private:
  std::size_t leader(std::size_t i) const { return together_ ? leader_[i] : i; }
  void find_leaders() {
    // By one coordinate after the other, as 24 bits and the number of a place in 64.
    std::unordered_map<std::uint64_t, std::size_t> seen_in_plane, seen;
    for (std::size_t i = 0; i < reference_[0].size(); ++i) {
      const auto key = [&](std::uint64_t high, int axis) {
        return high << 32 | reference_[static_cast<std::size_t>(axis)][i];
      };
      const std::size_t first = seen_in_plane.emplace(key(reference_[0][i], 1), i).first->second;
      leader_.push_back(grid_.axes < 3 ? first : seen.emplace(key(first, 2), i).first->second);
    }
  }

  const Grid& grid_;
  bool together_;
  std::vector<Numbers> reference_;
  std::vector<std::size_t> leader_;
};

/// Makes a film of what a selection takes.
class Cutter {
 public:
  Cutter(const std::string& folder, const Survey& survey, const Selection& selection)
      : folder_(folder),
        survey_(survey),
        selection_(selection),
        grid_(survey, selection.fine),
        positions_(grid_, !survey.spheres()) {
    for (const FieldSurvey& field : survey.fields)
      if (selection.takes(field)) fields_.push_back(stored(field, selection));
    place_.assign(survey.elements, -1);
    for (std::size_t k = 0; k < selection.elements.size(); ++k)
      place_[selection.elements[k]] = static_cast<std::int32_t>(k);
  }

  Film made(std::size_t first_blob) {
    Film film;
    Json frames = Json::array();
    for (const std::size_t k : selection_.frames) {
      const FrameFacts& facts = survey_.frames[k];
      Shot shot = read_shot(folder_, facts.number);
      match(shot, survey_.first);
      Json frame{{"number", facts.number}, {"step", facts.step}, {"time", facts.time}};
      frame["blob"] = first_blob + film.blobs.size();
      Planes planes;
      add_elements(planes, shot);
      add_lines(planes, shot, frame);
      add_contacts(planes, shot, frame);
      add_bolts(planes, shot, frame);
      film.blobs.push_back(base64(deflated(planes.bytes())));
      frames.push_back(std::move(frame));
      first_ = false;
    }
    film.json = json_text(described(std::move(frames)));
    film.notes = selection_.notes(survey_);
    if (survey_.contacts > most_contacts())
      film.notes.push_back(
          fmt::format("Of {} contacts of a frame the {} strongest at most are here.",
                      survey_.contacts, most_contacts()));
    return film;
  }

 private:
  void add_elements(Planes& planes, const Shot& shot) {
    std::vector<Vec3> corner;
    const std::size_t each = survey_.first.corners_of_element();
    for (const std::uint32_t i : selection_.elements)
      for (std::size_t c = 0; c < each; ++c) corner.push_back(shot.corner[each * i + c]);
    positions_.add(planes, corner);
    if (first_ && survey_.spheres()) {
      Numbers radius;
      const Scale scale = radius_scale();
      for (const std::uint32_t i : selection_.elements)
        radius.push_back(scale.step_of(static_cast<float>(shot.radius[i])));
      planes.add(radius, 2);
    }
    for (const StoredField& field : fields_)
      if (!field.field->of_lines && (first_ || !field.field->constant))
        add_field(planes, field, shot.element_fields, selection_.elements);
  }

  void add_lines(Planes& planes, const Shot& shot, Json& frame) {
    std::vector<std::uint32_t> kept;
    for (std::size_t l = 0; l < shot.lines(); ++l)
      if (!survey_.spheres() || (place(shot.ends[2 * l]) >= 0 && place(shot.ends[2 * l + 1]) >= 0))
        kept.push_back(static_cast<std::uint32_t>(l));
    const bool told = !survey_.spheres() || first_ || !survey_.lines_constant;
    frame["lines"] = kept.size();
    frame["ends"] = told;
    if (told && !survey_.spheres()) {
      std::vector<Vec3> points;
      const std::size_t each = shot.ends_of_line();
      for (const std::uint32_t l : kept)
        for (std::size_t k = 0; k < each; ++k) points.push_back(shot.end[each * l + k]);
      for (int axis = 0; axis < grid_.axes; ++axis) planes.add(grid_.of(points, axis), grid_.width);
    } else if (told) {
      Numbers a, b;
      std::uint32_t before = 0;
      for (const std::uint32_t l : kept) {
        const auto from = static_cast<std::uint32_t>(place(shot.ends[2 * l]));
        const auto to = static_cast<std::uint32_t>(place(shot.ends[2 * l + 1]));
        a.push_back(zigzag(from - before, 4));
        b.push_back(zigzag(to - from, 4));
        before = from;
      }
      planes.add(a, 4);
      planes.add(b, 4);
    }
    for (const StoredField& field : fields_)
      if (field.field->of_lines && (told || !field.field->constant))
        add_field(planes, field, shot.line_fields, kept);
  }

  /// Contacts are seldom looked at: all frames together have room for so many.
  std::size_t most_contacts() const {
    return std::max<std::size_t>(100000 / selection_.frames.size(), 500);
  }
  Scale contact_scale() const {
    return {0.0F, static_cast<float>(survey_.contact_force), 63, true};
  }
  /// The strongest: both ends, and the force.
  void add_contacts(Planes& planes, const Shot& shot, Json& frame) const {
    const std::size_t count = std::min(shot.contacts.size(), most_contacts());
    if (!(survey_.contact_force > 0.0)) return;
    frame["contacts"] = count;
    std::vector<Vec3> ends;
    Numbers force;
    for (std::size_t i = 0; i < count; ++i) {
      ends.push_back(shot.contacts[i].at_a);
      ends.push_back(shot.contacts[i].at_b);
      force.push_back(contact_scale().step_of(static_cast<float>(norm(shot.contacts[i].force))));
    }
    for (int axis = 0; axis < grid_.axes; ++axis) planes.add(grid_.of(ends, axis), grid_.width);
    planes.add(force, 1);
  }

  /// Both ends, and the force along it; of bolts that bear nothing in any frame the middle step.
  void add_bolts(Planes& planes, const Shot& shot, Json& frame) const {
    if (survey_.bolts == 0) return;
    frame["bolts"] = shot.bolts.size();
    const auto largest = static_cast<float>(survey_.bolt_force > 0.0 ? survey_.bolt_force : 1.0);
    const Scale scale{-largest, largest, 254, false};
    std::vector<Vec3> ends;
    Numbers force;
    for (const FrameBar& bolt : shot.bolts) {
      ends.push_back(bolt.begin);
      ends.push_back(bolt.end);
      force.push_back(scale.step_of(bolt.force));
    }
    for (int axis = 0; axis < grid_.axes; ++axis) planes.add(grid_.of(ends, axis), grid_.width);
    planes.add(force, 1);
  }

  static void add_field(Planes& planes, const StoredField& field,
                        const std::vector<FrameField>& values, const Numbers& items) {
    const FrameField* const found = field_named(values, field.field->name);
    const auto width = static_cast<std::size_t>(field.field->components);
    for (int c = 0; c < field.components; ++c) {
      Numbers steps;
      for (const std::uint32_t i : items) {
        float value = 0.0F;
        if (found != nullptr && static_cast<std::size_t>(field.components) == width) {
          value = found->values[width * i + static_cast<std::size_t>(c)];
        } else if (found != nullptr) {
          for (std::size_t k = 0; k < width; ++k)
            value += found->values[width * i + k] * found->values[width * i + k];
          value = std::sqrt(value);
        }
        steps.push_back(field.scale.step_of(value));
      }
      planes.add(steps, field.scale.width());
    }
  }

  Scale radius_scale() const {
    const std::vector<double>& r = survey_.first.radius;
    return {0.0F, r.empty() ? 1.0F : static_cast<float>(*std::max_element(r.begin(), r.end())),
            65535, false};
  }

  Json described(Json&& frames) const {
    Json film;
    film["plane"] = survey_.plane;
    film["solid"] = survey_.solid;
    film["elements"] = selection_.elements.size();
    film["low"] = {survey_.low.x, survey_.low.y, survey_.low.z};
    film["high"] = {survey_.high.x, survey_.high.y, survey_.high.z};
    film["step"] = grid_.step;
    film["width"] = grid_.width;
    film["size"] = survey_.size;
    if (survey_.spheres()) film["largest_radius"] = radius_scale().high;
    film["groups"] = survey_.groups;
    if (survey_.contact_force > 0.0) film["contact_force"] = survey_.contact_force;
    if (survey_.bolts > 0) film["bolt_force"] = survey_.bolt_force;
    film["fields"] = Json::array();
    for (const StoredField& f : fields_)
      film["fields"].push_back({{"name", f.field->name},
                                {"unit", f.field->unit},
                                {"lines", f.field->of_lines},
                                {"components", f.components},
                                {"length", f.components < f.field->components},
                                {"category", f.field->category},
                                {"constant", f.field->constant},
                                {"low", f.scale.low},
                                {"high", f.scale.high},
                                {"last", f.scale.last},
                                {"root", f.scale.root}});
    film["frames"] = std::move(frames);
    return film;
  }

  std::int32_t place(std::int32_t element) const {
    return place_[static_cast<std::size_t>(element)];
  }

  const std::string& folder_;
  const Survey& survey_;
  const Selection& selection_;
  Grid grid_;
  Positions positions_;
  std::vector<StoredField> fields_;
  std::vector<std::int32_t> place_;  ///< of each element in the film; -1: it is not in it
  bool first_ = true;
};

}  // namespace

std::size_t Film::bytes() const {
  std::size_t sum = json.size();
  for (const std::string& blob : blobs) sum += blob.size();
  return sum;
}

namespace {

/// The film thinned out until it is thought to take no more than `limit` bytes.
Selection expected_within(const Survey& survey, double limit) {
  Selection selection = Selection::whole(survey);
  while (selection.estimate(survey) > limit && selection.tighten(survey)) {
  }
  return selection;
}

}  // namespace

Film film_of(const std::string& folder, const Survey& survey, std::size_t first_blob,
             std::size_t limit) {
  const double whole = Selection::whole(survey).estimate(survey), most = static_cast<double>(limit);
  Selection selection = expected_within(survey, most);
  Film film = Cutter(folder, survey, selection).made(first_blob);
  const double taken = static_cast<double>(film.bytes());
  if (whole > most && 3.0 * taken < most) {  // it packs far better than others: more has room
    const double packs = 1.3 * taken / selection.estimate(survey);
    Film richer = Cutter(folder, survey, expected_within(survey, most / packs)).made(first_blob);
    if (richer.bytes() <= limit) return richer;
  }
  while (film.bytes() > limit && selection.tighten(survey))
    film = Cutter(folder, survey, selection).made(first_blob);
  return film;
}

}  // namespace breccia::report
