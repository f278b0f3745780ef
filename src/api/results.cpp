#include <chrono>
#include <optional>

#include "api/field.hpp"
#include "api/guard.hpp"
#include "exec/timers.hpp"
#include "io/vtu/vtu_reader.hpp"
#include "run/machine/exec_choice.hpp"
#include "run/machine/signals.hpp"
#include "run/run.hpp"

namespace br {
namespace {

/// A field that keeps the numbers it is given.
template <class T>
Field keeping(std::string name, std::string unit, NumberType type, std::vector<T> numbers,
              std::int64_t components) {
  const auto memory = std::make_shared<const std::vector<T>>(std::move(numbers));
  constexpr auto size = std::int64_t{sizeof(T)};
  Field field{std::move(name), std::move(unit), type, memory->data(), {}, {}, memory};
  field.shape = {static_cast<std::int64_t>(memory->size()) / components};
  field.strides = {components * size};
  if (components > 1) {
    field.shape.push_back(components);
    field.strides.push_back(size);
  }
  return field;
}

std::vector<double> components_of(const std::vector<breccia::Vec3>& vectors) {
  std::vector<double> numbers;
  numbers.reserve(3 * vectors.size());
  for (const breccia::Vec3& v : vectors) numbers.insert(numbers.end(), {v.x, v.y, v.z});
  return numbers;
}

}  // namespace

int run(const Case& of, const std::string& folder, const RunOptions& options) {
  return guarded([&] {
    const auto begin = std::chrono::steady_clock::now();
    const breccia::Case& read = of.read().read;
    if (!options.allow_scripts) refuse_scripts(read);
    breccia::StageTimers timers;
    breccia::Exec exec = breccia::exec_on(options.device, options.threads, nullptr);
    exec.timers = &timers;
    const auto existing = options.replace ? breccia::Existing::replace : breccia::Existing::refuse;
    breccia::ResultFolder::check_free(folder, existing);
    breccia::StopSignals signals;
    const std::unique_ptr<breccia::Method> method = make_method(read, exec, nullptr, options.quiet);
    signals.answer_between_steps();
    timers.clear();
    breccia::RunPlan plan = plan_of(read);
    plan.begin = begin;
    plan.machine = {breccia::processor_name(), options.device, exec.threads, 1};
    plan.timers = &timers;
    plan.speech = options.quiet ? breccia::Speech::quiet : breccia::Speech::normal;
    const breccia::ResultFolder result = breccia::ResultFolder::create(folder, existing);
    return breccia::Run(*method, plan, &result).execute();
  });
}

std::vector<double> frame_times(const std::string& folder) {
  return guarded([&] { return breccia::frame_times(folder); });
}

std::vector<Field> read_frame(const std::string& folder, int number) {
  return guarded([&] {
    breccia::Frame frame = breccia::read_frame(folder, number);
    std::vector<Field> fields;
    const auto real = [&](const std::string& of, std::vector<breccia::FrameField>& from) {
      for (breccia::FrameField& f : from)
        fields.push_back(f.integers ? keeping(of + f.name, f.unit, NumberType::int32,
                                              std::move(*f.integers), f.components)
                                    : keeping(of + f.name, f.unit, NumberType::float32,
                                              std::move(f.values), f.components));
    };
    const auto indices = [&](const char* name, std::vector<std::int32_t>& from, int each) {
      if (!from.empty())
        fields.push_back(keeping(name, "-", NumberType::int32, std::move(from), each));
    };
    fields.push_back(
        keeping("position", "m", NumberType::float64, components_of(frame.position), 3));
    if (!frame.radius.empty())
      fields.push_back(keeping("radius", "m", NumberType::float64, std::move(frame.radius), 1));
    indices("lines", frame.lines, 2);
    indices("triangles", frame.triangles, 3);
    indices("tetrahedra", frame.tetrahedra, 4);
    real("points.", frame.point_fields);
    real("lines.", frame.line_fields);
    real("triangles.", frame.triangle_fields);
    real("tetrahedra.", frame.tetrahedron_fields);
    return fields;
  });
}

}  // namespace br
