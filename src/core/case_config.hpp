#pragma once
// Keys of every case, whatever its method: duration, probes, output, checkpoints, ranks and
// checks.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/keys.hpp"
#include "core/output_config.hpp"
#include "core/quantity.hpp"
#include "math/vec.hpp"

namespace breccia {

/// [time]
struct TimeConfig {
  double end = 1e-3;          ///< simulated time at which the run is done  [s]
  double safety = 0.7;        ///< share of the critical time step that is used  [-]
  double max_step = 1e-3;     ///< never longer than this  [s]
  int evaluate_every = 0;     ///< steps between evaluations of the critical step; 0: as usual  [-]
  double mass_scaling = 1.0;  ///< inertia in the run over that of the bodies; weight stays  [-]
  double added_mass = 0.0;    ///< share that the elements with the shortest steps may get  [-]

  /// As a run has it.
  /// @param usual  steps between evaluations where none are given
  TimeConfig evaluated_every(int usual) const {
    TimeConfig all = *this;
    if (all.evaluate_every == 0) all.evaluate_every = usual;
    return all;
  }
  template <class Visit>
  void each_key(Visit&& key) {
    key("end", end, "s", positive, "simulated time at which the run is done");
    key.required("end");
    key("safety", safety, "-", Range{0.0, 1.0, Open::low},
        "share of the critical time step that is used; 0.7071 is the rule of Durand et al. 2012");
    key("max_step", max_step, "s", positive, "no time step is longer than this");
    key("evaluate_every", evaluate_every, "-", Range{0, 1000},
        "steps from one evaluation of the critical time step to the next; 0: 20 for triangles and "
        "tetrahedra, 10 for spheres that links join, 1 for loose ones");
    key("mass_scaling", mass_scaling, "-", Range{1.0, 1e12},
        "inertia is so many times that of the bodies, weight stays: the time step grows with its "
        "square root. For quasi-static runs alone: energy.kinetic_share in summary.json tells "
        "whether inertia had a part");
    key("added_mass", added_mass, "-", Range{0.0, 0.1},
        "share of the whole mass that the triangles or tetrahedra with the shortest stable steps "
        "may get on top, so that all others take longer steps: 0.001 makes the steps of a mesh "
        "with a few slivers 2 to 3 times as long. Their weight grows with it; "
        "model.added_mass in summary.json tells how many, how much and how much longer");
  }
};

/// [checkpoint]
struct CheckpointConfig {
  double wall = 600.0;  ///< wall-clock time between checkpoints  [s]
  int steps = 0;        ///< steps between checkpoints; 0: by wall time only  [-]
  int keep = 2;         ///< newest checkpoints kept; 0: none is written  [-]

  template <class Visit>
  void each_key(Visit&& key) {
    key("wall", wall, "s", positive, "wall-clock time from one checkpoint to the next");
    key("steps", steps, "-", Range{0, 1e9},
        "steps from one checkpoint to the next, besides the wall-clock rule; 0 switches it off");
    key("keep", keep, "-", Range{0, 1000},
        "how many of the newest checkpoints are kept; 0: none is written, not at the end either");
  }
};

/// [energy]: what may be missing before a run is no result; no key of it changes a bit of the
/// states
struct EnergyConfig {
  double warn = 1e-3;  ///< of the largest energy or work so far  [-]
  double stop = 1e-2;  ///< likewise  [-]

  template <class Visit>
  void each_key(Visit&& key) {
    key("warn", warn, "-", not_negative,
        "error_relative, what is missing over the largest energy or work so far, above which 25 "
        "rows of history.csv in succession are a warning; 0 switches it off");
    key("stop", stop, "-", not_negative,
        "the same above which they, or the end of the case, are exit code 4; 0 switches it off");
  }
};

/// [audit]: steps that are done twice, to find a machine that computes wrong; no key of it changes
/// a bit of the results
struct AuditConfig {
  std::int64_t every = 0;  ///< mean distance of steps that are repeated; 0: none  [-]

  template <class Visit>
  void each_key(Visit&& key) {
    key("every", every, "-", Range{0, 1e12},
        "one step in so many, drawn at random, is done twice, and the bits of both results are "
        "compared: a difference ends the run with exit code 5. Each costs some copies of the "
        "state; 0 switches it off");
  }
};

/// [domain]: how a case is shared out among ranks; no key of it changes a bit of the results
struct DomainConfig {
  bool balance = true;
  double imbalance = 0.1;  ///< largest load over the mean, less one, that is left alone  [-]
  int refinement = 4;      ///< I_LB of Lukas et al. 2014, section 4  [-]
  double buffer = 0.25;    ///< over the mean size of an element  [-]
  double patience = 60.0;  ///< how long a rank may be silent  [s]
  bool show = false;

