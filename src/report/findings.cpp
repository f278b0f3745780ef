#include "report/findings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "io/round_numbers.hpp"
#include "math/constants.hpp"
#include "math/principal.hpp"
#include "report/first_breaks.hpp"
#include "report/shot.hpp"

namespace breccia::report {
namespace {

/// A place, to three digits of its largest coordinate.
std::string place_text(const Vec3& p, bool plane) {
  const double largest = std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z), 1e-9});
  const bool short_ = largest < 1.0;
  const double step = std::pow(10.0, std::floor(std::log10(largest)) - 2.0);
  const auto number = [&](double x) {
    const double rounded = std::round(x / step) * step * (short_ ? 1e3 : 1.0);
    return fmt::format("{:.3g}", rounded == 0.0 ? 0.0 : rounded);
  };
  const std::string xy = number(p.x) + ", " + number(p.y);
  return fmt::format("({}{}) {}", xy, plane ? "" : ", " + number(p.z), short_ ? "mm" : "m");
}

std::string value_text(double value, const std::string& unit) {
  const ScaledUnit scaled = scaled_unit(unit, std::abs(value));
  const double shown = value * scaled.factor;
  return std::abs(shown) < 999.5 ? fmt::format("{:.3g} {}", shown, scaled.unit)
                                 : fmt::format("{} {}", count_text(shown), scaled.unit);
}

std::string percent_text(double share) {
  const double percent = 100.0 * share;
  return percent >= 9.95 ? fmt::format("{:.0f} %", percent) : fmt::format("{:.2g} %", percent);
}

std::string count_of(double count, const std::string& what) {
  return fmt::format("{} {}{}", count_text(count), what, count == 1.0 ? "" : "s");
}

std::string listed(const std::vector<std::string>& items) {
  std::string text;
  for (std::size_t i = 0; i < items.size(); ++i)
    text += (i == 0 ? "" : i + 1 == items.size() ? " and " : ", ") + items[i];
  return text;
}

/// Bodies that the ends of broken lines belong to.
std::string bodies_of(const Shot& shot, const std::vector<std::uint8_t>& broken) {
  const FrameField* const group = field_named(shot.element_fields, "group");
  if (!shot.spheres() || group == nullptr) return "";
  std::set<std::size_t> found;
  for (std::size_t l = 0; l < broken.size(); ++l)
    if (broken[l] != 0)
      found.insert(static_cast<std::size_t>(
          std::max(0.0F, group->values[static_cast<std::size_t>(shot.ends[2 * l])])));
  std::vector<std::string> names;
  for (const std::size_t g : found)
    if (g < shot.groups.size()) names.push_back(shot.groups[g]);
  return names.empty() ? "" : " in " + listed(names);
}

/// How much of its strength a shot uses, where it does so most.
struct Use {
  double share = 0.0, time = 0.0;
  Vec3 place{};
  std::string material;
};

/// Stresses of triangles or tetrahedra.
class Stresses {
 public:
  explicit Stresses(const Shot& shot) : solid_(shot.solid) {
    for (const char* part :
         {"stress_xx", "stress_yy", "stress_xy", "stress_zz", "stress_yz", "stress_xz"})
      parts_.push_back(field_named(shot.element_fields, part));
  }
  bool known() const {
    const auto end = parts_.begin() + (solid_ ? 6 : 3);
    return std::find(parts_.begin(), end, nullptr) == end;
  }
  /// The largest principal one, in the plane of triangles.
  double largest(std::size_t element) const {
    const auto part = [&](std::size_t k) {
      return static_cast<double>(parts_[k]->values[element]);
    };
    if (solid_)
      return principal_values({part(0), part(1), part(3), part(4), part(5), part(2)}).front();
    return 0.5 * (part(0) + part(1)) + std::hypot(0.5 * (part(0) - part(1)), part(2));
  }

 private:
  bool solid_;
  std::vector<const FrameField*> parts_;
};

