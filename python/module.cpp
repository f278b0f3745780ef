// The Python module breccia._breccia: include/breccia/breccia.hpp with numpy arrays.

#include <pybind11/functional.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <array>
#include <optional>

#include "breccia/breccia.hpp"
#include "dlpack.hpp"

namespace {

namespace py = pybind11;

/// The exceptions of the module by exit code; each is a br.Error and its nearest kin in Python.
struct Kind {
  int exit_code;
  const char* name;
  PyObject* kin;
  PyObject* exception = nullptr;
};
std::array<Kind, 6>& kinds() {
  static std::array<Kind, 6> all{{{2, "InputError", PyExc_ValueError},
                                  {3, "FileError", PyExc_OSError},
                                  {4, "NumericsError", PyExc_ArithmeticError},
                                  {5, "DeviceError", PyExc_RuntimeError},
                                  {7, "CheckpointError", PyExc_ValueError},
                                  {9, "CheckFailed", PyExc_AssertionError}}};
  return all;
}

void add_exceptions(py::module_& module) {
  static PyObject* const base = PyErr_NewException("breccia.Error", nullptr, nullptr);
  module.attr("Error") = py::handle(base);
  for (Kind& kind : kinds()) {
    const py::tuple bases = py::make_tuple(py::handle(base), py::handle(kind.kin));
    const std::string name = std::string("breccia.") + kind.name;
    kind.exception = PyErr_NewException(name.c_str(), bases.ptr(), nullptr);
    module.attr(kind.name) = py::handle(kind.exception);
  }
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const br::Error& error) {
      PyObject* exception = base;
      for (const Kind& kind : kinds())
        if (kind.exit_code == error.exit_code()) exception = kind.exception;
      PyErr_SetString(exception, error.what());
    }
  });
}

py::dtype dtype_of(br::NumberType type) {
  switch (type) {
    case br::NumberType::float32:
      return py::dtype::of<float>();
    case br::NumberType::int32:
      return py::dtype::of<std::int32_t>();
    case br::NumberType::int16:
      return py::dtype::of<std::int16_t>();
    case br::NumberType::uint8:
      return py::dtype::of<std::uint8_t>();
    case br::NumberType::float64:
      break;
  }
  return py::dtype::of<double>();
}

/// A read-only array over the numbers of a field.
/// @param owner  that keeps them where the field does not
py::array array_of(const br::Field& field, py::handle owner) {
  py::object base = py::reinterpret_borrow<py::object>(owner);
  if (field.memory) {
    auto* const kept = new std::shared_ptr<const void>(field.memory);
    base = py::capsule(
        kept, [](void* memory) { delete static_cast<std::shared_ptr<const void>*>(memory); });
  }
  py::array array(dtype_of(field.type), field.shape, field.strides, field.data, base);
  array.attr("flags").attr("writeable") = false;
  return array;
}

/// Ends a run where Python wants it: at Ctrl-C, at an exception of `stop`, or when that says so.
std::function<bool()> question(const py::object& stop, const py::object& sim) {
  return [&stop, &sim] {
    const py::gil_scoped_acquire locked;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    return !stop.is_none() && stop(sim).cast<bool>();
  };
}

/// Doubles in a row, converted from what Python has.
using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

py::list stages_of(const br::Simulation& sim) {
  py::list all;
  for (const br::Stage& s : sim.stages()) {
    py::dict stage;
    stage["name"] = s.name;
    stage["begin"] = s.begin;
    stage["end"] = s.ended_by.empty() ? py::object(py::none()) : py::float_(s.end);
    stage["ended_by"] = s.ended_by.empty() ? py::object(py::none()) : py::str(s.ended_by);
    all.append(stage);
  }
  return all;
}

br::Options options_of(const std::string& device, int threads, bool allow_scripts) {
  br::Options options;
  options.device = device;
  options.threads = threads;
  options.allow_scripts = allow_scripts;
  return options;
}

void step(const py::object& self, std::int64_t count) {
  if (count < 0) throw py::value_error("step(count): a count is not below zero");
  auto& sim = self.cast<br::Simulation&>();
  const py::none nothing;
  const py::gil_scoped_release unlocked;
  constexpr std::int64_t at_once = 100;
  for (std::int64_t left = count; left > 0; left -= at_once) {
    sim.step(std::min(left, at_once));
    question(nothing, self)();
  }
}

bool run_to(const py::object& self, double until, const py::object& stop, std::int64_t every) {
  auto& sim = self.cast<br::Simulation&>();
  const py::gil_scoped_release unlocked;
  return sim.run(until, question(stop, self), every);
}

/// A force law that asks Python: law(sim) gives an array of the forces on the items.
br::ForceLaw asking(const py::object& law, br::Simulation* of) {
  const std::shared_ptr<py::object> kept(new py::object(law), [](py::object* gone) {
    const py::gil_scoped_acquire locked;
    delete gone;
  });
  return [kept, of](std::vector<double>& force) {
    const py::gil_scoped_acquire locked;
    const auto numbers =
        py::cast<Numbers>((*kept)(py::cast(of, py::return_value_policy::reference)));
    force.assign(numbers.data(), numbers.data() + numbers.size());
  };
}

