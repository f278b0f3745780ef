#pragma once
// Stages of a case: one after the other, each changes what holds and drives the model as it begins,
// and ends by time, at rest, by a probe, or when a load has fallen.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/keys.hpp"

namespace breccia {

inline constexpr std::size_t most_stages = 64;

/// Name and end of a stage: keys of [[stage]] that all methods share.
struct StageEnd {
  std::string name;
  double until = 0.0;  ///< after its beginning; 0: not by time  [s]
  double rest = 0.0;   ///< kinetic over elastic energy; 0: not at rest  [-]
  std::string when;
  double drop = 0.0;                ///< share of the peak of `drop_of`; 0: not by it  [-]
  std::string drop_of;              ///< a probe
  double local_damping = -1.0;      ///< from now on; below 0: as before  [-]
  double friction = -1.0;           ///< likewise  [-]
  std::vector<std::string> remove;  ///< bodies
  bool of_part = false;             ///< of one of two methods: bodies of the other may stay

  template <class Visit>
  void each_key(Visit&& key) {
    key("name", name, "name of the stage: summary.json and --stage name it");
    key.required("name");
    key("until", until, "s", not_negative, "it ends so long after its beginning; 0: not by time");
    key("rest", rest, "-", Range{0.0, 1.0},
        "it ends when the kinetic energy has been at most this share of the elastic energy at ten "
        "looks in succession, one every 100 steps; 0: not at rest");
    key("when", when,
        "it ends when a probe says so, as in \"force > 2 kN\": the name of a probe, one of <, <=, "
        "> and >=, and a number, with a unit or in SI; looked at every 100 steps");
    key("drop", drop, "-", Range{0.0, 1.0, Open::high},
        "it ends when the size of the probe drop_of has fallen by this share of its largest in "
        "this "
        "stage; looked at every 100 steps; 0: not by it");
    key("drop_of", drop_of, "the probe that drop looks at, such as the force of a support");
    key("local_damping", local_damping, "-", Range{-1.0, 1.0, Open::high},
        "local_damping from its beginning on; below 0: as before");
    key("friction", friction, "-", Range{-1.0, no_limit},
        "friction of all contacts, with walls, too, from its beginning on; links that are broken "
        "keep theirs; below 0: as before");
    key("remove", remove,
        "bodies that are taken out as it begins, with all that joined them and what they touched; "
        "the energy they held leaves the model as work");
  }
  /// Whether it has an end of its own; a last stage may go on to the end of the case.
  bool ends() const { return until > 0.0 || rest > 0.0 || !when.empty() || drop > 0.0; }
};

/// "probe > number", also with <, >= or <=.
struct ProbeRule {
  std::string probe, sign;
  double limit = 0.0;
  std::string unit;  ///< behind the number; empty: SI

  bool holds(double value) const {
    if (sign.size() > 1 && value == limit) return true;
    return sign[0] == '>' ? value > limit : value < limit;
  }
  /// None: the text is no such rule.
  static std::optional<ProbeRule> parsed(const std::string& text);
};

/// Cause of a stage's end.
enum class StageCause : std::int8_t { none, time, rest, probe, drop };
const char* word_of(StageCause cause);

/// Where a run is among its stages: a part of its state.
struct StageProgress {
  std::int32_t index = 0;  ///< of the stage that it is in
  std::int32_t calm = 0;   ///< looks at rest in succession
  double peak = 0.0;       ///< largest size of the load at the looks of this stage  [SI]
  std::array<double, most_stages> begin{};      ///< of each stage so far  [s]
  std::array<double, most_stages> end{};        ///< of each that is over  [s]
  std::array<StageCause, most_stages> cause{};  ///< none: not over

  bool over() const { return cause[static_cast<std::size_t>(index)] != StageCause::none; }
  bool over(std::size_t stage) const { return cause[stage] != StageCause::none; }
};

/// Problems of ends: names twice, probes and bodies that are not there, no end before the last.
/// @param probes  names of the case's probes
/// @param bodies  names of the case's bodies
std::vector<std::string> stage_problems(const std::vector<StageEnd>& stages,
                                        const std::vector<std::string>& probes,
                                        const std::vector<std::string>& bodies);

}  // namespace breccia