/// Largest principal stress over the joints' tensile strength.
void judge_bodies(const Record& record, const Shot& shot, Use& use) {
  const Stresses stresses(shot);
  const FrameField* const material = field_named(shot.element_fields, "material");
  if (!stresses.known() || material == nullptr) return;
  const std::size_t each = shot.corners_of_element();
  for (std::size_t t = 0; t < shot.elements(); ++t) {
    const auto m = static_cast<std::size_t>(std::max(0.0F, material->values[t]));
    if (m >= record.scene.strengths.size()) continue;
    const Strength& strength = record.scene.strengths[m];
    if (!strength.breaks || !(strength.tension > 0.0)) continue;
    const double stress = stresses.largest(t);
    if (stress / strength.tension <= use.share) continue;
    Vec3 middle{};
    for (std::size_t k = 0; k < each; ++k)
      middle += (1.0 / static_cast<double>(each)) * shot.corner[each * t + k];
    use = {stress / strength.tension, shot.time, middle, strength.material};
  }
}

/// Force of stretched links between elements of one material over its tensile strength.
void judge_links(const Record& record, const Shot& first, const Shot& shot, Use& use) {
  const FrameField* const force = field_named(shot.line_fields, "force");
  const FrameField* const kind = field_named(shot.line_fields, "kind");
  const FrameField* const group = field_named(shot.element_fields, "group");
  if (force == nullptr || kind == nullptr || group == nullptr || shot.ends != first.ends) return;
  std::vector<const Strength*> of_group(shot.groups.size(), nullptr);
  for (std::size_t g = 0; g < shot.groups.size(); ++g) {
    const auto material = record.scene.materials.find(shot.groups[g]);
    for (const Strength& strength : record.scene.strengths)
      if (material != record.scene.materials.end() && strength.material == material->second &&
          strength.breaks && strength.tension > 0.0)
        of_group[g] = &strength;
  }
  for (std::size_t l = 0; l < shot.lines(); ++l) {
    if (kind->values[l] != 0.0F) continue;  // concrete alone
    const auto a = static_cast<std::size_t>(shot.ends[2 * l]);
    const auto b = static_cast<std::size_t>(shot.ends[2 * l + 1]);
    const auto g = static_cast<std::size_t>(std::max(0.0F, group->values[a]));
    if (g >= of_group.size() || of_group[g] == nullptr || group->values[a] != group->values[b])
      continue;
    if (norm(shot.corner[b] - shot.corner[a]) <= norm(first.corner[b] - first.corner[a])) continue;
    const double r = std::min(shot.radius[a], shot.radius[b]);
    if (!(r > 0.0)) continue;  // a stage has taken its body out
    const double share = force->values[l] / (of_group[g]->tension * pi * r * r);
    if (share > use.share) use = {share, shot.time, shot.middle(l), of_group[g]->material};
  }
}

/// The sentences of one run.
class Findings {
 public:
  explicit Findings(const Record& record) : record_(record) {
    const std::optional<double> links = record.number("fracture.broken_links");
    broken_ = links ? links : record.number("fracture.broken_joints");
    what_ = links ? "link" : "joint";
    all_ = record.number(links ? "model.links" : "model.joints").value_or(0.0);
    if (!record.times.empty()) first_ = read(0);
    if (!links || !first_ || first_->time > 0.0) return;
    parted_ = broken_lines(*first_);
    cut_ = static_cast<double>(std::count(parted_.begin(), parted_.end(), 1));
    all_ -= cut_;
    if (broken_) *broken_ -= cut_;
  }

  std::vector<std::string> sentences() {
    std::vector<std::string> all;
    if (all_ <= 0.0 && record_.number("model.elements").value_or(0.0) <= 0.0 &&
        record_.number("model.triangles").value_or(0.0) <= 0.0 &&
        record_.number("model.tetrahedra").value_or(0.0) <= 0.0)
      all.emplace_back();  // the summary tells too little
    else if (all_ <= 0.0)
      all.push_back("Nothing can break here: the model has no links or joints.");
    else if (!broken_ || *broken_ == 0.0)
      all = {unbroken(), cut(), nearness()};
    else
      all = {when(), cut(), where()};
    all.push_back(load());
    std::erase(all, "");
    return all;
  }

 private:
  Shot read(std::size_t frame) const { return read_shot(record_.folder, static_cast<int>(frame)); }

  std::string cut() const {
    if (cut_ == 0.0) return "";
    return fmt::format("Besides, {} parted by cuts before the start.",
                       count_of(cut_, what_) + (cut_ == 1.0 ? " was" : " were"));
  }

