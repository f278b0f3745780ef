#pragma once
// Marks over the items of a picture: bolts, arrows, crosses of stress, dots where supports hold.

#include <functional>

#include "io/picture/camera.hpp"
#include "io/picture/field_colors.hpp"
#include "io/picture/paper.hpp"
#include "io/picture/stress_measures.hpp"

namespace breccia {

/// Where the points of a frame lie on the paper, and which of them one sees.
struct OnPaper {
  Camera camera;                                      ///< in pixels of the paper
  std::function<bool(std::size_t)> shows;             ///< a point
  std::function<bool(std::size_t)> shows_solid = {};  ///< a tetrahedron
  std::function<bool(const Vec3&)> keeps = {};        ///< a place that no cut takes away
};

/// Adds to the legend what the marks mean, and gives what draws them.
/// @throws InputError if the frame lacks the field of arrows or stresses (says how to get it)
class Overlay {
 public:
  Overlay(const Frame& frame, const RenderOptions& options, Coloring& coloring);

  /// @param scale  of text
  void draw(Paper& paper, const OnPaper& on, int scale) const;

 private:
  std::vector<Vec3> places_of_stress() const;
  bool shows_item(const OnPaper& on, std::size_t item) const;
  void draw_arrows(Paper& paper, const OnPaper& on, int scale) const;
  void draw_contacts(Paper& paper, const OnPaper& on, int scale) const;
  void draw_crosses(Paper& paper, const OnPaper& on, int scale) const;
  void draw_bolts(Paper& paper, const OnPaper& on, int scale) const;
  void draw_held(Paper& paper, const OnPaper& on, int scale) const;
  void draw_edges(Paper& paper, const OnPaper& on, int scale) const;

  const Frame& frame_;
  const FrameField* arrows_ = nullptr;
  const FrameField* held_ = nullptr;
  bool edges_ = false, crosses_ = false;
  Stresses stress_;
  std::vector<ContactLook> contacts_;
  bool bolts_ = false;
  double strongest_ = 0.0;  ///< force of a bolt  [N; in 2D N/m]
  double longest_ = 0.0;    ///< arrow, in the unit of its field
  double largest_ = 0.0;    ///< principal stress  [Pa]
};

}  // namespace breccia