  template <class Visit>
  void each_key(Visit&& key) {
    key("balance", balance, "move the borders between ranks when their loads have become uneven");
    key("imbalance", imbalance, "-", Range{0.0, 100.0},
        "how far the largest load of a rank may exceed the mean before borders move");
    key("refinement", refinement, "-", Range{1, 100},
        "cells of the load grid along the size of an element: borders move by whole cells");
    key("buffer", buffer, "-", Range{0.0, 100.0},
        "how far elements travel, over their mean size, before they are shared out anew; more "
        "makes that rarer, and ranks hold more copies");
    key("patience", patience, "s", not_negative,
        "a rank whose process gives no sign of life for so long, or no answer for ten times as "
        "long, is lost: all end with exit code 8; 0 waits for ever");
    key("show", show, "frames tell the rank of each element, as the field rank");
  }
};

/// [[probe]]: one column of history.csv
struct ProbeConfig {
  std::string name;
  std::string on;  ///< body, support, wall or bolt; empty: all elements
  std::string quantity = "velocity_z";
  std::string reduce = "mean";
  std::vector<double> min{}, max{};  ///< corners of a box in space; empty: no box  [m]
  std::vector<double> about{};       ///< point of torque and angular momentum; empty: 0  [m]
  double lag = 0.0;                  ///< 0: it tells what it reads at once  [s]

  template <class Visit>
  void each_key(Visit&& key) {
    key("name", name, "column of history.csv");
    key.required("name");
    key("on", on,
        "body or support whose elements are read, or a wall: its force (that of all elements on "
        "it), "
        "position, velocity; or a bolt, each of its segments; empty reads all elements");
    key("quantity", quantity, quantity_words(in_space | in_plane | of_wall | of_bolt | in_solid),
        "what is read from each element; force is all that acts on it but gravity, so that of a "
        "support leaves out the weight of what it holds itself; stress, strain and displacement of "
        "a region, broken links or joints, opening and slip of cracks: docs/measures.md");
    key("reduce", reduce, OneOf{"mean", "sum", "min", "max"}, "how the elements' values combine");
    key("min", min, "m", any_number,
        "lower corner of a box that stands still: what is inside at the time is read (of "
        "displacement and strain, what was inside at the start); stress of spheres needs it; left "
        "out: open below, or no box without max; inf: open on that side");
    key("max", max, "m", any_number,
        "upper corner of that box; left out: open above, or no box without min; inf: open on that "
        "side");
    key("about", about, "m", any_number,
        "the point that torque and angular momentum are about; left out: the origin");
    key("lag", lag, "s", not_negative,
        "time constant of an instrument that follows what it reads, dy/dt = (x - y)/lag, as a load "
        "cell does; rows and rules of stages get y; 0: what it reads at once");
  }
};

/// [[check]]: a number that the case must show at the end of its run
struct CheckConfig {
  std::string name;
  std::string value;  ///< path into summary.json, or probe.<name>.<last|min|max|at>
  double at = -1.0;   ///< of a probe: when; below 0: not given  [s]
  double expected = 0.0;
  double tolerance = 0.0;  ///< largest allowed |value - expected|
  std::string unit = "-";

  template <class Visit>
  void each_key(Visit&& key) {
    key("name", name, "name of the check");
    key.required("name");
    key("value", value,
        "what is checked: a path into summary.json such as energy.error_relative, or "
        "probe.<name>.last, .min or .max; or .at, what it reads at the time `at`");
    key.required("value");
    key("at", at, "s", Range{-1.0, 1e30},
        "of probe.<name>.at: the time, between two rows of history.csv linearly; below 0: none");
    key("expected", expected, "-", any_number, "the number it must be, in SI units");
    key("tolerance", tolerance, "-", not_negative, "largest allowed distance from it");
    key("unit", unit, "unit of the three numbers, for the reader");
  }
};

/// The part of a case that every method shares.
struct CaseConfig {
  int breccia = 1;
  std::string method = "dem3d";
  std::string precision = "double";
  std::string title;
  std::int64_t seed = 1;
  TimeConfig time;
  OutputConfig output;
  CheckpointConfig checkpoint;
  DomainConfig domain;
  EnergyConfig energy;
  AuditConfig audit;
  std::vector<ProbeConfig> probes;
  std::vector<CheckConfig> checks;

  template <class Visit>
  void each_key(Visit&& key) {
    key("breccia", breccia, "-", Range{1, 1}, "version of the case-file format");
    key("method", method, OneOf{"dem3d", "fdem2d", "fdem3d"},
        "which method runs the case: spheres in space (Durand et al. 2012), triangles in the plane "
        "(Lukas et al. 2014), tetrahedra in space");
    key("precision", precision, OneOf{"double", "mixed", "single"},
        "what numbers are stored in; mixed keeps positions and sums in double, and what links keep "
        "and do and forces of joints and couples in single precision: fewer bytes, for GPUs; "
        "single computes cohesive links of spheres, and triangles and their joints, in single "
        "precision, too");
    key("title", title, "one line for people");
    key("seed", seed, "-", Range{0, 9e15}, "seed of every random choice");
    key.table("time", time, "how long and how fast");
    key.table("output", output, "what is written, how often");
    key.table("checkpoint", checkpoint, "when the state is saved");
    key.table("domain", domain, "how ranks share the work; never changes a result");
    key.table("energy", energy, "when energies that do not add up are a warning, and when an end");
    key.table("audit", audit, "steps that are done twice, to find a machine that computes wrong");
    key.list("probe", probes, "columns of history.csv");
    key.list("check", checks, "numbers the case must show");
  }
};

}  // namespace breccia