  /// Lines of a kind that cuts have parted. Links of steel, interfaces and facets are never cut so.
  double cut_of(const std::string& kind) const {
    const FrameField* const kinds = cut_ > 0.0 ? field_named(first_->line_fields, "kind") : nullptr;
    const float number = kind == "concrete" ? 0.0F : kind == "parallel" ? 3.0F : -1.0F;
    double count = 0.0;
    for (std::size_t l = 0; kinds != nullptr && l < parted_.size(); ++l)
      if (parted_[l] != 0 && kinds->values[l] == number) count += 1.0;
    return count;
  }

  /// Lines that have broken since the start.
  std::vector<std::uint8_t> broken_since_start(const Shot& shot) const {
    std::vector<std::uint8_t> broken = broken_lines(shot);
    if (cut_ > 0.0 && shot.ends == first_->ends)
      for (std::size_t l = 0; l < broken.size(); ++l)
        if (parted_[l] != 0) broken[l] = 0;
    return broken;
  }

  std::string unbroken() {
    const double fracture = record_.number("energy.fracture").value_or(0.0);
    if (!(fracture > 0.0))
      return fmt::format("Nothing broke: all {} are whole and none has softened.",
                         count_of(all_, what_));
    const std::string spent = value_text(fracture, energy_unit());
    if (!find_softened())
      return fmt::format("Nothing broke to its end, though {} went into softening of some of {}.",
                         spent, count_of(all_, what_));
    return fmt::format(
        "A crack has begun that parts nothing yet: of {}, none broke to its end, but {} went into "
        "softening, and those around {} have lost {} of what they bear, on the mean.",
        count_of(all_, what_), spent, place_text(softened_at_, first_->plane),
        softened_ < 0.995 ? percent_text(softened_) : "nearly all");
  }

  /// Where spheres stand at the end whose links have lost most. @returns whether that is much
  bool find_softened() {
    constexpr double much = 0.5;
    if (!first_ || !first_->spheres() || cut_ > 0.0) return false;
    const Shot last = read(record_.times.size() - 1);
    const FrameField* const damage = field_named(last.element_fields, "damage");
    if (damage == nullptr) return false;
    for (std::size_t e = 0; e < last.elements(); ++e)
      if (last.radius[e] > 0.0 && damage->values[e] > softened_) {
        softened_ = damage->values[e];
        softened_at_ = last.corner[e];
      }
    cracked_ = softened_ >= much;
    return cracked_;
  }

  /// How near to breaking.
  std::string nearness() const {
    if (!first_ || cracked_) return "";
    Use use;
    const std::size_t frames = record_.times.size(), looks = std::min<std::size_t>(frames, 9);
    for (std::size_t k = 1; k <= looks; ++k) {
      const Shot shot = read(k * (frames - 1) / looks);
      if (!shot.spheres())
        judge_bodies(record_, shot, use);
      else
        judge_links(record_, *first_, shot, use);
    }
    if (!(use.share > 0.01)) return "";
    std::string text = fmt::format(
        "The highest tension in the frames that were looked at is {:.2g} of the strength of {}, "
        "near {} at {}",
        use.share, use.material, place_text(use.place, first_->plane), time_text(use.time));
    if (use.share < 1.0)
      text += fmt::format(": if all grows in proportion, {:.2g} times the load begins to break it",
                          1.0 / use.share);
    else if (record_.number("energy.fracture").value_or(0.0) > 0.0)
      text += ": it softens there, and a little more breaks it";
    else if (first_->spheres())
      text += ", and yet no link has softened: those there bear more than the others";
    else
      text +=
          " in the direction that is pulled most, and yet nothing softens: no joint lies across "
          "it. A finer mesh has joints in more directions";
    return text + ".";
  }

  std::string when() {
    std::string text = fmt::format("{} of {} broke ({})", count_text(*broken_),
                                   count_of(all_, what_), percent_text(*broken_ / all_));
    std::vector<std::string> kinds;
    const std::string list = "fracture.broken_by_kind.";
    for (auto kind = record_.numbers.lower_bound(list);
         kind != record_.numbers.end() && kind->first.starts_with(list); ++kind)
      if (const std::string name = kind->first.substr(list.size()); kind->second > cut_of(name))
        kinds.push_back(fmt::format("{} of {}", count_text(kind->second - cut_of(name)), name));
    if (kinds.size() > 1) text += ": " + listed(kinds);
    const std::optional<Softening> softening = first_softening();
    const std::vector<Break>& breaks = record_.breaks;
    // Of no news where rows are so far apart that the first had broken by then.
    if (softening && (breaks.empty() || softening->by < breaks.front().time))
      text += fmt::format("; softening began by {}", time_text(softening->by));
    if (!breaks.empty()) {
      // Rows of the history tell when links broke, each joint tells its own time.
      const char* const when = record_.cracks.columns.empty() ? "by" : "at";
      text +=
          fmt::format("{} the first broke {} {}", glue(text), when, time_text(breaks.front().time));
      if (breaks.size() > 1)
        text +=
            fmt::format(", half of them by {}", time_text(breaks[(breaks.size() - 1) / 2].time));
    } else if (find_first_break() && break_frame_ > 0) {
      // Frames may be far apart; what softens late breaks later.
      const double end = record_.times[break_frame_], before = record_.times[break_frame_ - 1];
      const double after =
          softening && softening->after < end ? std::max(before, softening->after) : before;
      text += fmt::format("{} the first broke between {} and {}", glue(text), time_text(after),
                          time_text(end));
    }
    return text + ".";
  }

