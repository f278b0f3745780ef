#pragma once
// The case file of the DEM: every key of a material with its unit, range and meaning.

#include <string>

#include "core/keys.hpp"
#include "math/vec.hpp"

namespace breccia::dem {

/// [material.<name>.ldpm]: the facet law of LDPM (docs/theory-ldpm.md), besides young, poisson,
/// tensile_strength s_t and cohesion s_s of the material
struct LdpmConfig {
  double tensile_length = 0.5;       ///< l_t  [m]
  double softening_exponent = 0.4;   ///< n_t  [-]
  double unloading = 0.0;            ///< k_t  [-]
  double collapse_strength = 150e6;  ///< s_c0  [Pa]
  double hardening = 0.4;            ///< H_c0 / E_0  [-]
  double final_hardening = 0.1;      ///< H_c1 / E_0  [-]
  double compaction_strain = 4.0;    ///< k_c0  [-]
  double deviatoric_start = 1.0;     ///< k_c1  [-]
  double deviatoric_slope = 5.0;     ///< k_c2  [-]
  double friction = 0.4;             ///< mu_0  [-]
  double final_friction = 0.0;       ///< mu_inf  [-]
  double friction_stress = 600e6;    ///< s_N0  [Pa]
  double densification = 1.0;        ///< E_d / E_0  [-]
  double rate_factor = 0.0;          ///< c_1; 0: strengths do not depend on rate  [-]
  double rate_reference = 1e-5;      ///< c_0  [1/s]

  template <class Visit>
  void each_key(Visit&& key) {
    key("tensile_length", tensile_length, "m", positive,
        "l_t = 2 E_0 G_t / s_t^2 of the fracture energy G_t; longer than every edge");
    key("softening_exponent", softening_exponent, "-", not_negative,
        "n_t, how soon softening ends between tension and shear");
    key("unloading", unloading, "-", Range{0.0, 1.0, Open::high},
        "k_t, share of the largest strain at which a closed crack bears tension again");
    key("collapse_strength", collapse_strength, "Pa", positive,
        "s_c0, compressive stress at which pores begin to collapse");
    key("hardening", hardening, "-", not_negative,
        "H_c0 / E_0, hardening in hydrostatic compression");
    key("final_hardening", final_hardening, "-", not_negative,
        "H_c1 / E_0, hardening far from hydrostatic compression");
    key("compaction_strain", compaction_strain, "-", Range{1.0, no_limit},
        "k_c0, strain at which compaction begins, over s_c0 / E_0");
    key("deviatoric_start", deviatoric_start, "-", not_negative,
        "k_c1, ratio of deviatoric to volumetric strain up to which H_c0 holds");
    key("deviatoric_slope", deviatoric_slope, "-", not_negative,
        "k_c2, how soon hardening falls with that ratio");
    key("friction", friction, "-", Range{0.0, 1e3}, "mu_0, friction at low pressure");
    key("final_friction", final_friction, "-", Range{0.0, 1e3},
        "mu_inf, friction at high pressure");
    key("friction_stress", friction_stress, "Pa", positive,
        "s_N0, pressure over which friction falls from one to the other");
    key("densification", densification, "-", positive,
        "E_d / E_0, stiffness in unloading from beyond s_c0 over the elastic one");
    key("rate_factor", rate_factor, "-", Range{0.0, 1.0},
        "c_1: strengths in tension and shear grow to 1 + c_1 asinh(strain rate / c_0) times "
        "themselves; published: 0.05; 0: they do not");
    key("rate_reference", rate_reference, "1/s", positive, "c_0, strain rate of slow tests");
  }
};

/// [material.<name>.mix]: a mix design, of which LDPM places the coarse grains
struct MixConfig {
  double cement = 315.0;           ///< c  [kg/m3]
  double water_ratio = 0.5;        ///< w/c  [-]
  double aggregate_ratio = 0.0;    ///< a/c; 0: by cement  [-]
  double cement_density = 3150.0;  ///<  [kg/m3]
  double air = 0.03;               ///<  [-]
  double smallest = 6e-3;          ///< d_0  [m]
  double largest = 12e-3;          ///< d_a  [m]
  double fuller = 0.5;             ///< n_F  [-]
  std::vector<double> sieves{};    ///< of a grading curve; empty: Fuller's  [m]
  std::vector<double> passing{};   ///< share of the mass that passes each  [-]

