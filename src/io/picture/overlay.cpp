#include "io/picture/overlay.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "exec/error.hpp"
#include "io/round_numbers.hpp"

namespace breccia {
namespace {

constexpr Color line_ink{0.10F, 0.11F, 0.13F}, white{1.0F, 1.0F, 1.0F};
constexpr Color pulls{0.80F, 0.14F, 0.12F}, presses{0.07F, 0.55F, 0.87F};
constexpr Color bolt_pulled{0.86F, 0.33F, 0.05F}, bolt_pressed{0.36F, 0.20F, 0.62F};
constexpr Color support{0.05F, 0.45F, 0.42F};
constexpr double cell = 17.0;  ///< of the grid by which marks are thinned  [units of text]

/// Marks by squares of the paper: the sum of each.
template <class Value>
struct Sums {
  struct Sum {
    double u = 0.0, v = 0.0, count = 0.0;
    Value value{};
  };
  double size;
  std::map<std::pair<int, int>, Sum> cells;

  Sum& at(const ScreenPoint& p) {
    return cells[{static_cast<int>(std::floor(p.v / size)),
                  static_cast<int>(std::floor(p.u / size))}];
  }
};

bool is_on(const Paper& paper, const ScreenPoint& p) {
  return p.u >= 0.0 && p.v >= 0.0 && p.u <= paper.width && p.v <= paper.height;
}

double length_of(const float* v) {
  return std::sqrt(1.0 * v[0] * v[0] + 1.0 * v[1] * v[1] + 1.0 * v[2] * v[2]);
}

std::string with_unit(double value, const std::string& unit) {
  const ScaledUnit scaled = scaled_unit(unit, value);
  return fmt::format("{:.3g} {}", scaled.factor * value, scaled.unit);
}

/// The two principal values of a symmetric matrix and the direction of the first.
struct Principal {
  double first, second, along_right, along_up;
};
Principal principal_of(double rr, double uu, double ru) {
  const double mean = 0.5 * (rr + uu), half = 0.5 * (rr - uu);
  const double radius = std::sqrt(half * half + ru * ru);
  // The direction of the larger value: (half + radius, ru), or (ru, radius - half).
  double right = half + radius, up = ru;
  if (half < 0.0) right = ru, up = radius - half;
  const double size = std::sqrt(right * right + up * up);
  return size > 0.0 ? Principal{mean + radius, mean - radius, right / size, up / size}
                    : Principal{mean, mean, 1.0, 0.0};
}

const FrameField* vectors(const Frame& frame, const std::string& name) {
  const FrameField* field = field_of(frame, Carrier::points, name);
  const bool good = field != nullptr && field->components == 3 &&
                    field->values.size() == 3 * frame.position.size();
  return good ? field : nullptr;
}

}  // namespace

Overlay::Overlay(const Frame& frame, const RenderOptions& options, Coloring& coloring)
    : frame_(frame),
      edges_(options.edges),
      crosses_(options.crosses),
      stress_(frame),
      contacts_(coloring.contacts) {
  Legend& legend = coloring.legend;
  if (!options.arrows.empty()) {
    arrows_ = vectors(frame, options.arrows);
    if (arrows_ == nullptr) {
      std::string names;
      for (const FrameField& field : frame.point_fields)
        if (field.components == 3) names += (names.empty() ? "" : ", ") + field.name;
      throw InputError(fmt::format(
          "arrows = \"{}\" is no field of vectors of this frame; it has {}; output.more = "
          "[\"displacement\", \"force\"] adds these",
          options.arrows, names.empty() ? "none" : names));
    }
    for (std::size_t i = 0; i + 2 < arrows_->values.size(); i += 3)
      if (const double length = length_of(&arrows_->values[i]); std::isfinite(length))
        longest_ = std::max(longest_, length);
    legend.notes.push_back(fmt::format("arrows: {}", options.arrows));
    legend.notes.push_back("longest " + with_unit(longest_, arrows_->unit));
  }
  if (options.crosses) {
    if (!stress_.known())
      throw InputError(
          "this frame has no stresses; output.more = [\"stress\"], or output.crosses = true, in "
          "the case adds them");
    for (std::size_t i = 0; i < stress_.count(); ++i) {
      const Sym3 s = stress_.at(i);
      const double zz = stress_.carrier() == Carrier::triangles ? 0.0 : std::fabs(s.zz);
      largest_ = std::max({largest_, std::fabs(s.xx), std::fabs(s.yy), zz});
    }
    legend.swatches.push_back({pulls, "tension"});
    legend.swatches.push_back({presses, "compression"});
    legend.notes.push_back("up to " + with_unit(largest_, stress_.unit()));
  }
  if (!options.walls) return;
  bolts_ = !frame.bars.empty() && options.scale == 1.0;
  if (bolts_) {
    for (const FrameBar& bar : frame.bars)
      if (const double force = std::fabs(1.0 * bar.force); std::isfinite(force))
        strongest_ = std::max(strongest_, force);
    legend.swatches.push_back({bolt_pulled, "bolts, pulled"});
    legend.swatches.push_back({bolt_pressed, "bolts, pressed"});
    legend.notes.push_back("bolts up to " +
                           with_unit(strongest_, places_in(frame).plane() ? "N/m" : "N"));
  }
  held_ = field_of(frame, Carrier::points, "held");
  if (held_ != nullptr &&
      std::none_of(held_->values.begin(), held_->values.end(), [](float h) { return h > 0.0F; }))
    held_ = nullptr;
  if (held_ != nullptr) legend.swatches.push_back({support, "held"});
}

std::vector<Vec3> Overlay::places_of_stress() const {
  const bool solid = !frame_.tetrahedra.empty();
  const std::vector<std::int32_t>& corners = solid ? frame_.tetrahedra : frame_.triangles;
  if (corners.empty()) return frame_.position;
  const std::size_t each = solid ? 4 : 3;
  std::vector<Vec3> places(corners.size() / each);
  for (std::size_t k = 0; k < corners.size(); ++k)
    places[k / each] +=
        (1.0 / static_cast<double>(each)) * frame_.position[static_cast<std::size_t>(corners[k])];
  return places;
}

void Overlay::draw_arrows(Paper& paper, const OnPaper& on, int scale) const {
  struct Mean {
    double u = 0.0, v = 0.0;  ///< to the right and down
  };
  Sums<Mean> sums{cell * scale, {}};
  const Axes& axes = on.camera.axes;
  for (std::size_t i = 0; i < frame_.position.size(); ++i) {
    const ScreenPoint p = on.camera.project(frame_.position[i]);
    const float* const value = &arrows_->values[3 * i];
    if (!is_on(paper, p) || !std::isfinite(length_of(value)) || !on.shows(i)) continue;
    const Vec3 v{value[0], value[1], value[2]};
    auto& sum = sums.at(p);
    sum.u += p.u, sum.v += p.v, sum.count += 1.0;
    sum.value.u += dot(v, axes.right);
    sum.value.v -= dot(v, axes.up);
  }
  if (!(longest_ > 0.0)) return;
  const double unit = 2.2 * cell * scale / longest_;
  const auto each = [&](const auto& draw) {
    for (const auto& [place, sum] : sums.cells) {
      const double u = sum.u / sum.count, v = sum.v / sum.count;
      const double du = unit * sum.value.u / sum.count, dv = unit * sum.value.v / sum.count;
      const double length = std::hypot(du, dv);
      if (length > 1.5 * scale) draw(u, v, du, dv, length);
    }
  };
  for (const auto& [thick, color] : {std::pair{2.4, white}, std::pair{1.1, line_ink}})
    each(
        [&, thick = thick, color = color](double u, double v, double du, double dv, double length) {
          const double head = std::min(4.0 * scale, 0.5 * length) / length;
          const double end_u = u + du, end_v = v + dv;
          paper.stroke(u, v, end_u, end_v, thick * scale, color);
          for (const double side : {-0.5, 0.5})
            paper.stroke(end_u, end_v, end_u - head * (du + side * dv),
                         end_v - head * (dv - side * du), thick * scale, color);
        });
}

bool Overlay::shows_item(const OnPaper& on, std::size_t item) const {
  if (!frame_.tetrahedra.empty()) return on.shows_solid(item);
  return on.shows(frame_.triangles.empty() ? item
                                           : static_cast<std::size_t>(frame_.triangles[3 * item]));
}

void Overlay::draw_contacts(Paper& paper, const OnPaper& on, int scale) const {
  constexpr double thin = 0.3, wide = 3.2;
  for (const ContactLook& look : contacts_) {
    const FrameContact& contact = frame_.contacts[look.contact];
    if (on.keeps && !on.keeps(0.5 * (contact.at_a + contact.at_b))) continue;
    const ScreenPoint a = on.camera.project(contact.at_a), b = on.camera.project(contact.at_b);
    if (is_on(paper, a) || is_on(paper, b))
      paper.stroke(a.u, a.v, b.u, b.v, (thin + wide * look.width) * scale, look.color);
  }
}

void Overlay::draw_bolts(Paper& paper, const OnPaper& on, int scale) const {
  constexpr double thin = 1.0, wide = 2.6;
  for (const bool halo : {true, false})
    for (const FrameBar& bar : frame_.bars) {
      if (on.keeps && !on.keeps(0.5 * (bar.begin + bar.end))) continue;
      const ScreenPoint a = on.camera.project(bar.begin), b = on.camera.project(bar.end);
      if (!is_on(paper, a) && !is_on(paper, b)) continue;
      const double share = strongest_ > 0.0 ? std::fabs(1.0 * bar.force) / strongest_ : 0.0;
      const double thick = thin + wide * (std::isfinite(share) ? share : 0.0) + (halo ? 1.4 : 0.0);
      const Color color = halo ? white : bar.force < 0.0F ? bolt_pressed : bolt_pulled;
      paper.stroke(a.u, a.v, b.u, b.v, thick * scale, color);
    }
}

void Overlay::draw_crosses(Paper& paper, const OnPaper& on, int scale) const {
  struct Mean {
    double rr = 0.0, uu = 0.0, ru = 0.0;
  };
  Sums<Mean> sums{1.3 * cell * scale, {}};
  const Axes& axes = on.camera.axes;
  const std::vector<Vec3> places = places_of_stress();
  const auto on_axes = [](const Sym3& s, const Vec3& a, const Vec3& b) { return dot(a, s * b); };
  for (std::size_t i = 0; i < places.size(); ++i) {
    const ScreenPoint p = on.camera.project(places[i]);
    if (!is_on(paper, p)) continue;
    const Sym3 s = stress_.at(i);
    if (!shows_item(on, i) || !std::isfinite(s.xx + s.yy + s.zz + s.xy + s.yz + s.xz)) continue;
    auto& sum = sums.at(p);
    sum.u += p.u, sum.v += p.v, sum.count += 1.0;
    sum.value.rr += on_axes(s, axes.right, axes.right);
    sum.value.uu += on_axes(s, axes.up, axes.up);
    sum.value.ru += on_axes(s, axes.right, axes.up);
  }
  struct Cross {
    double u, v;
    Principal p;
  };
  std::vector<Cross> crosses;
  std::vector<double> sizes;
  for (const auto& [place, sum] : sums.cells) {
    const double n = sum.count;
    crosses.push_back(
        {sum.u / n, sum.v / n, principal_of(sum.value.rr / n, sum.value.uu / n, sum.value.ru / n)});
    sizes.push_back(
        std::max(std::fabs(crosses.back().p.first), std::fabs(crosses.back().p.second)));
  }
  if (sizes.empty()) return;
  // The largest in fifty may stick out: those beside a load dwarf the others.
  const auto nearly_all = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() * 49 / 50);
  std::nth_element(sizes.begin(), nearly_all, sizes.end());
  if (!(*nearly_all > 0.0)) return;
  const double longest = 0.46 * 1.3 * cell * scale, unit = longest / *nearly_all;
  for (const auto& [thick, halo] : {std::pair{2.6, true}, std::pair{1.2, false}})
    for (const Cross& c : crosses) {
      const auto bar = [&, thick = thick, halo = halo](double value, double right, double up) {
        const double half = std::clamp(unit * std::fabs(value), 0.0, 1.5 * longest);
        if (half < 0.6 * scale) return;
        paper.stroke(c.u - half * right, c.v + half * up, c.u + half * right, c.v - half * up,
                     thick * scale,
                     halo          ? white
                     : value > 0.0 ? pulls
                                   : presses);
      };
      bar(c.p.first, c.p.along_right, c.p.along_up);
      bar(c.p.second, -c.p.along_up, c.p.along_right);
    }
}