  /// Separator of a sentence and one more fact.
  static const char* glue(const std::string& text) {
    return text.find(';') == std::string::npos ? ";" : ",";
  }

  /// Times of the first row of the history with work of fracture, and of the row before.  [s]
  struct Softening {
    double after, by;
  };
  std::optional<Softening> first_softening() const {
    const Column* const time = record_.history.column("time");
    const Column* const spent = record_.history.column("fracture");
    if (time == nullptr || spent == nullptr) return std::nullopt;
    for (std::size_t i = 0; i < spent->values.size(); ++i)
      if (spent->values[i] > 1e-6 * spent->values.back())
        return Softening{time->values[i > 0 ? i - 1 : 0], time->values[i]};
    return std::nullopt;
  }

  std::string where() {
    std::string text;
    const Column *x = record_.cracks.column("x0"), *y = record_.cracks.column("y0");
    const Column *x1 = record_.cracks.column("x1"), *y1 = record_.cracks.column("y1");
    if (x != nullptr && y != nullptr && x1 != nullptr && y1 != nullptr && !x->values.empty()) {
      const Vec3 start{0.5 * (x->values[0] + x1->values[0]), 0.5 * (y->values[0] + y1->values[0]),
                       0.0};
      text = "It began at " + place_text(start, true);
    } else if (find_first_break()) {
      const Shot shot = read(break_frame_);
      std::vector<std::uint8_t> broken = broken_since_start(shot);
      leave_first(record_, shot, broken);
      text = "It began around " + place_text(middle_of(shot, broken), shot.plane) +
             bodies_of(shot, broken);
    }
    const std::string mode = mode_text();
    if (!mode.empty() && text.empty())  // "and took ..." goes without the verb
      text = mode.starts_with("and ") ? "It " + mode.substr(4) : "It was " + mode;
    else if (!mode.empty())
      text += ", " + mode;
    const auto pieces = record_.number("fracture.fragments");
    if (pieces && *pieces > 1.0)
      text += fmt::format(
          "{} {} pieces are left, whole bodies among them, the largest with {} of all mass",
          text.empty() ? "" : ";", count_text(*pieces),
          percent_text(record_.number("fracture.largest_fragment_fraction").value_or(1.0)));
    if (text.starts_with("  ")) text.erase(0, 2);
    const std::string heard = emission_text();
    if (text.empty()) return heard;
    return text + "." + (heard.empty() ? "" : " ") + heard;
  }

  std::string emission_text() const {
    const auto events = record_.number("emission.events");
    const auto largest = record_.number("emission.largest_magnitude");
    if (!events || !largest) return "";
    std::string text =
        fmt::format("Acoustic emission: {}, of {} {:.2g}", count_of(*events, "event"),
                    *events == 1.0 ? "magnitude" : "magnitudes up to", *largest);
    if (const auto b = record_.number("emission.b_value"))
      text += fmt::format(", b = {:.2f} ± {:.2f}", *b,
                          record_.number("emission.b_deviation").value_or(0.0));
    else
      text += "; no b value, as fewer than 20 are at or above the magnitude that most have";
    return text + ".";
  }