int run_case(const br::Case& of, const std::string& folder, const std::string& device, int threads,
             bool allow_scripts, bool replace, bool quiet) {
  br::RunOptions options;
  static_cast<br::Options&>(options) = options_of(device, threads, allow_scripts);
  options.replace = replace;
  options.quiet = quiet;
  int exit_code = 0;
  {
    const py::gil_scoped_release unlocked;
    exit_code = br::run(of, folder, options);
  }
  constexpr int interrupt = 128 + 2;
  if (exit_code == interrupt) {
    PyErr_SetNone(PyExc_KeyboardInterrupt);
    throw py::error_already_set();
  }
  return exit_code;
}

}  // namespace

PYBIND11_MODULE(_breccia, module) {
  module.doc() = "Breccia's library; see the package breccia.";
  module.attr("__version__") = br::version();
  add_exceptions(module);

  py::class_<br::Case>(module, "Case")
      .def_static("from_file",
                  [](const std::string& path, const std::vector<std::string>& set) {
                    return br::Case(path, set);
                  })
      .def_static("from_text", &br::Case::from_text)
      .def_property_readonly("name", &br::Case::name, "Its name.")
      .def_property_readonly("text", &br::Case::text,
                             "The completed case: every key with the value used, in SI.")
      .def_property_readonly("digest", &br::Case::digest, "SHA-256 of the completed case.")
      .def_property_readonly("method", &br::Case::method, "dem3d or fdem2d.")
      .def_property_readonly("end_time", &br::Case::end_time, "time.end of the case [s].");

  py::class_<br::Simulation>(module, "Simulation")
      .def(py::init(
          [](const br::Case& of, const std::string& device, int threads, bool allow_scripts) {
            const br::Options options = options_of(device, threads, allow_scripts);
            const py::gil_scoped_release unlocked;
            return br::Simulation(of, options);
          }))
      .def("step", &step, py::arg("count") = 1)
      .def("_run", &run_to)
      .def_property_readonly("time", &br::Simulation::time, "Simulated so far [s].")
      .def_property_readonly("steps", &br::Simulation::steps, "Steps taken so far.")
      .def_property_readonly("time_step", &br::Simulation::time_step,
                             "Last time step; at the start the one to come [s].")
      .def_property_readonly("warnings", &br::Simulation::warnings,
                             "What set-up found doubtful, as sentences.")
      .def_property_readonly("energies", &br::Simulation::energies,
                             "Where every joule is [J; in 2D J/m], and error_relative [-].")
      .def_property_readonly("probes", &br::Simulation::probes, "Values of the probes [SI].")
      .def_property_readonly("facts", &br::Simulation::facts,
                             "Counts and findings by their paths in summary.json.")
      .def_property_readonly("hash", &br::Simulation::hash,
                             "Of all positions and velocities: state_hash of summary.json.")
      .def_property_readonly("stages", &stages_of,
                             "Stages that have begun, as dicts: name, begin, end [s], ended_by.")
      .def_property_readonly("items", &br::Simulation::items,
                             "Elements, or in 2D triangles: rows of the arrays.")
      .def("_add_force",
           [](py::object& self, const std::vector<std::int64_t>& on, const py::object& law) {
             auto& sim = self.cast<br::Simulation&>();
             return sim.add_force(on, asking(law, &sim));
           })
      .def("_work_of_force", &br::Simulation::work_of_force)
      .def("_dlpack",
           [](const py::object& self, const std::string& name) {
             return dlpack::capsule_of(self.cast<const br::Simulation&>().field_there(name), self);
           })
      .def("_gpu", [](const br::Simulation& sim,
                      const std::string& name) { return sim.field_there(name).gpu; })
      .def("_names",
           [](const br::Simulation& sim) {
             std::map<std::string, std::string> units;
             for (const br::Field& field : sim.fields()) units[field.name] = field.unit;
             return units;
           })
      .def("_array", [](const py::object& self, const std::string& name) {
        return array_of(self.cast<const br::Simulation&>().field(name), self);
      });

  module.def("run", &run_case, py::arg("case"), py::arg("folder"), py::arg("device"),
             py::arg("threads"), py::arg("allow_scripts"), py::arg("replace"), py::arg("quiet"));
  module.def("frame_times", &br::frame_times, py::arg("folder"));
  module.def("frame_units", [](const std::string& folder, int number) {
    std::map<std::string, std::string> units;
    for (const br::Field& field : br::read_frame(folder, number)) units[field.name] = field.unit;
    return units;
  });
  module.def("read_frame", [](const std::string& folder, int number) {
    py::dict frame;
    for (const br::Field& field : br::read_frame(folder, number))
      frame[py::str(field.name)] = array_of(field, py::none());
    return frame;
  });
}