  template <class Visit>
  void each_key(Visit&& key) {
    key("cement", cement, "kg/m3", Range{10.0, 1000.0},
        "c, mass of cement over volume of concrete");
    key("water_ratio", water_ratio, "-", Range{0.1, 2.0}, "w/c, water over cement by mass");
    key("aggregate_ratio", aggregate_ratio, "-", not_negative,
        "a/c, aggregate over cement by mass: then c follows from the density of the material; 0: c "
        "is given");
    key("cement_density", cement_density, "kg/m3", Range{1000.0, 6000.0}, "density of cement");
    key("air", air, "-", Range{0.0, 0.5}, "share of the volume that air takes");
    key("smallest", smallest, "m", positive,
        "d_0, diameter of the smallest grains that are placed");
    key("largest", largest, "m", positive, "d_a, diameter of the largest grains");
    key("fuller", fuller, "-", Range{0.1, 2.5}, "n_F, exponent of the sieve curve (d / d_a)^n_F");
    key("sieves", sieves, "m", positive,
        "sizes of sieves, growing, from smallest or below to largest or beyond: a grading curve "
        "instead of Fuller's");
    key("passing", passing, "-", Range{0.0, 1.0},
        "share of the mass of all aggregate that passes each of the sieves, from 0 to 1; linear in "
        "the size in between");
  }
};

/// [material.<name>.bedding]: planes across which links are weaker and softer
struct BeddingConfig {
  Vec3 normal{0.0, 0.0, 1.0};  ///< of the planes, in the case  [-]
  double strength = 1.0;       ///< across the planes over along them  [-]
  double stiffness = 1.0;      ///< likewise  [-]

  bool is_none() const { return strength == 1.0 && stiffness == 1.0; }
  template <class Visit>
  void each_key(Visit&& key) {
    key("normal", normal, "-", any_number, "direction across the planes, in the case");
    key("strength", strength, "-", Range{0.01, 1.0},
        "strengths of links across the planes over those along them; a link at an angle t from the "
        "normal has strength cos^2 t + sin^2 t of them; 1: alike in all directions");
    key("stiffness", stiffness, "-", Range{0.01, 1.0},
        "likewise of the stiffness of links; young and poisson are those of the rock with 1");
  }
};

/// [material.<name>]
struct MaterialConfig {
  std::string name;
  std::string use;
  std::string law = "concrete";
  double density = 2400.0;  ///< of the bulk, voids included  [kg/m3]
  double young = 30e9;      ///< E, macroscopic  [Pa]
  double poisson = 0.2;     ///< nu, macroscopic  [-]
  // concrete (docs/theory.md, cohesive links)
  double tensile_strength = 2.2e6;             ///< T, local  [Pa]
  double cohesion = 5.5e6;                     ///< C, local  [Pa]
  double softening = 5.0;                      ///< zeta: initial over softening stiffness  [-]
  double fracture_energy = 0.0;                ///< G_F, macroscopic; 0: by zeta  [J/m2]
  double knee_strength = 0.0;                  ///< s; 0: softening is one line  [-]
  double knee_opening = 0.02;                  ///< x  [-]
  double friction_angle = 0.5235987755982988;  ///< phi_i of intact links  [rad]
  double rolling_stiffness = 1.0;              ///< beta_r  [-]
  double rolling_limit = 0.17;                 ///< eta  [-]
  double rolling_cap = 0.0;                    ///< s_M; 0: none  [Pa]
  double broken_friction = -1.0;               ///< mu_b; below 0: that of contacts  [-]
  double friction_cap = 0.0;                   ///< s_F; 0: none  [Pa]
  std::string friction_bound = "sharp";
  std::string criterion = "corner";
  double broken_rolling_limit = -1.0;       ///< eta_b; below 0: eta  [-]
  double slip_wear = 0.0, turn_wear = 0.0;  ///< w_s, w_m  [-]
  double compaction_strength = 0.0;         ///< Y_c; 0: none  [Pa]
  double compaction_slope = 0.4;            ///< H_c  [-]
  double crushing_strength = 0.0;           ///< Y_b; 0: none  [Pa]
  double crushing_slope = 0.4;              ///< H_b  [-]
  double closing_strain = 0.0;              ///< p_c; 0: none  [-]
  double link_damping = 0.0;                ///< m; 0: none  [-]
  double link_damping_time = 0.2;           ///< tau over D / c  [-]
  std::string rate = "none";
  double rate_strength = 30e6;                    ///< f_c, static, of malvar_ross  [Pa]
  double rate_crossings = 5.0;                    ///< time constant over D / c  [-]
  double alpha = 3.9, beta = 3.125, gamma = 5.0;  ///< macro-micro constants  [-]
  std::string shear = "plastic";
  // parallel: the strengths and constants above, and
  double bond_radius = 1.0;   ///< lambda: of the bond, over the smaller element's  [-]
  double moment_share = 1.0;  ///< beta of moments in the bond's stresses  [-]
  std::string fabric = "packed", stiffness = "estimated";
  BeddingConfig bedding;  // of concrete and parallel
  // ldpm
  LdpmConfig ldpm;
  MixConfig mix;
  // steel
  double yield = 500e6;          ///< f_y  [Pa]
  double hardening = 1e9;        ///< H  [Pa]
  double failure_strain = 0.08;  ///< plastic strain at rupture  [-]
  // interface (steel to concrete)
  std::string bond = "mc90";
  double bond_strength = 13.7e6;                    ///< tau_max  [Pa]
  double bond_residual = 5.5e6;                     ///< tau_f  [Pa]
  double slip1 = 1e-3, slip2 = 3e-3, slip3 = 8e-3;  ///< s_1, s_2, s_3  [m]
  double rib_height = 0.0;                          ///< h_r, 0: none  [m]

