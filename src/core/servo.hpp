#pragma once
// Servos: walls and supports that are moved so that they push with a given force.

#include <algorithm>
#include <string>
#include <vector>

#include "core/energy.hpp"
#include "core/keys.hpp"
#include "core/table_over_time.hpp"

namespace breccia {

/// Steps from one correction of a servo's velocity to the next, where no plate has a mass.
inline constexpr std::int64_t servo_every = 10;

/// [wall.servo]
struct ServoConfig {
  OverTime<double> force;     ///< in the plane per thickness  [N]
  OverTime<double> pressure;  ///<  [Pa]
  double area = 0.0;          ///< in the plane a length  [m2]
  double speed = 0.0;         ///< 0: there is no servo  [m/s]
  double slow = 0.0;          ///< kinetic over elastic energy; 0: never  [-]
  double gain = 1.0;          ///<  [-]
  double mass = 0.0;          ///< of its plate; no limit: it has none  [kg]

  template <class Visit>
  void each_key(Visit&& key) {
    keys_of_servo(key, false);
  }
  /// @param plane  forces and masses are per metre of thickness, areas lengths
  template <class Visit>
  void keys_of_servo(Visit&& key, bool plane) {
    key("force", force, plane ? "N/m or N" : "N", any_number,
        plane ? "force with which it pushes, per metre of thickness (of 1 m where the unit is N), "
                "or a table [[t, F], ...] of it over time"
              : "force with which it pushes, or a table [[t, F], ...] of it over time");
    key("pressure", pressure, "Pa", any_number,
        "pressure on `area`, added to the force, or a table [[t, p], ...] of it over time");
    key("area", area, plane ? "m or m2" : "m2", not_negative,
        plane ? "length that the pressure acts on, or its area by 1 m of thickness"
              : "area that the pressure acts on");
    key("speed", speed, "m/s", Range{0.0, 1e6}, "it never moves faster than this");
    key.required("speed");
    key("slow", slow, "-", Range{0.0, 1.0},
        "while kinetic over elastic energy is above this, its greatest speed is less in the same "
        "ratio; 0: never");
    key("gain", gain, "-", Range{0.0, 2.0, Open::low},
        "mass = inf: how fast it answers: 1 takes half of what is missing in the time between two "
        "corrections, if nothing gives way but what it touches");
    key("mass", mass, plane ? "kg/m or kg" : "kg", not_negative,
        plane ? "of a plate with the force on its back, with all that a support holds, per metre "
                "of thickness: Newton's law moves it in every step; left out (0): no inertia, or "
                "as little as the step can bear; inf: no plate, its velocity is corrected every 10 "
                "steps"
              : "of a plate with the force on its back, with all that a support holds: Newton's "
                "law moves it in every step; left out (0): no inertia, or as little as the step "
                "can bear; inf: no plate, its velocity is corrected every 10 steps");
  }
  bool is_on() const { return speed > 0.0; }
  bool is_plate() const { return is_on() && mass < no_limit; }
  bool is_due(std::int64_t step) const {
    return is_plate() || (is_on() && step % servo_every == 0);
  }
  /// When the force is asked for that is to come: a plate meets that of the next step.  [s]
  double aims_at(double time, double next_dt) const { return is_plate() ? time + next_dt : time; }
  /// Force that it is to push with.  [N]
  double target(double time, double begin) const {
    const auto now = [&](const OverTime<double>& of) {
      const ScaledAmplitude a = scaled_amplitude(of, 0, 0.0, begin);
      return a.scale * a.amplitude.at(time);
    };
    return now(force) + area * now(pressure);
  }
};

/// [support.servo]
struct SupportServoConfig : ServoConfig {
  std::string axis = "x";

  template <class Visit>
  void each_key(Visit&& key) {
    keys_of_support(key, false);
  }
  template <class Visit>
  void keys_of_support(Visit&& key, bool plane) {
    keys_of_servo(key, plane);
    key("axis", axis, OneOf{"x", "y", "z"},
        "along which it is moved and pushes; a positive force pushes towards greater coordinates");
  }
  int axis_number() const { return axis == "x" ? 0 : axis == "y" ? 1 : 2; }
};

/// Likewise, of a plane case.
struct PlaneServoConfig : SupportServoConfig {
  template <class Visit>
  void each_key(Visit&& key) {
    keys_of_support(key, true);
  }
};

/// Readings of a servo: of a part, or added up over all parts.
struct ServoReading {
  ExactSum force;      ///< that it pushes with  [N]
  ExactSum stiffness;  ///< of what it touches  [N/m]
  ExactSum mass;       ///< of that  [kg]
  // For plates:
  ExactSum flow;     ///< stiffness times the velocity that it will have  [N/s]
  ExactSum stiffer;  ///< more stiffness, in the mean over the way that its speed lets it go  [N/m]
  ExactSum inertia;  ///< that a plate needs, where the force to come is not known  [kg]
};
BR_HD inline ServoReading operator+(ServoReading a, const ServoReading& b) {
  a.force.add(b.force);
  a.stiffness.add(b.stiffness);
  a.mass.add(b.mass);
  a.flow.add(b.flow);
  a.stiffer.add(b.stiffer);
  a.inertia.add(b.inertia);
  return a;
}

/// A part of a run's state.
struct ServoState {
  double velocity = 0.0;  ///< in the direction in which it pushes  [m/s]
  double steady = 0.0;    ///< the part of it that lasts once the force is right  [m/s]
  double share = 1.0;     ///< of its greatest speed, by the kinetic energy  [-]

  /// The velocity until the next correction.
  /// @param missing  what it is to push with, less what it pushes with  [N]
  /// @param touched  stiffness and mass of what it touches
  /// @param last_dt, next_dt  steps before and after this moment  [s]
  void correct(const ServoConfig& servo, double missing, const ServoReading& touched,
               double last_dt, double next_dt);

 private:
  void follow_force(const ServoConfig& servo, double missing, const ServoReading& touched,
                    double span);
  void push_plate(const ServoConfig& servo, double missing, const ServoReading& touched,
                  double last_dt, double next_dt);
};

/// The servos that lead a motion along x, y, z, as kernels read it.
struct LedBy {
  std::int16_t servo[3] = {-1, -1, -1};  ///< walls first, then supports; -1: none
};

/// A motion, or one axis of it, that follows a servo.
struct ServoMotion {
  std::size_t servo;  ///< walls first, then supports
  std::int16_t motion;
  int axis;  ///< -1: along the wall's normal
};

}  // namespace breccia
