#pragma once
/// @file
/// Breccia as a library: read a case, take steps, look at the state.
///
///     br::Simulation sim(br::Case("cases/rc_slab"));
///     sim.run(1e-3);
///     const br::Field velocity = sim.field("velocity");  // no copy on the CPU
///
/// A simulation steps as `breccia run` does, to the same bits (hash). It writes nothing; br::run
/// writes a result folder as the program would. In 2D quantities are per metre of thickness.
/// find_package(breccia) gives the target breccia::breccia; docs/install.md has an example.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#if defined(__GNUC__)
#define BR_API __attribute__((visibility("default")))
#else
#define BR_API
#endif

namespace br {

/// Anything that went wrong; what() is the message that the program would print.
class BR_API Error : public std::runtime_error {
 public:
  Error(int exit_code, const std::string& message)
      : std::runtime_error(message), exit_code_(exit_code) {}
  /// That the program would end with: 2 bad input, 3 input/output, 4 numerics, 5 memory or device,
  /// 7 checkpoint refused, 9 a check of the case failed.
  int exit_code() const { return exit_code_; }

 private:
  int exit_code_;
};

/// A case that has been read, checked and completed. Copies share it.
class BR_API Case {
 public:
  /// @param path       a case file, a folder that holds case.toml, or a prepared model
  /// @param overrides  "KEY=VALUE" in the words of a case file, as of `--set`
  /// @throws Error with every problem at once
  explicit Case(const std::string& path, const std::vector<std::string>& overrides = {});
  /// @param text       of a case file
  /// @param name       of the case, as reports and messages give it
  /// @param folder     where files that the case names are looked for
  /// @param overrides  "KEY=VALUE" in the words of a case file, as of `--set`
  static Case from_text(const std::string& text, const std::string& name = "case",
                        const std::string& folder = ".",
                        const std::vector<std::string>& overrides = {});

  const std::string& name() const;
  const std::string& text() const;    ///< completed: every key with the value used, in SI
  const std::string& digest() const;  ///< SHA-256 of the completed text
  std::string method() const;         ///< dem3d or fdem2d
  double end_time() const;            ///< time.end of the case  [s]

  struct Read;
  const Read& read() const { return *read_; }  ///< for the library itself

 private:
  explicit Case(std::shared_ptr<const Read> read);
  std::shared_ptr<const Read> read_;
};

enum class NumberType : std::uint8_t { float64, float32, int32, int16, uint8 };

/// An array of numbers. Number (i, j, ...) lies at data + i strides[0] + j strides[1] + ...
struct Field {
  std::string name, unit;
  NumberType type = NumberType::float64;
  const void* data = nullptr;         ///< null in lists of fields
  std::vector<std::int64_t> shape;    ///< items first, then components
  std::vector<std::int64_t> strides;  ///<  [bytes]
  /// That holds the numbers. If null, they are the simulation's own: they change with each step,
  /// and end with it.
  std::shared_ptr<const void> memory;
  int gpu = -1;  ///< whose memory `data` is; below 0: the host's

  /// A number of a field of doubles.
  double operator()(std::int64_t item, std::int64_t component = 0) const {
    const char* at = static_cast<const char*>(data) + item * strides[0];
    if (shape.size() > 1) at += component * strides[1];
    return *reinterpret_cast<const double*>(at);
  }
};

/// Where a simulation is among the stages of its case.
struct Stage {
  std::string name;
  double begin = 0.0, end = 0.0;  ///<  [s]; end 0: it goes on
  std::string ended_by;           ///< time, rest, probe or drop; empty: it goes on
};

/// Forces of your own on items of a simulation, at the time of its positions.
/// @param force  of item 0, then of item 1, ...: x, y, z of an element, or of the four corners of a
///               tetrahedron [N]; in 2D x, y of the three corners of a triangle [N/m]. Zero when
///               the law is asked.
using ForceLaw = std::function<void(std::vector<double>& force)>;

/// Where a simulation computes.
struct Options {
  std::string device = "cpu";  ///< cpu, cuda or cuda:N
  int threads = 0;             ///< of the host; 0: all there are
  bool allow_scripts = false;  ///< let gmsh run .geo files, which may do whatever you may
};

/// A case that runs. It has its own memory; several may live at once, each used by one thread at a
/// time.
class BR_API Simulation {
 public:
  /// Builds the model. @throws Error if that fails
  explicit Simulation(const Case& of, const Options& options = {});
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;
  ~Simulation();

  /// None when the last stage of the case is over.
  /// @throws Error naming step, time and element if numbers go wrong
  void step(std::int64_t count = 1);
  /// Steps to the first step at or past a time, or to the end of the last stage.
  /// @param until  that time  [s]
  /// @param stop   asked every `every` steps; true ends the run there. It may throw.
  /// @param every  steps from one question to the next
  /// @returns whether it got there
  bool run(double until, const std::function<bool()>& stop = {}, std::int64_t every = 100);

  double time() const;         ///< simulated so far  [s]
  std::int64_t steps() const;  ///< taken so far
  double time_step() const;    ///< last taken; at the start the one to come  [s]
  std::vector<std::string> warnings() const;

  /// Where every joule is, by the columns of history.csv, and error_relative.  [J; in 2D J/m]
  std::map<std::string, double> energies() const;
  /// Values of the case's probes.  [SI]
  std::map<std::string, double> probes() const;
  /// Counts and findings by their paths in summary.json, as model.elements.
  std::map<std::string, double> facts() const;
  /// Of all positions and velocities, by global id: `state_hash` of summary.json.
  std::string hash() const;

  /// Stages that have begun; none if the case has none.
  std::vector<Stage> stages() const;

  /// Adds forces to those of the case from now on: law() is asked once a step, when all other
  /// forces are known, and may read this simulation, not step it. Local damping acts on them as on
  /// other forces; their work is part of energies().at("work"). The time step does not know how
  /// stiff they are.
  /// @param items  rows of the arrays: elements, triangles or tetrahedra
  /// @param law    gives the forces on `items`
  /// @returns its number. @throws Error if there is no such item
  int add_force(std::vector<std::int64_t> items, ForceLaw law);
  /// Of a force since it was added.  [J; in 2D J/m]
  double work_of_force(int number) const;
  /// Rows of the arrays that forces act on: elements, triangles or tetrahedra.
  std::int64_t items() const;

  /// The arrays of the state, without their numbers.
  std::vector<Field> fields() const;
  /// On the CPU without a copy, but for what is worked out: damage, stress, fragment.
  /// @throws Error if there is none of that name
  Field field(const std::string& name) const;
  /// Of a GPU without a copy, too: in its memory (Field::gpu), complete on return, to be read until
  /// the next step.
  Field field_there(const std::string& name) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// How `run` runs a case.
struct RunOptions : Options {
  bool replace = false;  ///< the run that the folder holds
  bool quiet = true;     ///< says nothing
};

/// Runs a case as `breccia run CASE -o FOLDER`: pictures, checkpoints, checks and all.
/// @returns 0, or 128 + n if signal n ended it, the state then being saved
/// @throws Error likewise
BR_API int run(const Case& of, const std::string& folder, const RunOptions& options = {});

/// Times of the frames in a result folder.  [s]
BR_API std::vector<double> frame_times(const std::string& folder);
/// Positions, fields of points, lines and triangles of a frame, named "points.velocity" and so on;
/// as precise as the files (float32).
BR_API std::vector<Field> read_frame(const std::string& folder, int number);

/// Of the library, as in "0.1.0".
BR_API std::string version();

}  // namespace br
