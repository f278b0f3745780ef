#pragma once
// From the case's macroscopic materials to the constants of laws.

#include <optional>

#include "dem/laws/contact.hpp"
#include "dem/laws/interface_link.hpp"
#include "dem/laws/ldpm_facet.hpp"
#include "dem/laws/parallel_bond.hpp"
#include "dem/laws/steel_link.hpp"
#include "dem/setup/config.hpp"
#include "dem/setup/model.hpp"

namespace breccia::dem {

/// Macro-micro relation (docs/theory.md, elastic constants): K_n = modulus S / D_0, K_t = ratio
/// K_n.
struct LocalElasticity {
  double modulus;  ///< E (1 + alpha) / (beta (1 + nu) + gamma (1 - alpha nu))  [Pa]
  double ratio;    ///< (1 - alpha nu) / (1 + nu), not below 0  [-]
};
LocalElasticity local_elasticity(const MaterialConfig& material);
/// Of two materials: harmonic means of E and nu, the constants alpha, beta, gamma of the first.
LocalElasticity local_elasticity(const MaterialConfig& a, const MaterialConfig& b);

/// Kind of links that join the elements of a body of this law, pair by pair; nothing: no links, or
/// bars.
std::optional<LinkKind> kind_within(const std::string& law);
/// Words of such laws, for a message: "concrete, ...  or ".
std::string laws_within();

/// Strength and stiffness of a concrete link or parallel bond over those of one along the bedding,
/// by the direction in which it lies in a model: 1 - (1 - share) cos^2 of its angle with the
/// normal.  [-]
struct BeddingShare {
  double strength = 1.0, stiffness = 1.0;
};
BeddingShare bedding_share(const Model& model, const Model::Link& link,
                           const MaterialConfig& material);

/// S, and K_n with the bedding of its material, of a concrete link of a model.  [m2], [N/m]
double link_section(const Model& model, const Model::Link& link);
double link_stiffness(const Model& model, const Model::Link& link, const MaterialConfig& material);

/// Tensile strength over strain rate; of "none" with the exponent 0.
RateCurve rate_curve(const MaterialConfig& material);
/// With the share 0 where links are not damped.
DampingBranch damping_branch(const MaterialConfig& material);
/// The bend of the falling branch; none of a straight one.
SofteningKnee softening_knee(const MaterialConfig& material);
ConcreteLink concrete_law(const MaterialConfig& material, const ContactConfig& contact);
SteelLink steel_law(const MaterialConfig& material);
InterfaceLink interface_law(const MaterialConfig& material, const ContactConfig& contact);
ParallelBond parallel_bond(const MaterialConfig& material, const ContactConfig& contact);
/// E_0 and alpha by the affine relation, E_0 = E / (1 - 2 nu), alpha = (1 - 4 nu) / (1 + nu).
LdpmFacet ldpm_facet(const MaterialConfig& material);
ContactLaw contact_law(const ContactConfig& contact);
/// Constants of elements of two materials in contact, and of one with a rigid wall.
ContactPair contact_pair(const ContactConfig& contact, const MaterialConfig& a,
                         const MaterialConfig& b);
ContactPair wall_pair(const ContactConfig& contact, const MaterialConfig& material);

}  // namespace breccia::dem
