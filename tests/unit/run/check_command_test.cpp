// `breccia check` as people use it: what it says of size and cost, and how it mends slips.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "io/case/problems.hpp"
#include "io/whole_file.hpp"
#include "paths.hpp"
#include "run/case.hpp"
#include "run/case_keys.hpp"
#include "unit/run/beam_case.hpp"
#include "unit/run/program.hpp"
#include "unit/run/scratch_folder.hpp"

namespace breccia {
namespace check_command_test {

struct Told {
  int exit_code;
  std::string text;
};
Told told_by(const ScratchFolder& folder, const std::string& arguments) {
  const std::string output = folder.path() + "/told.txt";
  const int code = wait_for(start_program(arguments, output));
  return {code, read_whole_file(output)};
}
bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::string changed(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

TEST(Check, tells_wrong_units_and_names_that_lead_nowhere_together) {
  const ScratchFolder folder;
  const auto told = [&](const std::string& text) {
    replace_file(folder / "case.toml", text);
    return told_by(folder, "check " + (folder / "case.toml")).text;
  };
  const std::string two =
      changed(changed(beam, "\"5 mm\"", "\"5 kg\""), "material = \"stone\"", "material = \"ston\"");
  const std::string text = told(two);
  EXPECT_TRUE(has(text, "2 problems")) << text;
  EXPECT_TRUE(has(text, "line 13, body.beam.mesh_size: \"5 kg\" is a mass")) << text;
  EXPECT_TRUE(has(text, "\n      13 | mesh_size = \"5 kg\"\n")) << text;
  EXPECT_TRUE(has(text, "line 11, body.beam: material = \"ston\" is not a material")) << text;
  // A misspelt head takes the name away: no second problem follows from it.
  const std::string headless = told(changed(two, "[material.stone]", "[materal.stone]"));
  EXPECT_FALSE(has(headless, "is not a material")) << headless;
  const std::string solid =
      "breccia = 1\nmethod = \"fdem3d\"\n[time]\nend = \"1 kg\"\n"
      "[material.stone]\nyoung = \"30 GPa\"\n[[body]]\nname = \"a\"\n"
      "shape = \"box\"\nsize = [1.0, 1.0, 1.0]\nmesh_size = 0.5\n"
      "material = \"ston\"\n";
  EXPECT_TRUE(has(told(solid), "2 problems")) << told(solid);
  const std::string spheres = changed(solid, "fdem3d", "dem3d");
  EXPECT_TRUE(has(told(spheres), "is not a material")) << told(spheres);
}

TEST(Check, names_the_file_of_grains_that_are_packed_too_densely_and_says_how_dense_they_may_be) {
  const ScratchFolder folder;
  replace_file(folder / "heap.toml",
               "breccia = 1\nmethod = \"dem3d\"\ntime.end = 1e-3\n[material.gravel]\n"
               "law = \"grain\"\n[[body]]\nname = \"heap\"\nshape = \"box\"\n"
               "size = [1.0, 1.0, 1.0]\npack = { count = 500, size_ratio = 1.5 }\n"
               "material = \"gravel\"\n");
  const Told told = told_by(folder, "check " + (folder / "heap.toml"));
  EXPECT_EQ(told.exit_code, 2);
  EXPECT_TRUE(has(told.text, "with the model of ")) << told.text;
  EXPECT_TRUE(has(told.text, "heap.toml; nothing was run")) << told.text;
  EXPECT_TRUE(has(told.text, "smaller pack.compactness, such as 0.5")) << told.text;
  EXPECT_TRUE(has(told.text, "line 6, body.heap: element ")) << told.text;
}

TEST(Check, says_what_overlapping_spheres_of_a_file_need) {
  const ScratchFolder folder;
  replace_file(folder / "two.csv", "0,0,0,1\n0,0,1.9,1\n");
  replace_file(folder / "two.toml",
               "breccia = 1\nmethod = \"dem3d\"\ntime.end = 1e-3\n[material.gravel]\n"
               "law = \"grain\"\n[[body]]\nname = \"two\"\nshape = \"file\"\n"
               "file = \"two.csv\"\nmaterial = \"gravel\"\n");
  const Told told = told_by(folder, "check " + (folder / "two.toml"));
  EXPECT_EQ(told.exit_code, 2);
  EXPECT_TRUE(has(told.text, "line 6, body.two: element ")) << told.text;
  EXPECT_TRUE(has(told.text, "spheres of its file lie in each other")) << told.text;
  EXPECT_FALSE(has(told.text, "compactness")) << told.text;
}

TEST(CheckCommand, refuses_a_body_that_nobody_can_mesh) {
  const ScratchFolder folder;
  const std::string wide = "\"300 mm\"";
  std::string thin = beam;
  thin.replace(thin.find(wide), wide.size(), "\"1e-9 mm\"");
  replace_file(folder.path() + "/thin.toml", thin);
  for (const char* command : {"check ", "run --steps 1 -q -o thin_out "}) {
    const Told told = told_by(folder, command + folder.path() + "/thin.toml");
    EXPECT_EQ(told.exit_code, 2) << told.text;
    EXPECT_TRUE(has(told.text, "line ") && has(told.text, "size = 1e-12 m is too thin"))
        << told.text;
    EXPECT_FALSE(has(told.text, "good")) << told.text;
  }
}

TEST(CheckCommand, says_size_step_time_memory_and_disk_within_80_columns) {
  const ScratchFolder folder;
  replace_file(folder.path() + "/beam.toml", beam);
  const Told told = told_by(folder, "check " + folder.path() + "/beam.toml");
  EXPECT_EQ(told.exit_code, 0) << told.text;
  for (const char* word :
       {"triangles", "joints", "step ", "steps ", "core", "GPU", "crushed", "memory", "disk"})
    EXPECT_TRUE(has(told.text, word)) << word << " in\n" << told.text;
  for (std::size_t at = told.text.find('\n') + 1; at < told.text.size();) {
    const std::size_t end = told.text.find('\n', at);
    EXPECT_LE(end - at, 80U) << told.text.substr(at, end - at);
    at = end + 1;
  }
}

TEST(CheckCommand, says_which_support_takes_all_bodies) {
  const ScratchFolder folder;
  for (const char* name : {"dem", "fdem", "fdem3"}) {
    const std::string path = folder.path() + "/case.toml";
    std::string text = read_whole_file(source_dir + std::string("/tests/attack/") + name + ".toml");
    replace_file(path, text);
    EXPECT_FALSE(has(told_by(folder, "check " + path).text, "names no body")) << name;
    text.resize(text.find("[[support]]"));
    replace_file(path, text + "[[support]]\nname = \"held\"\non = \"\"\n");
    const Told told = told_by(folder, "check " + path);
    EXPECT_EQ(told.exit_code, 0) << told.text;
    EXPECT_TRUE(has(told.text, "support held names no body (key on)")) << told.text;
  }
}

TEST(CheckCommand, names_line_and_key_of_a_region_that_takes_nothing) {
  const ScratchFolder folder;
  replace_file(folder.path() + "/beam.toml", changed(beam, "\"-151 mm\", \"-21 mm\"", "0.4, 0.0"));
  replace_file(folder.path() + "/beam.toml", changed(read_whole_file(folder.path() + "/beam.toml"),
                                                     "\"-140 mm\", \"-19 mm\"", "0.5, 0.1"));
  const Told told = told_by(folder, "check " + folder.path() + "/beam.toml");
  EXPECT_EQ(told.exit_code, 2);
  EXPECT_TRUE(has(told.text, "beam.toml; nothing was run.")) << told.text;
  EXPECT_TRUE(has(told.text,
                  "line 16, support.left.min = 400 mm: the region takes nothing; beam is "
                  "nearest, 250 mm away, with x from -150 mm to 150 mm"))
      << told.text;
}

TEST(CheckCommand, names_a_crack_that_lies_beside_all_bodies) {
  const ScratchFolder folder;
  const std::string path = folder.path() + "/beam.toml";
  const auto crack = [&](const std::string& points) {
    replace_file(path, beam + "[[discontinuity]]\nname = \"far\"\npoints = " + points + "\n");
    return told_by(folder, "check " + path);
  };
  const Told told = crack("[[0.4, -0.01], [0.45, 0.0], [0.45, 0.01]]");
  EXPECT_EQ(told.exit_code, 2);
  EXPECT_TRUE(has(told.text,
                  "line 20, discontinuity.far.points: it lies in no body; beam is nearest, 250 mm "
                  "away"))
      << told.text;
  EXPECT_EQ(crack("[[0.4, -0.01], [0.1, 0.0]]").exit_code, 0);  // in part is enough
}

/// Frames of a run have fields that those of single elements lack.
TEST(CheckCommand, takes_all_fields_that_frames_of_the_case_have) {
  const ScratchFolder folder;
  const std::string cases = source_dir + std::string("/cases/");
  for (const auto& [name, color] :
       {std::pair{"rc_slab", "bar"}, std::pair{"rc_slab", "held"},
        std::pair{"rc_slab_ldpm", "opening"}, std::pair{"wing_crack", "held"}})
    EXPECT_NO_THROW(
        load_case(cases + name + "/small.toml", {std::string("output.color=\"") + color + "\""}))
        << name << ' ' << color;
  EXPECT_THROW(load_case(cases + "wing_crack/small.toml", {"output.color=\"bar\""}), InputError);
}

/// Of a model that takes long to build; others are built to be checked.
TEST(CheckCommand, doubts_a_load_on_less_than_an_edge_of_the_mesh) {
  const ScratchFolder folder;
  const std::string path = folder.path() + "/beam.toml";
  const std::string fine = changed(beam, "\"5 mm\"", "\"1 mm\"");
  const auto load = [&](const std::string& half) {
    replace_file(path, fine + "\n[[load]]\nname = \"pad\"\nkind = \"pressure\"\npressure = 1e6\n" +
                           "min = [\"-" + half + "\", \"19 mm\"]\nmax = [\"" + half +
                           "\", \"21 mm\"]\n");
    const Told told = told_by(folder, "check " + path);
    EXPECT_EQ(told.exit_code, 0) << told.text;
    const Told of_run = told_by(folder, "run " + path + " -o " + folder.path() + "/r --steps 1");
    EXPECT_EQ(has(told.text, "load.pad: the region is"), of_run.exit_code == 2)
        << told.text << of_run.text;
    return of_run.exit_code;
  };
  EXPECT_EQ(load("0.4 mm"), 2);
  EXPECT_EQ(load("30 mm"), 0);
}

TEST(CheckCommand, tells_of_bolts_before_anything_is_meshed) {
  const ScratchFolder folder;
  const std::string path = folder.path() + "/bolted.toml";
  const std::string good = read_whole_file(source_dir + std::string("/tests/attack/bolted.toml"));
  const auto told = [&](const std::string& old, const std::string& now) {
    replace_file(path, changed(good, old, now));
    const Told of_run = told_by(folder, "run " + path + " -o " + folder.path() + "/r --steps 1");
    EXPECT_EQ(of_run.exit_code, 2) << of_run.text;
    const Told of_check = told_by(folder, "check " + path);
    EXPECT_EQ(of_check.exit_code, 2) << of_check.text;
    return of_check.text;
  };
  std::string text = told("segment = \"2 mm\"", "segment = \"1 mm\"");
  EXPECT_TRUE(has(text, "line 37, bolt.bolt.segment: 0.0009357 m are stiffer than")) << text;
  text = told("segment = \"2 mm\"", "segment = \"1 um\"");
  EXPECT_TRUE(has(text, "bolt.bolt.segment: 1e-06 m are stiffer than")) << text;
  text = told("[\"1 mm\", \"7 mm\"]", "[\"1 mm\", \"9 mm\"]");
  EXPECT_TRUE(
      has(text, "bolt.bolt.points: (1 mm, 9 mm) lies in no body; plate is nearest, 1 mm away"))
      << text;
  text = told("on = \"bolt\"", "on = \"bold\"");
  EXPECT_TRUE(has(text, "nor a support (low, high) nor a bolt (bolt)")) << text;
}

TEST(CheckCommand, refuses_what_only_a_mesh_tells_where_that_is_soon_made) {
  const ScratchFolder folder;
  const std::string path = folder.path() + "/bolted.toml";
  const std::string good = read_whole_file(source_dir + std::string("/tests/attack/bolted.toml"));
  replace_file(path, changed(good, "min = [-1.0, \"7.9 mm\"]", "min = [-1.0, \"-8.1 mm\"]"));
  const Told told = told_by(folder, "check " + path);
  EXPECT_EQ(told.exit_code, 2) << told.text;
  EXPECT_TRUE(has(told.text, " of a corner of triangle ")) << told.text;
  EXPECT_TRUE(has(told.text, " that support.low prescribes, too; leave ")) << told.text;
}

TEST(CheckCommand, tells_regions_and_names_in_one_go) {
  const ScratchFolder folder;
  std::string wrong = changed(beam, "\"-140 mm\", \"-19 mm\"", "\"-140 mm\", \"-23 mm\"");
  wrong +=
      "[[support]]\nname = \"far\"\nmin = [0.4, 0.0]\nmax = [0.5, 0.1]\n"
      "[[probe]]\nname = \"force\"\non = \"fra\"\nquantity = \"force_y\"\n";
  replace_file(folder.path() + "/beam.toml", wrong);
  const Told told = told_by(folder, "check " + folder.path() + "/beam.toml");
  EXPECT_EQ(told.exit_code, 2);
  EXPECT_TRUE(has(told.text, "3 problems in ")) << told.text;
  EXPECT_TRUE(has(told.text, ": min must not be above max")) << told.text;
  EXPECT_TRUE(has(told.text, "support.far.min = 400 mm: the region takes nothing")) << told.text;
  EXPECT_TRUE(has(told.text, "probe.force.on = \"fra\"")) << told.text;
}

TEST(CheckCommand, of_the_model_names_the_corner_nearest_to_an_empty_region) {
  const ScratchFolder folder;  // inside the beam, between two rows of corners
  std::string wrong = changed(beam, "\"-151 mm\", \"-21 mm\"", "\"-150 mm\", \"-19 mm\"");
  wrong = changed(wrong, "\"-140 mm\", \"-19 mm\"", "\"-140 mm\", \"-18 mm\"");
  replace_file(folder.path() + "/beam.toml", wrong);
  const Told told = told_by(folder, "check --model " + folder.path() + "/beam.toml");
  EXPECT_EQ(told.exit_code, 2);
  EXPECT_TRUE(has(told.text, "holds no corner of any triangle; the nearest, at (-0.1"))
      << told.text;
  EXPECT_TRUE(has(told.text, " m, is 0.001 m away")) << told.text;
  EXPECT_FALSE(has(told.text, ": good")) << told.text;
}

TEST(CheckCommand, of_the_model_foresees_its_own_steps) {
  const ScratchFolder folder;
  replace_file(folder / "beam.toml", beam);
  const Told told = told_by(folder, "check --model " + (folder / "beam.toml"));
  EXPECT_EQ(told.exit_code, 0) << told.text;
  EXPECT_FALSE(has(told.text, "step    about")) << told.text;
  EXPECT_TRUE(has(told.text, "joints of the model as it is set up")) << told.text;
}

TEST(CheckCommand, does_not_bound_the_steps_of_joints_that_cut_a_mesh) {
  const ScratchFolder folder;
  const std::string slope = source_dir + std::string("/cases/dfn_slope/case.toml");
  const Told told = told_by(folder, "check " + slope);
  EXPECT_EQ(told.exit_code, 0) << told.text;
  EXPECT_TRUE(has(told.text, "  step    at most about ")) << told.text;
  EXPECT_TRUE(has(told.text, "check --model tells")) << told.text;
  EXPECT_TRUE(has(told.text, "  steps   at least about ")) << told.text;
  EXPECT_TRUE(has(told.text, "  time    at least ")) << told.text;
  const Told ended = told_by(folder, "check " + slope + " --set stage.stand.rest=1e-6");
  EXPECT_TRUE(has(ended.text, "  steps   about ")) << ended.text;
}

TEST(CheckCommand, fix_writes_the_case_with_slips_corrected_and_checks_that) {
  const ScratchFolder folder;
  std::string wrong = changed(beam, "young = \"30 GPa\"", "yung = \"30 gpa\"");
  wrong = changed(wrong, "\"beam\"\nstructured", "\"baem\"\nstructured");
  wrong = changed(wrong, "[[support]]", "[support]");
  replace_file(folder.path() + "/beam.toml", wrong);
  const Told told = told_by(folder, "check --fix " + folder.path() + "/beam.toml");
  EXPECT_EQ(told.exit_code, 0) << told.text;
  EXPECT_EQ(read_whole_file(folder.path() + "/beam.fixed.toml"), beam);
  EXPECT_EQ(read_whole_file(folder.path() + "/beam.toml"), wrong);
  EXPECT_TRUE(has(told.text, "line 6: yung -> young")) << told.text;
}

TEST(CheckCommand, fix_corrects_each_table_of_a_list) {
  const ScratchFolder folder;
  const std::string two = beam +
                          "[[support]]\nname = \"right\"\nmin = [\"140 mm\", \"-21 mm\"]\n"
                          "max = [\"151 mm\", \"-19 mm\"]\n";
  std::string wrong = two;
  for (std::size_t at = 0; (at = wrong.find("[[support]]", at)) != std::string::npos;)
    wrong.replace(at, 11, "[[suport]]");
  replace_file(folder.path() + "/beam.toml", wrong);
  const Told told = told_by(folder, "check --fix " + folder.path() + "/beam.toml");
  EXPECT_EQ(told.exit_code, 0) << told.text;
  EXPECT_EQ(read_whole_file(folder.path() + "/beam.fixed.toml"), two);
}

TEST(CaseName, is_the_stem_and_of_a_case_folder_its_name) {
  const ScratchFolder folder;
  const std::string name = std::filesystem::path(folder.path()).filename().string();
  EXPECT_EQ(case_name(folder.path() + "/beam.toml"), "beam");
  replace_file(folder.path() + "/case.toml", beam);
  EXPECT_EQ(case_name(folder.path()), name);
  EXPECT_EQ(case_name(folder.path() + "/small.toml"), name + "_small");
}

/// Spheres of a file, a wall and a support beside them, a probe of nothing, a mean of forces, and a
/// stage that names what is not there.
TEST(CheckCommand, looks_at_bodies_from_files_and_into_stages) {
  const ScratchFolder folder;
  std::ofstream(folder.path() + "/balls.csv") << "0,0,0,0.01\n0.02,0,0,0.01\n";
  const std::string whole = R"(breccia = 1
method = "dem3d"
[time]
end = "1 ms"
[material.grain]
law = "grain"
[[body]]
name = "balls"
shape = "file"
file = "balls.csv"
material = "grain"
[[wall]]
name = "far"
point = [0.0, 0.0, -0.5]
normal = [0.0, 0.0, 1.0]
[[support]]
name = "held"
min = [0.0, -1.0, -1.0]
[[probe]]
name = "push"
on = "held"
quantity = "force_x"
[[probe]]
name = "stress"
quantity = "stress_zz"
min = [1.0, 1.0, 1.0]
max = [2.0, 2.0, 2.0]
[[stage]]
name = "only"
[[stage.wall]]
name = "far"
)";
  const auto told = [&](const std::string& text) {
    std::ofstream(folder.path() + "/case.toml") << text;
    return told_by(folder, "check " + folder.path() + "/case.toml");
  };
  const Told good = told(whole);
  EXPECT_EQ(good.exit_code, 0) << good.text;
  EXPECT_TRUE(has(good.text, "line 14, wall.far.point")) << good.text;
  EXPECT_TRUE(has(good.text, "490 mm")) << good.text;
  EXPECT_TRUE(has(good.text, "probe.push.reduce")) << good.text;
  EXPECT_TRUE(has(good.text, "line 26, probe.stress.min")) << good.text;
  const Told beside = told(changed(whole, "min = [0.0, -1.0, -1.0]", "min = [0.5, -1.0, -1.0]"));
  EXPECT_EQ(beside.exit_code, 2);
  EXPECT_TRUE(
      has(beside.text, "line 18, support.held.min = 500 mm: the region takes nothing; balls"))
      << beside.text;
  const Told lost =
      told(changed(whole, "[[stage.wall]]\nname = \"far\"", "[[stage.wall]]\nname = \"near\""));
  EXPECT_EQ(lost.exit_code, 2);
  EXPECT_TRUE(has(lost.text, "line 31, stage.only.wall.name = \"near\" is no wall")) << lost.text;
}

/// A table of another method is no slip of the pen: which method has it, what this one has instead,
/// and nothing that --fix would write in its place.
TEST(CheckCommand, tells_which_methods_have_a_key) {
  const auto told = [](const char* method, const char* text) {
    const CaseText source{fmt::format("breccia = 1\nmethod = \"{}\"\n{}", method, text), "a.toml"};
    try {
      case_of_text(source.text, source.origin, ".", {});
    } catch (const CaseError& error) {
      for (const Problem& problem : error.problems)
        if (problem.text.find("is not a key") != std::string::npos) {
          EXPECT_EQ(problem.line, 3U);
          return problem.text + (problem.correction ? " (corrected)" : "");
        }
    }
    return std::string();
  };
  EXPECT_EQ(
      told("dem3d", "[[load]]\nname = \"a\"\n"),
      "load is not a key of dem3d; fdem2d and fdem3d have it\n    spheres have no faces: walls "
      "and supports with a servo press, `force` of a [[support]] acts on elements, `absorb` "
      "takes waves up");
  EXPECT_EQ(
      told("dem3d", "[[bolt]]\nname = \"a\"\n"),
      "bolt is not a key of dem3d; fdem2d and fdem3d have it\n    bars with bond are bodies of "
      "shape \"rebar\"");
  EXPECT_EQ(told("dem3d", "body = [{ name = \"a\", weibull = { modulus = 4.0 } }]\n"),
            "body.a.weibull is not a key of dem3d; fdem2d and fdem3d have it");
  EXPECT_EQ(told("fdem2d", "links.range = 1.4\n"), "links is not a key of fdem2d; dem3d has it");
  // a word that the method has itself, in a table within
  EXPECT_EQ(told("fdem2d", "joint = { seam = { tension = 1e6 } }\n"),
            "joint.seam.tension is not a key; it belongs in joint.seam.strength");
  EXPECT_EQ(told("fdem3d", "body = [{ name = \"a\", modulus = 4.0 }]\n"),
            "body.a.modulus is not a key; it belongs in body.a.weibull");
  EXPECT_EQ(told("dem3d", "body = [{ count = 100 }]\n"),
            "body[0].count is not a key; it belongs in body[0].pack");
  EXPECT_EQ(told("dem3d", "[[bodi]]\nname = \"a\"\n"),
            "bodi is not a key; did you mean body? (corrected)");
}

}  // namespace check_command_test
}  // namespace breccia