  std::string mode_text() const {
    const double open = record_.number("fracture.energy_by_mode.opening").value_or(0.0);
    const double slide = record_.number("fracture.energy_by_mode.sliding").value_or(0.0);
    if (open + slide > 0.0)
      return open >= slide ? fmt::format("by opening ({} of the fracture energy)",
                                         percent_text(open / (open + slide)))
                           : fmt::format("by sliding ({} of the fracture energy)",
                                         percent_text(slide / (open + slide)));
    const double fracture = record_.number("energy.fracture").value_or(0.0);
    if (fracture <= 0.0) return "";
    std::vector<std::string> others;
    const bool bars = record_.number("model.links_by_kind.steel").value_or(0.0) > 0.0;
    for (const auto& [column, words] :
         {std::pair{"plastic", bars ? "in yielding bars and plastic slip" : "of plastic slip"},
          std::pair{"friction", "of friction"}}) {
      const double spent = record_.number(std::string("energy.") + column).value_or(0.0);
      if (spent > 1e-9 * fracture) others.push_back(value_text(spent, energy_unit()) + " " + words);
    }
    return fmt::format(
        "and took {} in cracks{}", value_text(fracture, energy_unit()),
        others.empty() ? "" : fmt::format(" besides {}", fmt::join(others, " and ")));
  }

  /// The largest force that a probe read, and what of it is left.
  std::string load() const {
    const Column* best = nullptr;
    const Column* const time = record_.history.column("time");
    double peak = 0.0;
    std::size_t row = 0;
    for (const Column& column : record_.history.columns) {
      if (column.unit != "N" && column.unit != "N/m") continue;
      for (std::size_t i = 0; i < column.values.size(); ++i) {
        if (!(std::abs(column.values[i]) > std::abs(peak))) continue;
        best = &column;
        peak = column.values[i];
        row = i;
      }
    }
    if (best == nullptr || time == nullptr) return "";
    const double share = best->values.back() / peak;
    std::string text = fmt::format("{} was {} at its strongest, at {}", best->name,
                                   value_text(peak, best->unit), time_text(time->values[row]));
    if (const auto beside = if_alone(best->values, row))
      text += fmt::format(
          ", in one row alone ({} in those beside it; a probe with lag follows the mean of blows)",
          value_text(*beside, best->unit));
    if (row + 1 == best->values.size())
      text += ", at the end of the run: it may have risen further";
    else if (share < 0.0005)
      text += "; nothing of it is left at the end";
    else
      text += fmt::format("; {} of it is left at the end", percent_text(share));
    return text + ".";
  }

  /// Of many values the larger one of those beside this one, if it is less than half of this one:
  /// corners that hit each other press on the stiffness of contact for a moment.
  static std::optional<double> if_alone(const std::vector<double>& values, std::size_t row) {
    if (values.size() < 20 || row == 0 || row + 1 == values.size()) return std::nullopt;
    const double beside = std::max(std::abs(values[row - 1]), std::abs(values[row + 1]));
    return beside < 0.5 * std::abs(values[row]) ? std::optional(beside) : std::nullopt;
  }

  /// The first frame with broken lines, by bisection: lines do not heal.
  bool find_first_break() {
    if (looked_for_break_) return break_frame_ < record_.times.size();
    looked_for_break_ = true;
    const auto breaks = [&](std::size_t frame) {
      const std::vector<std::uint8_t> broken = broken_since_start(read(frame));
      return std::find(broken.begin(), broken.end(), 1) != broken.end();
    };
    std::size_t low = 0, high = record_.times.size();
    break_frame_ = high;
    if (high == 0 || !breaks(high - 1)) return false;
    --high;
    while (low < high) {
      const std::size_t middle = (low + high) / 2;
      if (breaks(middle))
        high = middle;
      else
        low = middle + 1;
    }
    break_frame_ = low;
    return true;
  }

  std::string energy_unit() const {
    const Column* const kinetic = record_.history.column("kinetic");
    return kinetic == nullptr ? "J" : kinetic->unit;
  }

  const Record& record_;
  std::optional<double> broken_;
  double all_ = 0.0;
  std::vector<std::uint8_t> parted_;  ///< lines that are broken at the start; cut_: how many
  double cut_ = 0.0;
  bool cracked_ = false;   ///< links have softened much, and none has broken
  double softened_ = 0.0;  ///< what those of the element have lost at the end that lost most  [-]
  Vec3 softened_at_;       ///< where it is  [m]
  std::string what_;
  std::optional<Shot> first_;
  bool looked_for_break_ = false;
  std::size_t break_frame_ = 0;
};

}  // namespace

std::vector<std::string> findings_of(const Record& record) {
  return Findings(record).sentences();
}

}  // namespace breccia::report
