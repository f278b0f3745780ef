// Cases of spheres and tetrahedra: what is wrong with them is said by key, and both parts are read.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "exec/error.hpp"
#include "io/case/case_file.hpp"
#include "io/vtu/touching.hpp"
#include "math/constants.hpp"
#include "prepare/build_coupled.hpp"
#include "run/case.hpp"
#include "run/method/coupled_method.hpp"

namespace breccia {
namespace check_coupled_test {

/// Steps as long as in contact from the start on.
const std::string good = R"(breccia = 1
method = ["dem3d", "fdem3d"]
[time]
end = "0.1 ms"
max_step = "0.31 us"
[output]
pictures = false
[spheres.material.grain]
law = "grain"
young = "10 GPa"
[[spheres.body]]
name = "pile"
shape = "box"
material = "grain"
center = [0.0, 0.0, 0.0205]
size = [0.04, 0.04, 0.04]
pack = { count = 30, compactness = 0.35 }
velocity = [5.0, 0.0, -20.0]
[tetrahedra.material.rock]
young = "30 GPa"
joints = "none"
[[tetrahedra.body]]
name = "block"
shape = "box"
material = "rock"
center = [0.0, 0.0, -0.01]
size = [0.08, 0.08, 0.02]
structured = true
mesh_size = "20 mm"
[[probe]]
name = "down"
on = "pile"
quantity = "velocity_z"
[[probe]]
name = "push"
on = "tetrahedra"
quantity = "momentum_z"
reduce = "sum"
)";

/// The block stands on a held foot as the pile hits it; then both fall, free.
const std::string staged = good + R"([[probe]]
name = "pile"
on = "spheres"
quantity = "momentum_z"
reduce = "sum"
[[tetrahedra.support]]
name = "foot"
max = [1.0, 1.0, "-19 mm"]
[[stage]]
name = "hold"
until = "30 us"
[[stage]]
name = "drop"
gravity = [0.0, 0.0, -9.81e3]
[stage.spheres]
friction = 0.2
[[stage.tetrahedra.support]]
name = "foot"
fix = []
)";