void Overlay::draw_held(Paper& paper, const OnPaper& on, int scale) const {
  struct None {};
  const bool plane = frame_.radius.empty();
  Sums<None> taken{(plane ? 6.0 : 11.0) * scale, {}};
  for (std::size_t i = 0; i < std::min(frame_.position.size(), held_->values.size()); ++i) {
    const ScreenPoint p = on.camera.project(frame_.position[i]);
    if (!(held_->values[i] > 0.0F) || !is_on(paper, p) || !on.shows(i)) continue;
    auto& mark = taken.at(p);
    if (mark.count > 0.0) continue;
    mark.count = 1.0;
    mark.u = p.u, mark.v = p.v;
  }
  for (const auto& [place, mark] : taken.cells) {
    paper.stroke(mark.u, mark.v, mark.u, mark.v, (plane ? 4.6 : 3.6) * scale, white);
    paper.stroke(mark.u, mark.v, mark.u, mark.v, (plane ? 3.4 : 2.6) * scale, support);
  }
}

void Overlay::draw_edges(Paper& paper, const OnPaper& on, int scale) const {
  constexpr Color gray{0.45F, 0.46F, 0.48F};
  if (!frame_.tetrahedra.empty()) return;  // theirs are drawn on the surface
  for (std::size_t t = 0; t + 2 < frame_.triangles.size(); t += 3)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto corner = [&](std::size_t c) {
        return on.camera.project(
            frame_.position[static_cast<std::size_t>(frame_.triangles[t + c % 3])]);
      };
      const ScreenPoint a = corner(k), b = corner(k + 1);
      if (is_on(paper, a) || is_on(paper, b)) paper.stroke(a.u, a.v, b.u, b.v, 0.25 * scale, gray);
    }
}

void Overlay::draw(Paper& paper, const OnPaper& on, int scale) const {
  if (edges_) draw_edges(paper, on, scale);
  draw_contacts(paper, on, scale);
  if (bolts_) draw_bolts(paper, on, scale);
  if (held_ != nullptr) draw_held(paper, on, scale);
  if (crosses_) draw_crosses(paper, on, scale);
  if (arrows_ != nullptr) draw_arrows(paper, on, scale);
}

}  // namespace breccia
