// Materials by name: their numbers follow from the sources that they name, and cases may use them.

#include "io/case/material_library.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "dem/setup/config.hpp"
#include "exec/error.hpp"
#include "fdem/setup/config.hpp"
#include "run/case_keys.hpp"

namespace breccia {
namespace material_library_test {

std::string case_with(const std::string& method, const std::string& keys) {
  return "breccia = 1\nmethod = \"" + method + "\"\n[time]\nend = 1.0\n[material.m]\n" + keys;
}
template <class Config>
Config read(const std::string& keys, const std::vector<std::string>& overrides = {}) {
  const char* const method = std::is_same_v<Config, dem::Config> ? "dem3d" : "fdem2d";
  return read_case<Config>(CaseText{case_with(method, keys), "case.toml"}, overrides);
}

double target(const std::string& material, const std::string& name) {
  for (const MaterialTarget& t : named_material(material)->targets)
    if (t.name == name) return t.value;
  return std::nan("");
}

TEST(NamedMaterials, ConcretesHaveTheMeanValuesOfModelCode2010) {
  for (const double f_ck : {20.0, 30.0, 40.0, 60.0, 100.0}) {
    const std::string name = "C" + std::to_string(static_cast<int>(f_ck));
    const double f_cm = f_ck + 8.0;
    const double f_ctm =
        f_ck <= 50.0 ? 0.3 * std::pow(f_ck, 2.0 / 3.0) : 2.12 * std::log(1.0 + 0.1 * f_cm);
    EXPECT_NEAR(target(name, "compression"), 1e6 * f_cm, 1.0) << name;
    EXPECT_NEAR(target(name, "tension"), 1e6 * f_ctm, 6e3) << name;
    EXPECT_NEAR(target(name, "young"), 21.5e9 * std::cbrt(f_cm / 10.0), 6e7) << name;
    EXPECT_NEAR(target(name, "fracture_energy"), 73.0 * std::pow(f_cm, 0.18), 0.6) << name;
  }
}

TEST(NamedMaterials, TellTheirSourceAndHowLocalNumbersWereFoundAndReadWithoutAProblem) {
  EXPECT_GE(named_materials().size(), 13U);
  for (const NamedMaterial& material : named_materials()) {
    EXPECT_FALSE(material.source.empty()) << material.name;
    EXPECT_FALSE(material.blocks.empty()) << material.name;
    for (const MaterialBlock& block : material.blocks) {
      EXPECT_FALSE(block.record.empty()) << material.name;
      const std::string use = "use = \"" + material.name + "\"\n";
      if (block.method == "dem3d") {
        // of packings: what calibration makes of it
        const double young = target(material.name, "young");
        EXPECT_NEAR(read<dem::Config>(use).materials[0].young, young, 0.03 * young);
        EXPECT_NO_THROW(read<dem::Config>(block.keys)) << block.keys;
      } else {
        // The closed-form start is the target itself; joints make the rock softer, so that what
        // calibration finds is above it.
        const double young = target(material.name, "young"),
                     given = read<fdem::Config>(use).materials[0].young;
        if (block.record.starts_with("calibrated")) {
          EXPECT_GT(given, 1.05 * young) << material.name;
          EXPECT_LT(given, 1.15 * young) << material.name;
        } else {
          EXPECT_NEAR(given, young, 1.0) << material.name;
        }
        EXPECT_NO_THROW(read<fdem::Config>(block.keys)) << block.keys;
      }
    }
  }
}

TEST(NamedMaterials, KeysOfTheCaseAndOfTheCommandLineTakeTheirPlace) {
  const dem::Config c =
      read<dem::Config>("use = \"C30\"\ndensity = 2450.0\n", {"material.m.cohesion=9 MPa"});
  EXPECT_EQ(c.materials[0].density, 2450.0);
  EXPECT_EQ(c.materials[0].cohesion, 9e6);
  EXPECT_EQ(c.materials[0].fabric, "faces");
  const fdem::Config f = read<fdem::Config>("use = \"C30\"\njoint = { tension = \"2 MPa\" }\n");
  EXPECT_EQ(f.materials[0].joint.tension, 2e6);
  EXPECT_NEAR(f.materials[0].joint.cohesion, 10.18e6, 1e5);  // of C30, beside the own tension
}

TEST(NamedMaterials, TheCompletedCaseHoldsTheFullNumbers) {
  const dem::Config c = read<dem::Config>("use = \"C30\"\n");
  const std::string text = completed_case(c);
  EXPECT_NE(text.find("use = \"C30\""), std::string::npos);
  EXPECT_NE(text.find("fracture_energy = 141"), std::string::npos) << text;
  EXPECT_EQ(completed_case(read_case<dem::Config>(CaseText{text, "case.toml"}, {})), text);
}

std::string problem(const std::string& method, const std::string& keys) {
  try {
    const CaseText text{case_with(method, keys), "case.toml"};
    if (method == "dem3d")
      read_case<dem::Config>(text, {});
    else
      read_case<fdem::Config>(text, {});
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(NamedMaterials, OfferTheRocksThatAWordIsPartOf) {
  EXPECT_NE(problem("fdem2d", "use = \"granite\"")
                .find("\"granite\" is no material of the program; did you mean "
                      "granite-lac-du-bonnet or granite-pikes-peak?"),
            std::string::npos)
      << problem("fdem2d", "use = \"granite\"");
}

TEST(NamedMaterials, NamesTheLineOfAMaterialThatThereIsNot) {
  EXPECT_NE(
      problem("dem3d", "use = \"C31\"")
          .find(
              "line 6, material.m.use = \"C31\" is no material of the program; did you mean C30?"),
      std::string::npos)
      << problem("dem3d", "use = \"C31\"");
  EXPECT_NE(problem("dem3d", "use = \"sandstone-berea\"").find("has no numbers for method dem3d"),
            std::string::npos);
  EXPECT_NE(problem("dem3d", "use = 3").find("use wants a text"), std::string::npos);
}

std::vector<std::string> notes(const std::string& keys, const std::vector<std::string>& overrides,
                               const std::string& method = "dem3d") {
  return CaseReader(CaseText{case_with(method, keys), "case.toml"}, overrides).notes();
}

TEST(NamedMaterials, TellWhichOwnKeysStandInTheirPlaceAndWhere) {
  EXPECT_EQ(
      notes("use = \"C30\"\ndensity = 2450.0\nyoung = \"33930 MPa\"\n", {}),
      (std::vector<std::string>{
          "material.m uses C30 but for its own keys: density = 2450.0 (line 7; C30: 2400.0)"}));
  EXPECT_EQ(notes("use = \"C30\"\n", {"material.m.cohesion=9 MPa"}),
            (std::vector<std::string>{"material.m uses C30 but for its own keys: cohesion = \"9 "
                                      "MPa\" (--set; C30: \"20.1 MPa\")"}));
  EXPECT_EQ(notes("use = \"C30\"\njoint = { tension = \"2 MPa\" }\n", {}, "fdem2d"),
            (std::vector<std::string>{"material.m uses C30 but for its own keys: joint.tension = "
                                      "\"2 MPa\" (line 7; C30: \"2.905 MPa\")"}));
  const std::string whole = completed_case(read<dem::Config>("use = \"C30\"\n"));
  EXPECT_TRUE(CaseReader(CaseText{whole, "case.toml"}, {}).notes().empty());
}

TEST(NamedMaterials, ByTheCommandLineTakeThePlaceOfTheWholeMaterialOfTheFile) {
  const std::string own = "law = \"concrete\"\nyoung = \"30 GPa\"\nsoftening = 10.0\n";
  const std::vector<std::string> overrides{"material.m.use=C60", "material.m.density=2450"};
  const dem::Config c = read<dem::Config>(own, overrides);
  dem::Config same = read<dem::Config>("use = \"C60\"\ndensity = 2450.0\n");
  EXPECT_EQ(completed_case(c), completed_case(same));
  const std::vector<std::string> told = notes(own, overrides);
  ASSERT_EQ(told.size(), 2U);
  EXPECT_EQ(told[0],
            "material.m.use = \"C60\" by --set takes the place of what the file says of this "
            "material, lines 6 to 8: law, softening, young");
  EXPECT_EQ(told[1],
            "material.m uses C60 but for its own keys: density = 2450 (--set; C60: "
            "2400.0)");
  // A file that has `use` means the keys beside it.
  EXPECT_EQ(read<dem::Config>("use = \"C30\"\ndensity = 2450.0\n", {"material.m.use=C60"})
                .materials[0]
                .density,
            2450.0);
}

TEST(NamedMaterials, ByTheCommandLineTakeThePlaceOfTablesOfTheFile) {
  const fdem::Config f =
      read<fdem::Config>("joint = { tension = \"2 MPa\", cohesion = \"9 MPa\" }\n",
                         {"material.m.use=C30", "material.m.joint.cohesion=8 MPa"});
  EXPECT_EQ(f.materials[0].joint.tension, 2.905e6);
  EXPECT_EQ(f.materials[0].joint.cohesion, 8e6);
}

}  // namespace material_library_test
}  // namespace breccia
