#pragma once
// How stiff packed bodies are: sections of links that make up for missing neighbours, and Young's
// modulus as it is measured.

#include <array>
#include <functional>
#include <string>

#include "dem/setup/config.hpp"
#include "dem/setup/model.hpp"

namespace breccia::prepare {

/// Young's modulus and Poisson's ratio of a body  [Pa, -]
struct Elasticity {
  double young = 0.0, poisson = 0.0;
};

/// Elasticity of a box or cylinder whose ends are pulled apart (docs/theory.md, fabric): the
/// longest edge of a box, the axis of a cylinder; sides are free, moments act, links are intact. E
/// is the force at the ends over section and strain of the middle half. No bars.
Elasticity measured_elasticity(const dem::Model& model, const dem::Config& config, int body,
                               int threads = 1);

/// Of any body, to 7 %: that of links that all follow one strain (Voigt), times a constant.
Elasticity estimated_elasticity(const dem::Model& model, const dem::Config& config, int body);

/// Measures the bodies of concrete (Model::stiffness): boxes and cylinders of up to 20,000 elements
/// always, others where their material has stiffness = "measured"; it then sets the factors on the
/// stiffness of their links, too. Sets the sections and strengths of links (Model::Link::share,
/// ::strength) of bodies whose material has fabric = "even" or "faces".
void set_stiffness(dem::Model& model, const dem::Config& config, int threads = 1);

/// From a point, relative to a body's centre, to its nearest faces, in directions across each
/// other; any length above `reach` where there is none nearer: depths(point, reach)  [m]
using DepthsOf = std::function<std::array<double, 3>(const Vec3&, double)>;

/// Sets the sections and strengths of a body's links anew, as a fabric of that name asks for a body
/// of these faces.
void even_out(dem::Model& model, int body, const Vec3& center, const std::string& fabric,
              const DepthsOf& depths);

}  // namespace breccia::prepare
