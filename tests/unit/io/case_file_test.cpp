#include "io/case/case_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>

#include "dem/setup/config.hpp"
#include "exec/error.hpp"
#include "paths.hpp"
#include "prepare/checks/check_case.hpp"
#include "run/case_keys.hpp"
#include "run/method/shown.hpp"

namespace breccia {
namespace case_file_test {

namespace fs = std::filesystem;

/// A case file that goes when the test ends.
class CaseText {
 public:
  explicit CaseText(const std::string& text) {
    std::string pattern = fs::temp_directory_path() / "breccia_case_XXXXXX";
    folder_ = ::mkdtemp(pattern.data());
    std::ofstream(path()) << text;
  }
  CaseText(const CaseText&) = delete;
  CaseText& operator=(const CaseText&) = delete;
  ~CaseText() { fs::remove_all(folder_); }
  std::string path() const { return folder_ / "case.toml"; }

 private:
  fs::path folder_;
};

/// A whole small case whose lines the tests change.
const std::string good = R"([time]
end = "1 ms"
[material.c30]
law = "concrete"
young = "30 GPa"
[[body]]
name = "slab"
material = "c30"
size = ["1 m", 1.0, "100 mm"]
pack = { count = 1000 }
)";

dem::Config read_text(const std::string& text, const std::vector<std::string>& overrides = {}) {
  const CaseText file(text);
  dem::Config config = read_case<dem::Config>(file.path(), overrides);
  dem::check_case(config);
  check_shown(config);
  return config;
}

std::string message_of(const std::string& text, const std::vector<std::string>& overrides = {}) {
  try {
    read_text(text, overrides);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no problem";
}

TEST(CaseFile, values_arrive_in_si) {
  const dem::Config config = read_text(good);
  EXPECT_EQ(config.time.end, 1e-3);
  EXPECT_EQ(config.materials.at(0).name, "c30");
  EXPECT_EQ(config.materials.at(0).young, 30e9);
  EXPECT_EQ(config.bodies.at(0).size.z, 0.1);
  EXPECT_EQ(config.bodies.at(0).pack.size_ratio, 2.0);
}

TEST(CaseFile, pictures_may_show_any_field_a_component_of_one_or_none) {
  for (const char* color : {"damage", "force", "velocity", "velocity_z", ""})
    EXPECT_EQ(message_of(good, {std::string("output.color=\"") + color + "\""}), "no problem");
  EXPECT_NE(message_of(good, {"output.color=velocity_w"}), "no problem");
}

TEST(CaseFile, overrides_count_last_and_find_items_by_name_or_number) {
  const dem::Config config =
      read_text(good, {"time.end=2e-3", "material.c30.young=28 GPa", "body.slab.pack.count=700",
                       "body.0.velocity=[0.0, 0.0, \"-30 m/s\"]", "title=two words"});
  EXPECT_EQ(config.time.end, 2e-3);
  EXPECT_EQ(config.materials.at(0).young, 28e9);
  EXPECT_EQ(config.bodies.at(0).pack.count, 700);
  EXPECT_EQ(config.bodies.at(0).velocity.z, -30.0);
  EXPECT_EQ(config.title, "two words");
}

TEST(CaseFile, the_completed_case_reads_back_to_the_same_case) {
  for (const char* name :
       {"/cases/rc_slab/case.toml", "/cases/rc_slab/rock.toml", "/cases/rc_slab/small.toml"}) {
    const std::string text =
        completed_case(read_case<dem::Config>(source_dir + std::string(name), {}));
    const CaseText file(text);
    EXPECT_EQ(completed_case(read_case<dem::Config>(file.path(), {})), text) << name;
  }
}

/// Visitor of each_key that gives every key a random value it may have.
struct AnyValues {
  std::mt19937& random;

  double between(double low, double high) {
    return low + (high - low) * (static_cast<double>(random()) / 4294967295.0);
  }
  double number(const Range& range) {
    if (!std::isinf(range.low) && !std::isinf(range.high))
      return between(range.low + 0.1 * (range.high - range.low),
                     range.high - 0.1 * (range.high - range.low));
    const int tens = static_cast<int>(random() % 20) - 10;  // lengths: from 1e-12 to 1e9 m
    const double size = between(0.1, 1.0) * std::pow(10.0, tens);
    if (std::isinf(range.low)) return random() % 2 == 0 ? -size : size;
    return range.low + size;
  }
  std::string word() {
    static const std::vector<std::string> parts{"c30", " ",      "\"", "\\", "[x]", ".",
                                                "#",   "\u00b5", "=",  "'",  "-",   "A_1"};
    std::string text = "w";
    for (std::size_t k = random() % 4; k > 0; --k) text += parts[random() % parts.size()];
    return text + "w" + std::to_string(random());
  }
  void operator()(const char*, double& value, const char*, const Range& range, const char*) {
    value = number(range);
  }
  template <class Integer>
  void operator()(const char*, Integer& value, const char*, const Range& range,
                  const char*) requires std::is_integral_v<Integer> {
    value =
        static_cast<Integer>(between(std::max(range.low, 1.0), std::min(range.high, 2147483647.0)));
  }
  void operator()(const char*, Vec2& value, const char*, const Range& range, const char*) {
    value = {number(range), number(range)};
  }
  void operator()(const char*, Vec3& value, const char*, const Range& range, const char*) {
    for (double* part : {&value.x, &value.y, &value.z})
      if (random() % 4 != 0) *part = number(range);
  }
  template <class Value>
  void operator()(const char*, OverTime<Value>& value, const char*, const Range& range,
                  const char*) {
    const auto some = [&] {
      if constexpr (std::is_same_v<Value, double>)
        return number(range);
      else
        return Vec3{number(range), number(range), number(range)};
    };
    value.value = some();
    for (std::size_t k = random() % 3; k > 0; --k) {
      value.times.push_back(static_cast<double>(value.times.size()) + between(0.0, 0.9));
      value.values.push_back(some());
    }
  }
  void operator()(const char*, std::vector<double>& value, const char*, const Range& range,
                  const char*) {
    value.resize(random() % 4);
    for (double& one : value) one = number(range);
  }
  void operator()(const char*, std::vector<Vec3>& value, const char*, const Range& range,
                  const char*) {
    value.resize(1 + random() % 4);
    for (Vec3& point : value) point = {number(range), number(range), number(range)};
  }
  void operator()(const char*, std::vector<Vec2>& value, const char*, const Range& range,
                  const char*) {
    value.resize(1 + random() % 4);
    for (Vec2& point : value) point = {number(range), number(range)};
  }
  void operator()(const char*, bool& value, const char*) { value = random() % 2 == 0; }
  void operator()(const char* name, std::string& value, const char*) {
    value = name == std::string("use") ? "" : word();  // a name of no material is a problem
  }
  void operator()(const char*, std::vector<std::string>& value, const char*) {
    value.assign(random() % 3, word());
  }
  void operator()(const char*, std::string& value, const OneOf& words, const char*) {
    value = words.words[random() % words.words.size()];
  }
  void required(const char*) {}
  template <class Config>
  void table(const char*, Config& config, const char*) {
    config.each_key(*this);
  }
  template <class Config>
  void list(const char*, std::vector<Config>& configs, const char*) {
    configs.resize(random() % 4);
    for (Config& config : configs) config.each_key(*this);
  }
  template <class Config>
  void named(const char* name, std::vector<Config>& configs, const char* meaning) {
    list(name, configs, meaning);
    for (Config& config : configs) config.name = word();
  }
};

TEST(CaseFile, the_completed_text_of_any_case_reads_back_to_the_same_case) {
  std::mt19937 random(5);
  for (int n = 0; n < 50; ++n) {
    dem::Config config;
    config.each_key(AnyValues{random});
    const std::string text = completed_case(config);
    const CaseText file(text);
    ASSERT_EQ(completed_case(read_case<dem::Config>(file.path(), {})), text);
  }
}

struct Wrong {
  const char* from;  ///< what of the good case is replaced; empty: appended
  const char* to;
  const char* message;
};

class WrongCase : public testing::TestWithParam<Wrong> {};

TEST_P(WrongCase, is_refused_by_name) {
  const Wrong& wrong = GetParam();
  std::string text = good;
  if (*wrong.from == '\0')
    text += wrong.to;
  else
    text.replace(text.find(wrong.from), std::string(wrong.from).size(), wrong.to);
  const std::string message = message_of(text);
  EXPECT_NE(message.find(wrong.message), std::string::npos) << message;
  EXPECT_NE(message.find("nothing was run"), std::string::npos) << message;
}

INSTANTIATE_TEST_SUITE_P(
    Table, WrongCase,
    testing::Values(
        Wrong{"end = \"1 ms\"", "", "time.end is missing; it has no default"},
        Wrong{"[time]\nend = \"1 ms\"\n", "", "time.end is missing"},
        Wrong{"end = \"1 ms\"", "end = 0.0", "line 2, time.end = 0 is outside > 0"},
        Wrong{"end = \"1 ms\"", "end = -1.0", "time.end = -1 is outside > 0"},
        Wrong{"end = \"1 ms\"", "end = \"-1 ms\"", "time.end = \"-1 ms\" is outside > 0 s"},
        Wrong{"end = \"1 ms\"", "end = nan", "time.end is not a finite number"},
        Wrong{"end = \"1 ms\"", "end = inf", "time.end is not a finite number"},
        Wrong{"end = \"1 ms\"", "end = 1e999", "line 2, column"},
        Wrong{"end = \"1 ms\"", "end = \"1 mm\"", "\"1 mm\" is a length, a time is wanted, in s"},
        Wrong{"end = \"1 ms\"", "end = \"1\"", "\"1\" has no unit"},
        Wrong{"end = \"1 ms\"", "end = \"ms\"", "\"ms\" does not start with a number"},
        Wrong{"end = \"1 ms\"", "end = \"1 furlong\"", "'furlong' is not a unit"},
        Wrong{"end = \"1 ms\"", "end = true",
              "time.end wants a number in s or a text with a unit, not true"},
        Wrong{"end = \"1 ms\"", "end = \"1 ms\"\nend = 2.0", "line 3"},
        Wrong{"end = \"1 ms\"", "end = \"1 ms\"\nsafety = 1.5",
              "time.safety = 1.5 is outside (0, 1]"},
        Wrong{"end = \"1 ms\"", "end = \"1 ms\"\nsafty = 0.5",
              "line 3, time.safty is not a key; did you mean safety?"},
        Wrong{"end = \"1 ms\"", "end = \"1 ms\"\nevaluate_every = 1.5",
              "time.evaluate_every wants an integer"},
        Wrong{"end = \"1 ms\"", "end = \"1 ms\"\nevaluate_every = -1",
              "time.evaluate_every = -1 is outside [0, 1000]"},
        Wrong{"end = \"1 ms\"", "end = \"1 ms", "line 2, column"},
        Wrong{"[time]", "method = \"fdem9d\"\n[time]", "method = \"fdem9d\" is not one of dem3d"},
        Wrong{"[time]", "breccia = 2\n[time]", "breccia = 2 is outside [1, 1]"},
        Wrong{"[time]", "gravity = 9.81\n[time]", "gravity wants three numbers"},
        Wrong{"[time]", "gravity = [0.0, 0.0, \"9.81 m/s\"]\n[time]",
              "gravity[2]: \"9.81 m/s\" is a velocity, an acceleration is wanted"},
        Wrong{"[time]", "time = 3\n[tim]", "time wants a table, not an integer"},
        Wrong{"[time]", "[tiem]\nx = 1\n[time]", "tiem is not a key; did you mean time?"},
        Wrong{"law = \"concrete\"", "law = \"beton\"",
              "material.c30.law = \"beton\" is not one of concrete"},
        Wrong{"young = \"30 GPa\"", "young = \"30 GN\"",
              "material.c30.young: \"30 GN\" is a force, a pressure is wanted, in Pa"},
        Wrong{"young = \"30 GPa\"", "density = 0.0",
              "line 5, material.c30.density = 0 is outside [10, 1000000]"},
        Wrong{"young = \"30 GPa\"", "poisson = 0.5",
              "material.c30.poisson = 0.5 is outside (-1, 0.5)"},
        Wrong{"young = \"30 GPa\"", "poisson = 0.3", "above 1 / alpha"},
        Wrong{"young = \"30 GPa\"", "tensile_strenght = 1e6", "did you mean tensile_strength?"},
        Wrong{"young = \"30 GPa\"", "rho = 2400.0", "rho is not a key; did you mean density?"},
        Wrong{"young = \"30 GPa\"", "friction_angle = \"30 mm\"",
              "is a length, an angle is wanted"},
        Wrong{"young = \"30 GPa\"", "shear = \"ductile\"", "is not one of plastic | brittle"},
        Wrong{"name = \"slab\"", "", "body[0].name is missing"},
        Wrong{"material = \"c30\"", "", "body.slab.material is missing"},
        Wrong{"material = \"c30\"", "material = \"c35\"",
              "body.slab.material = \"c35\" is not a material; there are: c30"},
        Wrong{"material = \"c30\"", "material = \"c30\"\nshape = \"sphere\"\nradius = -0.1",
              "body.slab.radius = -0.1 is outside [0, 1e+09] m"},
        Wrong{"material = \"c30\"", "material = \"c30\"\nshape = \"sphere\"",
              "body.slab.radius must be above 0"},
        Wrong{"material = \"c30\"", "material = \"c30\"\nshape = \"file\"",
              "body.slab.file is missing"},
        Wrong{"size = [\"1 m\", 1.0, \"100 mm\"]", "shape = \"file\"\nfile = \"a.csv\"",
              "body.slab.volume is missing"},
        Wrong{"size = [\"1 m\", 1.0, \"100 mm\"]", "",
              "body.slab.size needs three lengths above 0"},
        Wrong{"size = [\"1 m\", 1.0, \"100 mm\"]", "size = [1.0, 1.0]",
              "body.slab.size wants three numbers"},
        Wrong{"pack = { count = 1000 }", "", "body.slab.pack.count is missing"},
        Wrong{"pack = { count = 1000 }", "pack = {}", "body.slab.pack.count is missing"},
        Wrong{"pack = { count = 1000 }", "pack = { count = 0 }", "body.slab.pack.count is missing"},
        Wrong{"pack = { count = 1000 }", "pack = { count = -1 }",
              "body.slab.pack.count = -1 is outside [0, "},
        Wrong{"pack = { count = 1000 }", "pack = { count = 1000, compactness = 0.9 }",
              "compactness = 0.9 is outside [0.05, 0.64]"},
        Wrong{"[[body]]", "[body]", "body wants a list of tables, each headed [[body]]"},
        Wrong{"", "[[body]]\nname = \"slab\"\nmaterial = \"c30\"\n",
              "body has two items named slab"},
        Wrong{"",
              "[[body]]\nname = \"rock\"\nmaterial = \"c30\"\nshape = \"sphere\"\nradius = "
              "0.1\ncenter = [0.0, 0.0, 0.1]\npack = { count = 900 }\n",
              "body.slab and body.rock overlap at the start"},
        Wrong{"name = \"slab\"", "name = \"\"", "body: \"\" cannot be a name"},
        Wrong{"name = \"slab\"", "name = \"a\\u001b[31m\"",
              "body: \"a\\x1b[31m\" cannot be a name"},
        Wrong{"[material.c30]", "[material.\" c30\"]", "material: \" c30\" cannot be a name"},
        Wrong{"[time]", "\"a\\u001b\" = 1\n[time]", "line 1, a\\x1b is not a key"},
        Wrong{"young = \"30 GPa\"", "young = \"30 GN\"", "; try \"30 GPa\""},
        Wrong{"",
              "[[body]]\nname = \"rod\"\nmaterial = \"c30\"\nshape = \"cylinder\"\nradius = 0.1\n"
              "length = 1.0\ncenter = [0.59, 0.0, 0.5]\npack = { count = 900 }\n",
              "body.slab and body.rod overlap at the start"},
        Wrong{"", "[[support]]\nname = \"slab\"\n", "support.slab and body.slab have one name"},
        Wrong{"", "[[check]]\nname = \"c\"\nvalue = \"probe.rok.last\"\n",
              "check.c.value = \"probe.rok.last\" is not of a probe; there are: none"},
        Wrong{"", "[[probe]]\nname = \"p\"\n[[check]]\nname = \"c\"\nvalue = \"probe.p.mean\"\n",
              "check.c.value = \"probe.p.mean\" must end in .last, .min, .max or .at"},
        Wrong{"", "[[probe]]\nname = \"p\"\n[[check]]\nname = \"c\"\nvalue = \"probe.p.at\"\n",
              "check.c.value = \"probe.p.at\" needs `at`, the time when it is read"},
        Wrong{"", "[[check]]\nname = \"c\"\nvalue = \"energy.work\"\nat = 0.1\n",
              "check.c.at is of a value probe.<name>.at; it is \"energy.work\""},
        Wrong{"",
              "[[probe]]\nname = \"p\"\n[[check]]\nname = \"c\"\nvalue = \"probe.p.at\"\nat = "
              "1e9\n",
              "check.c.at = 1e+09 s: the case ends at"},
        Wrong{"", "[[check]]\nname = \"c\"\nvalue = \"energy.eror_relative\"\n",
              "check.c.value = \"energy.eror_relative\" is no number of summary.json; did you mean "
              "energy.error_relative?"},
        Wrong{"", "[[check]]\nname = \"c\"\nvalue = \"model.elements_by_group.slap\"\n",
              "did you mean model.elements_by_group.slab?"},
        Wrong{"", "[[check]]\nname = \"c\"\nvalue = \"status\"\n",
              "check.c.value = \"status\" is no number of summary.json"},
        Wrong{"", "[[probe]]\nname = \"press\"\n[output]\ncurves = [\"press over pres\"]\n",
              "output.curves = \"press over pres\": pres is no probe; did you mean press?"},
        Wrong{"", "[output]\ncurves = [\"press\"]\n",
              "output.curves = \"press\" is not of the form \"force over deflection\""},
        Wrong{"", "[output]\ncolor = \"damgae\"\n",
              "output.color = \"damgae\" is no field of the frames; allowed are damage, force, "
              "group, id, kind, spin[_x, _y, _z], state, velocity[_x, _y, _z], and \"\" for none"},
        Wrong{"", "[[support]]\nname = \"s\"\n[output]\ncolor = \"hled\"\n",
              "allowed are damage, force, group, held, id, "},
        Wrong{"", "[[[support]]]\nname = \"s\"\n", "line 11, column 3"},
        Wrong{"", "[[support]]\nname = \"s\"\non = \"slap\"\n",
              "support.s.on = \"slap\" is not a body; there are: slab; did you mean slab?"},
        Wrong{"", "[[support]]\nname = \"s\"\nfix = [\"w\"]\n", "\"w\" is no degree of freedom"},
        Wrong{"", "[[support]]\nname = \"s\"\nfix = \"x\"\n",
              "support.s.fix wants a list of texts"},
        Wrong{"", "[[wall]]\nname = \"w\"\nnormal = [0.0, 0.0, 0.0]\n",
              "wall.w.normal has length 0"},
        Wrong{"", "[[wall]]\nname = \"floor\"\n[[probe]]\nname = \"p\"\non = \"flor\"\n",
              "probe.p.on = \"flor\" is neither a body (slab) nor a support (none) nor a wall "
              "(floor); did you mean floor?"},
        Wrong{"", "[[probe]]\nname = \"p\"\non = \"rock\"\n",
              "probe.p.on = \"rock\" is neither a body (slab) nor a support"},
        Wrong{"", "[[probe]]\nname = \"p\"\nquantity = \"velocityz\"\n",
              "did you mean velocity_z?"}));

TEST(CaseFile, a_case_without_bodies_has_no_elements) {
  EXPECT_NE(message_of("[time]\nend = 1.0\n").find("the case has no elements"), std::string::npos);
}

TEST(CaseFile, a_missing_file_and_a_wrong_override_are_named) {
  EXPECT_THROW(read_case<dem::Config>("/nowhere/case.toml", {}), InputError);
  EXPECT_NE(message_of(good, {"time.end"}).find("--set time.end is not of the form KEY=VALUE"),
            std::string::npos);
  EXPECT_NE(message_of(good, {"time.safety=2"}).find("--set time.safety = 2 is outside"),
            std::string::npos);
  EXPECT_NE(message_of(good, {"body.rock.radius=2"}).find("body has no item 'rock'"),
            std::string::npos);
}

TEST(CaseFile, an_override_changes_what_the_case_states_and_adds_nothing_unseen) {
  EXPECT_NE(message_of(good, {"material.c3O.young=28 GPa"})
                .find("--set material.c3O is not in the case; did you mean c30?"),
            std::string::npos);
  EXPECT_NE(
      message_of(good, {"body.slab=3"}).find("name one of its keys, as in body.slab.KEY=VALUE"),
      std::string::npos);
  EXPECT_NE(message_of(good, {"title=\xff"}).find("--set title: "), std::string::npos);
  const dem::Config config = read_text(good, {"material.c35={ young = \"33 GPa\" }"});
  EXPECT_EQ(config.materials.size(), 2u);
}

/// A body beside the slab's corner at (0.5, 0.5), as high as the slab.
std::string slab_and(const std::string& body) {
  return good + "[[body]]\nname = \"other\"\nmaterial = \"c30\"\npack = { count = 900 }\n" + body;
}

TEST(CaseFile, bodies_that_only_touch_do_not_overlap) {
  for (const char* body :
       {"shape = \"cylinder\"\nradius = 0.1\nlength = 1.0\ncenter = [0.6, 0.0, 0.0]\n",
        "shape = \"cylinder\"\nradius = 0.1\nlength = 1.0\ncenter = [0.0, 0.0, 0.55]\n",
        "shape = \"cylinder\"\nradius = 0.1\nlength = 1.0\ncenter = [0.58, 0.58, 0.0]\n",
        "shape = \"sphere\"\nradius = 0.1\ncenter = [0.0, 0.0, 0.15]\n",
        "shape = \"sphere\"\nradius = 0.1\ncenter = [0.56, 0.56, 0.11]\n",
        "size = [1.0, 1.0, 0.1]\ncenter = [1.0, 0.0, 0.0]\n"})
    EXPECT_EQ(message_of(slab_and(body)), "no problem") << body;
  for (const char* body :
       {"shape = \"cylinder\"\nradius = 0.1\nlength = 1.0\ncenter = [0.599, 0.0, 0.0]\n",
        "shape = \"cylinder\"\nradius = 0.1\nlength = 1.0\ncenter = [0.0, 0.0, 0.549]\n",
        "shape = \"cylinder\"\nradius = 0.1\nlength = 1.0\ncenter = [0.57, 0.57, 0.0]\n",
        "shape = \"sphere\"\nradius = 0.1\ncenter = [0.0, 0.0, 0.149]\n",
        "shape = \"sphere\"\nradius = 0.1\ncenter = [0.55, 0.55, 0.11]\n",
        "size = [1.0, 1.0, 0.1]\ncenter = [0.999, 0.0, 0.0]\n"})
    EXPECT_NE(message_of(slab_and(body)).find("overlap at the start"), std::string::npos) << body;
}

TEST(CaseFile, all_problems_are_told_at_once_in_the_order_of_lines) {
  std::string text = good;
  text.replace(text.find("30 GPa"), 6, "30 GN");
  const std::string message = message_of(text + "[[probe]]\nnam = 3\n[serch]\n");
  EXPECT_TRUE(message.starts_with("4 problems in ")) << message;
  EXPECT_LT(message.find("line 5"), message.find("line 12"));
}

TEST(CaseFile, a_slip_in_each_of_many_items_is_told_twenty_times) {
  std::string text = good;
  for (int n = 0; n < 5000; ++n) text += "[[body]]\n";
  const std::string message = message_of(text + "[serch]\n");
  EXPECT_TRUE(message.starts_with("10001 problems in ")) << message.substr(0, 100);
  EXPECT_NE(message.find("... and 9960 more"), std::string::npos) << message;
  EXPECT_NE(message.find("serch"), std::string::npos);
  EXPECT_EQ(std::count(message.begin(), message.end(), '\n'), 42);
}

TEST(CaseFile, what_is_no_toml_is_told_in_plain_words) {
  const auto told = [](const std::string& text, const std::string& words) {
    return message_of(text).find(words) != std::string::npos;
  };
  EXPECT_TRUE(told("a = 1.0\na = 2.0\n", "line 2, column 5: a is given twice"));
  for (const char* value : {"7ms", "7.5ms", "-25mm", "1e3Pa", "30\u00b0"})
    EXPECT_TRUE(told(std::string("a = ") + value + "\n", "written in quotes, as in \"40 mm\""))
        << value;
  EXPECT_TRUE(told("[time]\n[time]\n", "line 2, column 1: time is given twice"));
  EXPECT_TRUE(told("a = 1\n b = 7ms\n", "\"40 mm\"\n       2 |  b = 7ms\n         |       ^"));
  EXPECT_TRUE(told("[wall]\n[[wall]]\n", "wall is given both as [wall] and as [[wall]]; write "));
  EXPECT_TRUE(told("a = [1, 2\n", "line 1, column 11: array: the file ends before it does"));
  EXPECT_TRUE(told("[time\nend = 1.0\n", "expected ']', but the line ends"));
  EXPECT_TRUE(told("a = 40 mm\n", "in quotes, as in \"40 mm\""));
  EXPECT_TRUE(told("a = Rock\n", "in quotes, as in \"rock\""));
  EXPECT_TRUE(told("a = \"rock\nb = 2\n", "ends with a quote in the line"));
}

/// A word with one letter changed, dropped or added.
std::string mistyped(std::string word, std::mt19937& random) {
  const std::size_t at = random() % word.size();
  const char letter = static_cast<char>('a' + random() % 26);
  switch (random() % 3) {
    case 0:
      word[at] = letter;
      return word;
    case 1:
      return word.erase(at, 1);
    default:
      return word.insert(at, 1, letter);
  }
}

TEST(CaseFile, a_letter_typed_wrong_leads_to_the_right_key) {
  std::mt19937 random(11);
  int right = 0, tried = 0;
  for (const char* table : {"material.c30.", "time.", "output.", "body.slab.", "contact."}) {
    const std::string head = table, list = head.substr(0, head.find('.'));
    const std::string prefix = list == "material" ? "material.<name>."
                               : list == "body"   ? "body[]."
                                                  : head;
    for (const KeyInfo& info : list_keys<dem::Config>(prefix)) {
      const std::string key = info.path.substr(prefix.size());
      if (key.size() < 4 || key.find('.') != std::string::npos) continue;
      for (int n = 0; n < 4; ++n) {
        const std::string message = message_of(good, {head + mistyped(key, random) + "=1"});
        if (message.find("is not a key") == std::string::npos) continue;
        ++tried;
        if (message.find("did you mean " + key + "?") != std::string::npos) ++right;
      }
    }
  }
  EXPECT_GT(tried, 100);
  EXPECT_GE(right, 95 * tried / 100) << right << " of " << tried;
}

TEST(CaseFile, cases_are_named_by_folder_and_file) {
  EXPECT_EQ(case_name("cases/rc_slab/case.toml"), "rc_slab");
  EXPECT_EQ(case_name(std::string(source_dir) + "/cases/rc_slab/small.toml"), "rc_slab_small");
  EXPECT_EQ(case_name(std::string(source_dir) + "/cases/rc_slab"), "rc_slab");
  EXPECT_EQ(case_folder("cases/rc_slab/small.toml"), "cases/rc_slab");
}

TEST(CaseFile, keys_and_values_remain_without_comments) {
  EXPECT_EQ(without_comments("a = 1  # [-] one\n# of two\nb = \"# \\\"#\" # three \"\nc = 4"),
            "a = 1  \n\nb = \"# \\\"#\" \nc = 4");
}

TEST(CaseFile, the_digest_is_sha_256) {
  EXPECT_EQ(case_digest("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(case_digest(std::string(1000, 'a')),
            "41edece42d63e8d9bf515a9ba6932e1c20cbc9f5a5d134645adb5db1b9737ea3");
}

}  // namespace case_file_test
}  // namespace breccia