  template <class Visit>
  void each_key(Visit&& key) {
    key("use", use,
        "material of the program whose numbers it has (breccia materials); keys that stand here "
        "take their place; empty: none");
    key("law", law, OneOf{"concrete", "parallel", "ldpm", "steel", "interface", "grain"},
        "concrete: cohesive links; parallel: bonds of cement between grains (bonded-particle "
        "rock); ldpm: particles of the lattice discrete particle model of concrete; "
        "steel: bars; interface: between bars and concrete; grain: contacts only");
    key("density", density, "kg/m3", Range{10.0, 1e6}, "mass per volume of the bulk material");
    key("young", young, "Pa", Range{1e3, 1e13}, "Young's modulus of the bulk material");
    key("poisson", poisson, "-", Range{-1.0, 0.5, Open::both},
        "Poisson's ratio of the bulk material; links need at most 1 / alpha");
    key("tensile_strength", tensile_strength, "Pa", Range{0.0, 1e15},
        "local tensile strength T of a link");
    key("cohesion", cohesion, "Pa", Range{0.0, 1e15}, "local cohesion C of a link");
    key("softening", softening, "-", Range{0.0, 1e9},
        "zeta, initial stiffness over softening stiffness in tension; 0 is brittle");
    key("fracture_energy", fracture_energy, "J/m2", Range{0.0, 1e9},
        "G_F, energy of a crack in tension over its area, which sets how far links open before "
        "they "
        "break, whatever the size of elements; 0: softening sets that");
    key("knee_strength", knee_strength, "-", Range{0.0, 1.0, Open::high},
        "s, stress at which softening in tension bends from steep to flat, over tensile_strength; "
        "0: it is one line");
    key("knee_opening", knee_opening, "-", Range{0.0, 1.0, Open::both},
        "x, opening at that bend over that at which the link breaks, both beyond that of the "
        "peak; s + x below 1");
    key("friction_angle", friction_angle, "rad", Range{0.0, 1.5707, Open::high},
        "internal friction angle of intact links");
    key("rolling_stiffness", rolling_stiffness, "-", Range{0.0, 1e6},
        "beta_r, rolling stiffness over shear stiffness times radius squared; 0 switches moments "
        "off");
    key("rolling_limit", rolling_limit, "-", Range{0.0, 1e6}, "eta, plastic limit of the moments");
    key("rolling_cap", rolling_cap, "Pa", Range{0.0, 1e15},
        "s_M, largest normal stress that the limit of the moments counts; 0: no bound");
    key("broken_friction", broken_friction, "-", Range{-1.0, 1e6},
        "mu_b, friction coefficient of broken links; below 0: contact.friction");
    key("friction_cap", friction_cap, "Pa", Range{0.0, 1e15},
        "s_F, largest shear stress that friction bears in a link, whole or broken; 0: no bound");
    key("friction_bound", friction_bound, OneOf{"sharp", "smooth"},
        "how friction f nears friction_cap: sharp: it grows with pressure until it is s_F; smooth: "
        "it "
        "is f s_F / (f + s_F), as rough cracks shear off");
    key("criterion", criterion, OneOf{"corner", "hyperbola"},
        "how the shear strength of an intact link ends in tension: corner: a line, cohesion and "
        "friction, is cut off at tensile_strength; hyperbola: a curve that nears that line under "
        "pressure falls to nothing at tensile_strength");
    key("broken_rolling_limit", broken_rolling_limit, "-", Range{-1.0, 1e6},
        "eta_b, plastic limit of the moments of broken links; below 0: rolling_limit");
    key("slip_wear", slip_wear, "-", Range{0.0, 1e6},
        "w_s, opening that a link gains by plastic slip, over that slip; 0: none");
    key("turn_wear", turn_wear, "-", Range{0.0, 1e6},
        "w_m, opening that a link gains by plastic turn, over that turn times the mean radius; 0: "
        "none");
    key("compaction_strength", compaction_strength, "Pa", Range{0.0, 1e15},
        "Y_c, compressive stress at which intact links and broken ones that touch yield; 0: never");
    key("compaction_slope", compaction_slope, "-", Range{0.0, 1.0, Open::high},
        "H_c, stiffness of a link beyond compaction_strength over the elastic one");
    key("crushing_strength", crushing_strength, "Pa", Range{0.0, 1e15},
        "Y_b, compressive stress at which broken links yield until their ends touch; 0: never");
    key("crushing_slope", crushing_slope, "-", Range{0.0, 1.0, Open::high},
        "H_b, stiffness of a link beyond crushing_strength over the elastic one");
    key("closing_strain", closing_strain, "-", Range{0.0, 1.0, Open::high},
        "p_c, share of its length by which compaction and crushing shorten a link until its pores "
        "are closed and it is elastic again; 0: they are never closed");
    key("link_damping", link_damping, "-", Range{0.0, 100.0},
        "m, stiffness of the damping branch of a link (a spring in line with a dashpot) over that "
        "of the link; 0: none");
    key("link_damping_time", link_damping_time, "-", Range{0.01, 100.0},
        "time in which the damping branch relaxes, in crossings of the link by a wave of speed "
        "sqrt(young / density)");
    key("rate", rate, OneOf{"none", "malvar_ross", "mc2010"},
        "how the tensile strength of a link grows with its own strain rate: none; malvar_ross: by "
        "Malvar and Ross 1998; mc2010: by the fib Model Code 2010; a quasi-static test in a few ms "
        "needs none");
    key("rate_strength", rate_strength, "Pa", Range{1e6, 1e9},
        "f_c, static compressive strength, on which the exponent of malvar_ross depends");
    key("rate_crossings", rate_crossings, "-", Range{1.0, 1000.0},
        "time over which a link's strain rate is smoothed, in crossings of the link by a wave of "
        "speed sqrt(E / density)");
    key("alpha", alpha, "-", Range{1e-6, 1e6}, "macro-micro constant of Poisson's ratio");
    key("beta", beta, "-", Range{1e-6, 1e6}, "macro-micro constant of the stiffness");
    key("gamma", gamma, "-", Range{1e-6, 1e6}, "macro-micro constant of the stiffness");
    key("shear", shear, OneOf{"plastic", "brittle"}, "what a link does at its shear strength");
    key("bond_radius", bond_radius, "-", Range{0.0, 1.0, Open::low},
        "lambda, radius of a parallel bond over that of the smaller element");
    key("moment_share", moment_share, "-", Range{0.0, 1.0},
        "how far moments count in the stresses that break a parallel bond");
    key("fabric", fabric, OneOf{"packed", "even", "faces"},
        "sections of links: packed: by the radii alone, so that faces of a body are weak and soft; "
        "even: larger where an element has fewer links than those deep in the body; faces: "
        "stiffness "
        "as even, but no more strength than faces need, across which nothing pulls");
    key("stiffness", stiffness, OneOf{"estimated", "measured"},
        "stiffness of links: estimated: by alpha, beta, gamma; measured: times a factor that makes "
        "the modulus of each body, measured when it is built, that of the key young");
    key.table("bedding", bedding,
              "planes across which links of law concrete and parallel are weaker and softer");
    key.table("ldpm", ldpm, "the facet law of a material of law ldpm");
    key.table("mix", mix, "the mix design of a material of law ldpm");
    key("yield", yield, "Pa", Range{0.0, 1e15, Open::low}, "yield stress of steel");
    key("hardening", hardening, "Pa", Range{0.0, 1e15}, "plastic hardening modulus of steel");
    key("failure_strain", failure_strain, "-", positive, "plastic strain at which steel ruptures");
    key("bond", bond, OneOf{"perfect", "plastic", "mc90"},
        "bond-slip law: no limit, constant limit, or the curve of the CEB-FIP Model Code 1990");
    key("bond_strength", bond_strength, "Pa", Range{0.0, 1e15}, "largest bond stress tau_max");
    key("bond_residual", bond_residual, "Pa", Range{0.0, 1e15},
        "bond stress after slip3, mc90 only");
    key("slip1", slip1, "m", positive, "slip at which tau_max is reached, mc90 only");
    key("slip2", slip2, "m", positive, "slip at which the bond starts to fall, mc90 only");
    key("slip3", slip3, "m", positive, "slip at which the bond is residual, mc90 only");
    key("rib_height", rib_height, "m", Range{0.0, 0.1},
        "gap between bar and concrete at which ribs come free: where concrete has parted from the "
        "bar, the share of their height that is still in it keeps its bond; 0: none");
  }
};

}  // namespace breccia::dem
