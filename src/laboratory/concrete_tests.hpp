#pragma once
// The virtual laboratory of the DEM: small specimens of one material, loaded as a laboratory loads
// them.

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "dem/setup/config.hpp"
#include "io/case/suggestion.hpp"

namespace breccia::laboratory {

/// Material and packing of all specimens.
struct Sample {
  dem::MaterialConfig material;
  dem::ContactConfig contact;
  double size_ratio = 2.0, compactness = 0.56;  ///< of the packing  [-]
  double range = 1.443;                         ///< interaction range  [-]
  double damping = 0.3;  ///< local damping, none of damped links; beams take 0.05 at most  [-]
  /// Of the prism, and of the disc if it is fewest_in_disc or more; the others have as large ones
  /// as the prism.  [-]
  int elements = 1200;
};

/// The problem of a name that no material of a case has; it tells of those that are `tested`.
template <class Materials, class Tested>
std::string no_such_material(const std::string& name, const Materials& materials,
                             const Tested& tested) {
  std::set<std::string> known;
  for (const auto& material : materials)
    if (tested(material)) known.insert(material.name);
  return "the case has no material " + name + suggestion(name, known) + "; nothing was run";
}

/// The material of a case, packed and linked as the first body of it is.
/// @throws InputError if there is no such material, or it is no concrete or rock
Sample sample_of(const dem::Config& config, const std::string& material);

/// The tests that there are; hydrostatic and biaxial are LDPM's alone, those of plates and
/// plane_disc are the FDEM's.
enum class Loading {
  compression,
  platens,
  tension,
  notched_tension,
  brazilian,
  bending,
  triaxial,
  oedometer,
  hydrostatic,
  biaxial,
  plate,
  plane_disc,
  pulled_plate
};

struct SpecimenTest {
  std::string name;   ///< of files
  std::string title;  ///< for people
  Loading loading;
  Vec3 size;              ///< edges; of the disc: diameter, diameter, thickness  [m]
  double pressure = 0.0;  ///< on the sides of a triaxial test  [Pa]
  double notch = 0.0;     ///< depth of a beam's, or of each of a prism's two  [m]
  double apart = 0.0;     ///< of the two lines that press a beam, 0: one in the middle  [m]
  bool asked = false;     ///< run only where it is asked for by name
};

/// compression between smooth ends of prism and cube, and between rough platens of both; direct
/// tension of a plain and of a notched prism; Brazilian; three-point bending of a notched and of a
/// plain beam, and a plain one that two lines press; triaxial compression at seven pressures;
/// compression between sides that stand still (oedometer).
const std::vector<SpecimenTest>& specimen_tests();

/// The tests above, or of law ldpm its own.
std::vector<SpecimenTest> tests_of(const dem::MaterialConfig& material);

/// Fewer spheres in the prism reach into walls before these move: a cube of 400 begins pressed with
/// a third of its strength.
inline constexpr int fewest_between_walls = 600;
/// Elements of a disc at least: with fewer one element or two lie below a strip, and strengths of
/// packings scatter by 15 %.
inline constexpr int fewest_in_disc = 2400;
/// Whether walls load the specimen.
bool has_walls(const SpecimenTest& test);

/// Distance of the beam's supports.  [m]
inline constexpr double beam_span = 0.3;

/// The case of a test. Ends of prisms are layers of elements that move at a constant speed along z
/// and are free across; rough platens are walls with the friction of the contacts.
/// In triaxial tests six smooth walls press on a prism; then the upper and the lower one approach
/// while servos hold the pressure of the others; in the oedometer these stand still.
/// @param folder  gets the file of spheres that a notched beam is made of
/// @throws IoError if that file cannot be written
dem::Config case_of(const SpecimenTest& test, const Sample& sample, std::int64_t seed,
                    const std::string& folder);

}  // namespace breccia::laboratory