std::string problems_of(std::string text, const std::string& from = "",
                        const std::string& to = "") {
  if (!from.empty()) text.replace(text.find(from), from.size(), to);
  try {
    case_of_text(text, "both.toml", ".", {});
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}
bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(CheckCoupled, finds_what_is_wrong_by_key) {
  EXPECT_EQ(problems_of(good), "");
  EXPECT_TRUE(has(problems_of(good, "\"fdem3d\"]", "\"fdem2d\"]"), "method: of two methods"));
  EXPECT_TRUE(has(problems_of(good, "on = \"pile\"", "on = \"heap\""),
                  "probe.down.on = \"heap\": name a body"));
  // Probes stand above both methods: what one of these says of a probe has the probe's own key.
  const std::string stress =
      problems_of(good, "\"velocity_z\"",
                  "\"stress_zz\"\nmin = [-0.01, -0.01, 0.01]\nmax = [0.01, 0.01, 0.02]");
  EXPECT_TRUE(has(stress, "\n  probe.down.on: the stress of spheres")) << stress;
  EXPECT_TRUE(has(problems_of(good, "name = \"block\"", "name = \"pile\""),
                  "tetrahedra.body.pile: the name is taken"));
  EXPECT_TRUE(has(problems_of(good, "material = \"rock\"", "material = \"chalk\""),
                  "tetrahedra.body.block"))
      << problems_of(good, "material = \"rock\"", "material = \"chalk\"");
  EXPECT_TRUE(has(problems_of(good, "material = \"grain\"", "material = \"sand\""),
                  "spheres.body.pile.material"));
  EXPECT_TRUE(has(problems_of(good, "[output]", "precision = \"mixed\"\n[output]"), "precision"));
  const std::string bond =
      "[[bond]]\nname = \"b\"\nspheres = \"pile\"\ntetrahedra = \"rock\"\n[output]";
  EXPECT_TRUE(has(problems_of(good, "[output]", bond), "bond.b.tetrahedra = \"rock\" is none of"));
  const std::string stage = "[[spheres.stage]]\nname = \"s\"\nend = 1.0\n[output]";
  EXPECT_TRUE(has(problems_of(good, "[output]", stage), "stages stand above both methods"));
  const std::string probe = "[[tetrahedra.probe]]\nname = \"F\"\n[output]";
  EXPECT_TRUE(has(problems_of(good, "[output]", probe),
                  "tetrahedra.probe is not a key: it stands above both methods, [[probe]]"));
  EXPECT_EQ(problems_of(staged), "");
  EXPECT_TRUE(has(problems_of(staged, "name = \"foot\"\nfix = []", "name = \"feet\"\nfix = []"),
                  "stage.drop.tetrahedra.support.name"));
  EXPECT_TRUE(has(problems_of(staged, "until = \"30 us\"", "when = \"pull > 1\""), "pull"));
  EXPECT_TRUE(has(problems_of(staged, "until = \"30 us\"\n", ""), "stage.hold"));
  EXPECT_TRUE(has(problems_of(staged, "friction = 0.2", "remove = [\"pile\"]"), "remove"));
}

/// Files of both methods that are not there are told together, by the keys that name them.
TEST(CheckCoupled, names_files_that_cannot_be_read_by_key) {
  std::string text = good;
  const auto put = [&](const std::string& from, const std::string& to) {
    text.replace(text.find(from), from.size(), to);
  };
  put("size = [0.04, 0.04, 0.04]\npack = { count = 30, compactness = 0.35 }\n", "");
  put("shape = \"box\"", "shape = \"file\"\nfile = \"none.csv\"");
  put("center = [0.0, 0.0, 0.0205]\n", "");
  put("shape = \"box\"", "shape = \"mesh\"\nfile = \"none.inp\"");
  put("size = [0.08, 0.08, 0.02]\nstructured = true\nmesh_size = \"20 mm\"\n", "");
  put("center = [0.0, 0.0, -0.01]\n", "");
  const Case read = case_of_text(text, "both.toml", "/", {});
  for (const bool build : {false, true}) {
    std::string told;
    try {
      build ? (void)method_to_look_at(read) : check_files(read);
    } catch (const IoError& error) {
      told = error.what();
    }
    EXPECT_TRUE(has(told, "2 problems")) << told;
    EXPECT_TRUE(has(told, "spheres.body.pile.file: /none.csv: cannot read")) << told;
    EXPECT_TRUE(has(told, "tetrahedra.body.block.file: /none.inp: cannot read")) << told;
  }
}

std::unique_ptr<Method> method_of(const Case& read, int threads = 1, Space space = Space::host) {
  Exec exec;
  exec.threads = threads;
  exec.space = space;
  return make_method(read, exec, nullptr);
}

TEST(CoupledCase, reads_back_its_completed_text) {
  const Case read = case_of_text(good, "both.toml", ".", {});
  EXPECT_EQ(case_of_text(read.text, "again.toml", ".", {}).text, read.text);
}

TEST(CoupledCase, goes_on_from_a_saved_state_with_the_same_bits) {
  const Case read = case_of_text(good, "both.toml", ".", {});
  const auto whole = method_of(read), part = method_of(read);
  const std::int64_t half = 700, all = 1400;
  while (whole->steps() < all) whole->advance({1.0, all});
  while (part->steps() < half) part->advance({1.0, half});
  CheckpointWriter saved;
  part->save(saved);
  const auto resumed = method_of(read, 2);
  const CheckpointReader reader(saved);
  resumed->load(&reader);
  EXPECT_EQ(resumed->steps(), half);
  while (resumed->steps() < all) resumed->advance({1.0, all});
  EXPECT_EQ(resumed->state_hash(), whole->state_hash());
  EXPECT_EQ(resumed->time(), whole->time());
  const EnergyBalance a = resumed->energy(), b = whole->energy();
  EXPECT_EQ(a.elastic, b.elastic);
  EXPECT_EQ(a.friction, b.friction);
  EXPECT_GT(b.friction, 0.0);
  // The force of linear springs has a kink where a contact of two balls begins or ends: a step
  // across it errs by up to K (v dt)^2/8, K = pi E r/2. Ends give back what beginnings take, so
  // that a few of them stay (1.4e-5 here, one is 1.3e-5); what is between spheres and faces is
  // exact.
  const double radius = std::cbrt(0.35 * 0.04 * 0.04 * 0.04 / (30.0 * 4.0 / 3.0 * pi));
  const double way = std::hypot(5.0, 20.0) * whole->time_step();
  const double one = 0.5 * pi * 10e9 * radius * way * way / 8.0 / b.start;
  EXPECT_LT(b.error_relative, 4.0 * one);
  EXPECT_EQ(resumed->probes(), whole->probes());
  CheckpointWriter first, second;
  resumed->save(first);
  whole->save(second);
  EXPECT_EQ(first.first_difference(second), "");
}

/// The run's outer loop, by time alone.
void run_stages(Method& method, std::int64_t steps) {
  while (method.steps() < steps) {
    method.advance({1.0, steps});
    StageProgress now = method.stage();
    if (now.index > 0 || method.time() < method.stages()[0].until) continue;
    now.cause[0] = StageCause::time;
    now.index = 1;
    now.begin[1] = now.end[0] = method.time();
    method.set_stage(now);
  }
}

/// A stage begins in both methods at once: with nothing held, momentum changes by the weight of all
/// alone; no energy is missed; a run goes on in any stage with the same bits.
TEST(CoupledCase, goes_through_stages_and_is_resumed_in_each) {
  const Case read = case_of_text(staged, "both.toml", ".", {});
  const auto whole = method_of(read);
  const double pile = whole->probes()[2] / -20.0;
  std::vector<CheckpointWriter> saved;
  std::vector<double> time, momentum;
  for (const std::int64_t step : {60, 300, 700}) {
    run_stages(*whole, step);
    EXPECT_EQ(whole->stage().index, step == 60 ? 0 : 1);
    if (step < 700) whole->save(saved.emplace_back());
    time.push_back(whole->time());
    momentum.push_back(whole->probes()[1] + whole->probes()[2]);
  }
  const double falls = time[2] - time[1];
  const auto& rock = std::get<coupled::Config>(read.config).tetrahedra.materials[0];
  const double weight = 9.81e3 * (pile + rock.density * 0.08 * 0.08 * 0.02);
  EXPECT_NEAR(momentum[2] - momentum[1], -weight * falls, 1e-3 * weight * falls);
  EXPECT_LT(whole->energy().error_relative, 2e-4);
  for (const CheckpointWriter& half : saved) {
    const auto resumed = method_of(read, 2, Space::shadow);
    const CheckpointReader reader(half);
    resumed->load(&reader);
    run_stages(*resumed, 700);
    EXPECT_EQ(resumed->state_hash(), whole->state_hash());
    EXPECT_EQ(resumed->probes(), whole->probes());
    EXPECT_EQ(resumed->energy().work, whole->energy().work);
  }
}

/// A grain that a face pushes does not feel a stage that makes grains softer: contact with faces
/// keeps its stiffness, and forces that are evaluated anew get it back.
TEST(CoupledCase, keeps_what_faces_push_where_a_stage_changes_the_modulus_of_spheres) {
  const auto speed = [](const std::string& change) {
    std::string text = staged.substr(0, staged.find("[stage.spheres]"));
    const std::size_t shape = text.find("shape = \"box\""), pack = text.find("pack = ");
    text.replace(pack, text.find("velocity = ", pack) - pack, "");
    text.replace(shape, std::string("shape = \"box\"").size(),
                 "shape = \"element\"\nradius = 0.01");
    text.replace(text.find("center = [0.0, 0.0, 0.0205]"), 27, "center = [0.001, 0.002, 0.00999]");
    text.replace(text.find("size = [0.04, 0.04, 0.04]\n"), 26, "");
    text.replace(text.find("gravity = "), std::string("gravity = [0.0, 0.0, -9.81e3]").size(), "");
    const auto method = method_of(case_of_text(text + change, "both.toml", ".", {}));
    run_stages(*method, 60);
    EXPECT_EQ(method->stage().index, 0);
    const double before = method->probes()[0];
    run_stages(*method, 130);
    EXPECT_EQ(method->stage().index, 1);
    EXPECT_GT(method->probes()[0] - before, 0.1);  // the face pushes all the time
    EXPECT_LT(method->energy().error_relative, 1e-4);
    return method->probes()[0];
  };
  const double same = speed("");
  EXPECT_NEAR(speed("[[stage.spheres.material]]\nname = \"grain\"\nyoung = \"5 GPa\"\n"), same,
              1e-12 * std::abs(same));
}

/// Model that is left when the pile, or the block, is taken out, with and without bonds between
/// them, goes on by itself; what was between them leaves with its energy.
TEST(CoupledCase, takes_bodies_out_of_either_method) {
  for (const std::string body : {"pile", "block"}) {
    const bool bonded = body == "pile";
    SCOPED_TRACE(body + (bonded ? ", bonded" : ""));
    std::string text = staged.substr(0, staged.find("[stage.spheres]"));
    text += "remove = [\"" + body + "\"]\n";
    if (bonded)
      text += "[[bond]]\nname = \"b\"\nspheres = \"pile\"\ntetrahedra = \"block\"\nrange = 2.0\n";
    const Case read = case_of_text(text, "both.toml", ".", {});
    const auto whole = method_of(read);
    const double pile = whole->probes()[2] / -20.0;
    run_stages(*whole, 60);
    EXPECT_EQ(whole->stage().index, 0);
    const auto fact = [](Method& method, const std::string& path) {
      for (const Fact& f : method.facts())
        if (f.path == path) return f.value;
      return -1.0;
    };
    const double bonds = fact(*whole, "coupling.bonds");
    EXPECT_EQ(bonds > 0.0, bonded);
    EXPECT_LT(fact(*whole, "coupling.broken_bonds"), std::max(bonds, 1.0));
    run_stages(*whole, 200);
    EXPECT_EQ(whole->stage().index, 1);
    EXPECT_EQ(fact(*whole, "coupling.touching"), 0.0);
    EXPECT_EQ(fact(*whole, "coupling.broken_bonds"), bonds);
    CheckpointWriter saved;
    whole->save(saved);
    const double time = whole->time(), falling = whole->probes()[2];
    run_stages(*whole, 400);
    const double weight = 9.81e3 * pile * (whole->time() - time);
    if (body == "block") {
      EXPECT_NEAR(whole->probes()[2] - falling, -weight, 1e-3 * weight);
    }
    EXPECT_LT(whole->energy().error_relative, 2e-4);
    const auto resumed = method_of(read, 2, Space::shadow);
    const CheckpointReader reader(saved);
    resumed->load(&reader);
    run_stages(*resumed, 400);
    EXPECT_EQ(resumed->state_hash(), whole->state_hash());
    EXPECT_EQ(resumed->energy().work, whole->energy().work);
  }
}

/// A plate of 2 kg, the lower corners of the block with it, pushes with 1 kN for each 10 us, while
/// the pile hits it: the momentum of all is what the force has given.
TEST(CoupledCase, servos_push_with_their_force) {
  std::string text = good;
  text +=
      "[[tetrahedra.support]]\nname = \"foot\"\nmax = [1.0, 1.0, \"-19 mm\"]\nfix = [\"z\"]\n"
      "servo = { axis = \"z\", force = [[0, 0], [\"1 ms\", 100e3]], speed = 100, mass = 2 }\n"
      "[[probe]]\nname = \"pile\"\non = \"spheres\"\nquantity = \"momentum_z\"\nreduce = \"sum\"\n"
      "[[probe]]\nname = \"plate\"\non = \"foot\"\nquantity = \"velocity_z\"\n";
  const Case read = case_of_text(text, "both.toml", ".", {});
  const auto whole = method_of(read);
  const auto& rock = std::get<coupled::Config>(read.config).tetrahedra.materials[0];
  const double of_block = 0.5 * rock.density * 0.08 * 0.08 * 0.02;  // half of its corners
  const auto momentum = [of_block](Method& method) {
    const std::vector<double> p = method.probes();
    return p[1] + p[2] + (2.0 - of_block) * p[3];
  };
  const double start = momentum(*whole);
  CheckpointWriter saved;
  while (whole->steps() < 400) {
    whole->advance({1.0, 400});
    if (whole->steps() == 201) whole->save(saved);
  }
  const double given = 0.5 * 1e8 * whole->time() * whole->time();
  EXPECT_NEAR(momentum(*whole) - start, given, 0.02 * given);
  EXPECT_LT(whole->energy().error_relative, 1e-3);
  const auto resumed = method_of(read, 2, Space::shadow);
  const CheckpointReader reader(saved);
  resumed->load(&reader);
  while (resumed->steps() < 400) resumed->advance({1.0, 400});
  EXPECT_EQ(resumed->state_hash(), whole->state_hash());
}

TEST(CoupledCase, is_seen_on_a_device_as_on_the_host) {
  std::string text = good;
  text += "[[bond]]\nname = \"b\"\nspheres = \"pile\"\ntetrahedra = \"block\"\nrange = 1.5\n";
  const Case read = case_of_text(text, "both.toml", ".", {});
  const auto there = method_of(read, 1, Space::shadow), here = method_of(read);
  for (Method* method : {there.get(), here.get()})
    while (method->steps() < 100) method->advance({1.0, 100});
  CheckpointWriter first, second;
  there->save(first);
  here->save(second);
  EXPECT_EQ(first.first_difference(second), "");
  const auto numbers = [](Method& method) {
    std::vector<double> all = method.probes();
    for (const Fact& fact : method.facts())
      if (fact.path.starts_with("coupling.")) all.push_back(fact.value);
    const EnergyBalance e = method.energy();
    all.insert(all.end(), {e.kinetic, e.elastic, e.fracture, e.friction, e.contact, e.work});
    return all;
  };
  EXPECT_EQ(numbers(*there), numbers(*here));
  EXPECT_EQ(there->warnings(), here->warnings());
  EXPECT_EQ(there->frame_output({}).files.points, here->frame_output({}).files.points);
  const CheckpointReader from_device(first);
  const auto resumed = method_of(read);
  resumed->load(&from_device);
  EXPECT_EQ(resumed->state_hash(), there->state_hash());
}

TEST(CoupledCase, has_both_in_a_frame) {
  const Case read = case_of_text(good, "both.toml", ".", {});
  const auto method = method_of(read);
  const Frame frame = method->frame();
  EXPECT_EQ(frame.groups, (std::vector<std::string>{"pile", "block"}));
  EXPECT_EQ(frame.radius.size(), frame.position.size());
  EXPECT_EQ(frame.tetrahedra.size(), 4U * 6U * 16U);
  EXPECT_EQ(frame.tetrahedra[0], 30);
  const FrameOutput output = method->frame_output({});
  ASSERT_EQ(output.files.more.size(), 3U);
  EXPECT_FALSE(output.files.points.empty());
  EXPECT_FALSE(output.files.more[0].second.empty());
}

/// The block is free: what contacts of frames say that the pile does to it gives it its momentum.
TEST(CoupledCase, has_what_presses_on_tetrahedra_in_its_contacts) {
  const Case read = case_of_text(good, "both.toml", ".", {});
  const auto method = method_of(read);
  double given = 0.0;
  std::size_t most = 0;
  Frame frame;
  for (std::int64_t step = 1; step <= 300; ++step) {
    const double before = method->time();
    method->advance({1.0, step});
    frame = method->frame();
    std::size_t presses = 0;
    for (const FrameContact& c : frame.contacts) {
      if (c.a >= 30 || c.b < 30) continue;
      ++presses;
      given += c.force.z * (method->time() - before);
      EXPECT_GT(c.at_a.z, c.at_b.z);
      EXPECT_LT(c.b, 30 + 96);
    }
    most = std::max(most, presses);
  }
  EXPECT_GT(most, 3U);
  EXPECT_NEAR(method->probes()[1], given, 0.01 * std::fabs(given));
  // Files hold what the frame does.
  std::vector<FrameContact> of_spheres;
  for (const FrameContact& c : frame.contacts)
    if (c.a < 30) of_spheres.push_back(c);
  Touching touching{of_spheres, {}, false};
  touching.sort();
  EXPECT_EQ(method->frame_output({}).files.contacts,
            contents_of(contacts_frame(frame, touching)).lines);
}

}  // namespace check_coupled_test
}  // namespace breccia
