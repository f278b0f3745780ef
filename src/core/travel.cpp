#include "core/travel.hpp"

#include <cmath>
#include <limits>
#include <string>

#include "core/grown_box.hpp"
#include "exec/error.hpp"

namespace breccia {
namespace {

constexpr Index all_finite = std::numeric_limits<Index>::max();

struct ChooseMargin {
  static constexpr const char* name = "core.choose_margin";
  MarginRule rule;
  View<const Vec3> velocity;
  View<double> margin;

  BR_HD void operator()(Index i) const { margin[i] = rule.margin(velocity[i]); }
};

struct LostMargin {
  View<const double> margin;
  BR_HD Index operator()(Index i) const { return std::isfinite(margin[i]) ? all_finite : i; }
};

struct BoxSphere {
  static constexpr const char* name = "core.box_sphere";
  View<const Vec3> centre;
  View<const double> radius, margin;
  View<Box> boxes;
  double farthest;

  BR_HD void operator()(Index i) const {
    boxes[i] = grown_box(centre[i], radius[i], margin[i], farthest);
  }
};

}  // namespace

void begin_travel(const Exec& exec, const MarginRule& rule, const Buffer<Vec3>& position,
                  const Buffer<Vec3>& velocity, Travel& travel) {
  BR_ASSERT(position.size() == velocity.size());
  copy_to(travel.reference, position);
  travel.margin.resize_unfilled(position.size());
  for_each(exec, position.size(), ChooseMargin{rule, velocity.view(), travel.margin.view()});
  const Index lost =
      fold(exec, position.size(), all_finite, LostMargin{travel.margin.view()}, Least{});
  if (lost != all_finite)
    throw NumericsError("the element at place " + std::to_string(lost) +
                        " in memory has a velocity that is not a finite number");
}

void sphere_boxes(const Exec& exec, const Buffer<Vec3>& centre, const Buffer<double>& radius,
                  const Buffer<double>& margin, Buffer<Box>& boxes, double farthest) {
  BR_ASSERT(centre.size() == radius.size() && centre.size() == margin.size());
  boxes.resize_unfilled(centre.size());
  for_each(exec, centre.size(),
           BoxSphere{centre.view(), radius.view(), margin.view(), boxes.view(), farthest});
}

}  // namespace breccia
