// Models of whole cases: counts, masses, motion, reinforcement, order in memory, refused cases.

#include "prepare/build.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>

#include "exec/error.hpp"
#include "math/constants.hpp"
#include "prepare/packing/packing.hpp"
#include "prepare/packing/rebar.hpp"
#include "unit/prepare/models.hpp"

namespace breccia::dem {
namespace build_test {

int count_of(const Model& m, int group) {
  return static_cast<int>(std::count(m.group.begin(), m.group.end(), group));
}

double mass_of(const Model& m, int group) {
  double sum = 0.0;
  for (std::size_t i = 0; i < m.mass.size(); ++i)
    if (m.group[i] == group) sum += m.mass[i];
  return sum;
}

/// The message of the InputError that building throws; empty if none.
std::string refusal(const Config& config) {
  try {
    build_model(config, ".");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

bool mentions(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// Without the links between them grains hang together by themselves, and nothing else does.
TEST(Build, BoundariesOfGrainsPartAllOfThem) {
  Config config = case_with_materials();
  MaterialConfig seam = config.materials[0];
  seam.name = "seam";
  config.materials.push_back(seam);
  BodyConfig box = box_body("rock", {0.1, 0.1, 0.1}, 4000, 0.6);
  box.grains = {"voronoi", 0.05, "seam"};
  config.bodies = {box};
  const Model m = build_model(config, ".");
  std::vector<std::size_t> root(m.position.size());
  for (std::size_t e = 0; e < root.size(); ++e) root[e] = e;
  const auto find = [&](Index element) {
    auto e = static_cast<std::size_t>(element);
    while (root[e] != e) e = root[e] = root[root[e]];
    return e;
  };
  std::size_t between = 0;
  for (const Model::Link& link : m.links)
    if (link.material == 4)
      ++between;
    else
      root[find(link.a)] = find(link.b);
  EXPECT_GT(between, m.links.size() / 20);
  EXPECT_LT(between, m.links.size() / 2);
  std::map<std::size_t, int> elements;
  for (Index e = 0; e < m.size(); ++e) ++elements[find(e)];
  // 8 cubes of edge `size` in the box, and grains whose seeds lie beside it.
  EXPECT_GE(elements.size(), 8U);
  EXPECT_LT(elements.size(), 64U);
  for (const auto& [grain, count] : elements) EXPECT_LT(count, 4000 / 2);
  int within = 0;
  for (const Model::Link& link : m.links)
    within += link.material == 4 && find(link.a) == find(link.b) ? 1 : 0;
  EXPECT_EQ(within, 0);
  config.bodies[0].grains.boundary = {};
  config.bodies[0].grains.kind = {};
  config.bodies[0].grains.size = 0.0;
  const Model even = build_model(config, ".");
  ASSERT_EQ(even.links.size(), m.links.size());
  for (const Model::Link& link : even.links) EXPECT_EQ(link.material, 0);
}

TEST(Build, BoundariesOfGrainsNeedAMaterialOfTheBodysLaw) {
  Config config = case_with_materials();
  BodyConfig box = box_body("rock", {0.1, 0.1, 0.1}, 400, 0.6);
  box.grains = {"voronoi", 0.0, "seam"};
  config.bodies = {box};
  EXPECT_TRUE(mentions(refusal(config), "grains.size must be above 0 for Voronoi grains"));
  EXPECT_TRUE(mentions(refusal(config),
                       "grains.boundary = \"seam\" is no material; there are: "
                       "c30, b500, bond, gravel"));
  config.bodies[0].grains = {"voronoi", 0.05, "b500"};
  EXPECT_TRUE(mentions(refusal(config),
                       "grains.boundary = \"b500\" is of law steel, and links of "
                       "rock are of law concrete"));
}

void expect_counts_of_the_paper(const Model& m) {
  EXPECT_EQ(m.groups, (std::vector<std::string>{"slab", "steel", "impactor"}));
  EXPECT_EQ(m.size(), 14274);
  EXPECT_EQ(count_of(m, 0), 12718);
  EXPECT_EQ(count_of(m, 1), 784);
  EXPECT_EQ(count_of(m, 2), 772);
  EXPECT_NEAR(static_cast<double>(m.links.size()), 79211, 2);
  EXPECT_GT(m.interaction_range, 1.40);
  EXPECT_LT(m.interaction_range, 1.46);
}

void expect_mass_of_the_bulk(const Model& m) {
  const double bar_area = pi * 0.008 * 0.008 / 4.0, bar_length = 28 * (1.0 - 0.008);
  EXPECT_NEAR(mass_of(m, 0), 2400.0 * (0.1 - bar_area * bar_length), 1e-9);
  EXPECT_NEAR(mass_of(m, 1), 7850.0 * bar_area * bar_length, 1e-9);
  EXPECT_NEAR(mass_of(m, 2), 2400.0 * 4.0 / 3.0 * pi * 0.113 * 0.113 * 0.113, 1e-9);
}

void expect_elements_of_one_size(const Model& m) {
  double sum[3] = {};
  for (std::size_t i = 0; i < m.radius.size(); ++i) sum[m.group[i]] += m.radius[i];
  EXPECT_NEAR(sum[2] / 772 / (sum[0] / 12718), 1.0, 0.02);
}

void expect_free_bars_and_no_overlap(const Model& m) {
  const auto bars = prepare::bars_through(slab_of_the_paper().bodies[1].rebar, {1.0, 1.0, 0.1});
  ASSERT_EQ(bars.size(), 28U);
  double deepest = 0.0, outside = 0.0;
  for (std::size_t i = 0; i < m.position.size(); ++i) {
    if (m.group[i] != 0) continue;
    const Vec3 p = m.position[i];
    for (const prepare::Bar& bar : bars)
      deepest = std::max(
          deepest, (m.radius[i] + bar.radius - norm(prepare::from_axis(bar, p))) / m.radius[i]);
    outside = std::max({outside, std::abs(p.x) + m.radius[i] - 0.5,
                        std::abs(p.y) + m.radius[i] - 0.5, std::abs(p.z) + m.radius[i] - 0.05});
  }
  EXPECT_LE(deepest, prepare::overlap_tolerance);
  EXPECT_LE(outside, 1e-12);
  double worst = 0.0;
  for (const Model::Link& link : m.links) {
    const auto a = static_cast<std::size_t>(link.a), b = static_cast<std::size_t>(link.b);
    const double touching = m.radius[a] + m.radius[b];
    worst = std::max(worst, (touching - norm(m.position[b] - m.position[a])) /
                                std::min(m.radius[a], m.radius[b]));
  }
  EXPECT_LE(worst, prepare::overlap_tolerance);
}

void expect_chains_of_equal_spacing(const Model& m) {
  const double spacing = (1.0 - 0.008) / 27.0;
  const double whole = 7850.0 * pi * 0.008 * 0.008 / 4.0 * spacing;
  int chains = 0;
  for (Index i = 0; i < m.size(); ++i) {
    const auto e = static_cast<std::size_t>(i);
    if (m.group[e] != 1) {
      ASSERT_TRUE(m.bar_previous[e] == -1 && m.bar_next[e] == -1);
      continue;
    }
    EXPECT_EQ(m.radius[e], 0.004);
    const bool end = m.bar_previous[e] < 0 || m.bar_next[e] < 0;
    EXPECT_NEAR(m.mass[e], end ? 0.5 * whole : whole, 1e-12);
    EXPECT_NEAR(m.inertia[e], m.mass[e] * (spacing * spacing / 12.0 + 0.008 * 0.008 / 16.0), 1e-15);
    if (m.bar_previous[e] >= 0) continue;
    ++chains;
    int length = 1;
    for (Index at = i; m.bar_next[static_cast<std::size_t>(at)] >= 0; ++length) {
      const Index next = m.bar_next[static_cast<std::size_t>(at)];
      ASSERT_EQ(m.bar_previous[static_cast<std::size_t>(next)], at);
      const Vec3 step =
          m.position[static_cast<std::size_t>(next)] - m.position[static_cast<std::size_t>(at)];
      EXPECT_NEAR(norm(step), spacing, 1e-12);
      at = next;
    }
    EXPECT_EQ(length, 28);
  }
  EXPECT_EQ(chains, 28);
}

void expect_crossing_bars_to_touch(const Model& m) {
  const auto bars = prepare::bars_through(slab_of_the_paper().bodies[1].rebar, {1.0, 1.0, 0.1});
  const double depth[4] = {-0.030, -0.022, 0.030, 0.022};  // outer and inner, bottom and top
  for (std::size_t k = 0; k < bars.size(); ++k) {
    EXPECT_NEAR(bars[k].a.z, depth[k / 7], 1e-15);
    EXPECT_EQ(bars[k].a.z, bars[k].b.z);
  }
  double least = 1.0;
  for (std::size_t i = 0; i < m.position.size(); ++i)
    for (std::size_t j = 0; j < i && m.group[i] == 1; ++j)
      if (m.group[j] == 1) least = std::min(least, norm(m.position[j] - m.position[i]));
  EXPECT_GE(least, 0.008 * (1.0 - 1e-12));
}

void expect_linked_elements_close_in_memory(const Model& m) {
  double sum = 0.0;
  Index widest = 0;
  for (const Model::Link& link : m.links) {
    sum += link.b - link.a;
    widest = std::max(widest, link.b - link.a);
  }
  // A slice one element wide through the slab holds about 14274 / 51 = 280 elements; the impactor's
  // slices come on top near the middle. In random order the mean would be 14274 / 3.
  EXPECT_LT(sum / static_cast<double>(m.links.size()), 200.0);
  EXPECT_LT(widest, 1000);
}

TEST(PaperModel, HasTheCountsMassBarsAndLinksOfThePaper) {
  const Model m = build_model(slab_of_the_paper(), ".");
  expect_counts_of_the_paper(m);
  expect_mass_of_the_bulk(m);
  expect_elements_of_one_size(m);
  expect_free_bars_and_no_overlap(m);
  expect_chains_of_equal_spacing(m);
  expect_crossing_bars_to_touch(m);
  expect_linked_elements_close_in_memory(m);
}

TEST(Build, TheSameSeedGivesTheSameBitsAndAnotherSeedAnotherModel) {
  Config config = small_slab();
  const Model first = build_model(config, "."), second = build_model(config, ".");
  const auto same = [](const Model& a, const Model& b) {
    const std::size_t bytes = a.position.size() * sizeof(Vec3);
    return a.links.size() == b.links.size() && a.mass == b.mass && a.radius == b.radius &&
           std::memcmp(a.position.data(), b.position.data(), bytes) == 0;
  };
  EXPECT_TRUE(same(first, second));
  config.seed = 2;
  EXPECT_FALSE(same(first, build_model(config, ".")));
}

TEST(Build, ElementsFillTheCompactnessOfTheVolumeBesideTheBars) {
  const Config config = small_slab();
  const Model m = build_model(config, ".");
  double solid = 0.0;
  for (std::size_t i = 0; i < m.radius.size(); ++i)
    if (m.group[i] == 0) solid += 4.0 / 3.0 * pi * m.radius[i] * m.radius[i] * m.radius[i];
  const double bars = pi * 0.004 * 0.004 * 4 * (0.3 + 0.2 - 2 * 0.008);
  EXPECT_NEAR(solid / (0.3 * 0.2 * 0.1 - bars), 0.5, 1e-3);
}

TEST(Build, ABodyAndItsBarsStartAsOneRigidMotion) {
  Config config = small_slab();
  BodyConfig& slab = config.bodies[0];
  slab.center = {1.0, 2.0, 3.0};
  slab.velocity = {5.0, 0.0, -1.0};
  slab.spin = {0.0, 0.0, 10.0};
  const Model m = build_model(config, ".");
  for (std::size_t i = 0; i < m.position.size(); ++i) {
    const Vec3 r = m.position[i] - slab.center;
    const Vec3 expected{5.0 - 10.0 * r.y, 10.0 * r.x, -1.0};
    EXPECT_NEAR(norm(m.velocity[i] - expected), 0.0, 1e-12);
    EXPECT_EQ(m.spin[i].z, 10.0);
  }
  // Only rigid motion: no linked pair changes its distance.
  for (const Model::Link& link : m.links) {
    const auto a = static_cast<std::size_t>(link.a), b = static_cast<std::size_t>(link.b);
    EXPECT_NEAR(dot(m.velocity[b] - m.velocity[a], m.position[b] - m.position[a]), 0.0, 1e-12);
  }
}

TEST(Build, ASingleElementIsASolidSphere) {
  Config config = case_with_materials();
  BodyConfig ball = sphere_body("ball", {0.0, 0.0, 1.0}, 0.05, 0, 0.5);
  ball.shape = "element";
  ball.velocity = {0.0, 0.0, -3.0};
  config.bodies = {ball};
  const Model m = build_model(config, ".");
  ASSERT_EQ(m.size(), 1);
  const double mass = 2400.0 * 4.0 / 3.0 * pi * 0.05 * 0.05 * 0.05;
  EXPECT_NEAR(m.mass[0], mass, 1e-12);
  EXPECT_NEAR(m.inertia[0], 0.4 * mass * 0.05 * 0.05, 1e-15);
  EXPECT_EQ(m.velocity[0].z, -3.0);
  EXPECT_TRUE(m.links.empty());
}

TEST(Build, GrainsAreNotLinked) {
  Config config = case_with_materials();
  config.bodies = {box_body("heap", {0.2, 0.2, 0.2}, 300, 0.5)};
  config.bodies[0].material = "gravel";
  const Model m = build_model(config, ".");
  EXPECT_EQ(m.size(), 300);
  EXPECT_TRUE(m.links.empty());
  EXPECT_NEAR(mass_of(m, 0), 2600.0 * 0.008, 1e-9);
  config.bodies[0].pack.compactness = 0.64;  // too dense: they would burst apart
  EXPECT_TRUE(mentions(refusal(config), "element")) << refusal(config);
  EXPECT_TRUE(mentions(refusal(config), "of body heap")) << refusal(config);
}

class SpheresFile : public testing::Test {
 protected:
  SpheresFile()
      : folder_(std::filesystem::path(testing::TempDir()) / "spheres_file"),
        config_(case_with_materials()) {
    std::filesystem::create_directories(folder_);
    BodyConfig body;
    body.name = "cluster";
    body.shape = "file";
    body.material = "c30";
    body.file = "spheres.csv";
    body.volume = 1e-3;
    config_.bodies = {body};
  }
  ~SpheresFile() override { std::filesystem::remove_all(folder_); }
  Model model_of(const std::string& text) {
    std::ofstream(folder_ / "spheres.csv") << text;
    return build_model(config_, folder_.string());
  }
  std::filesystem::path folder_;
  Config config_;
};

TEST_F(SpheresFile, GivesElementsAndLinks) {
  const std::string text =
      "x,y,z,radius\n# two that overlap, one apart\n0,0,0,0.01\n"
      "0.015, 0, 0, 0.01\r\n\n1.0,0,0,2e-2\n";
  config_.bodies[0].center = {0.0, 0.0, 5.0};
  const Model m = model_of(text);
  ASSERT_EQ(m.size(), 3);
  ASSERT_EQ(m.links.size(), 1U);
  EXPECT_EQ(m.position[0].z, 5.0);
  EXPECT_NEAR(mass_of(m, 0), 2.4, 1e-12);
  EXPECT_NEAR(m.mass[2], 8.0 * m.mass[0], 1e-12);
}

TEST_F(SpheresFile, HasTheMassOfTheBulkThatItStandsFor) {
  const std::string text = "0,0,0,0.01\n1.0,0,0,2e-2\n";
  const double own = 4.0 / 3.0 * pi * 9e-6;
  config_.bodies[0].size = {0.1, 0.1, 0.2};
  config_.bodies[0].volume = 0.0;
  EXPECT_NEAR(mass_of(model_of(text), 0), 2400.0 * 2e-3, 1e-12);
  config_.bodies[0].volume = 1.5e-3;  // a cylinder in that box, say
  EXPECT_NEAR(mass_of(model_of(text), 0), 2400.0 * 1.5e-3, 1e-12);
  // Concrete always stands for a volume; grains may be nothing but themselves.
  config_.bodies[0].volume = config_.bodies[0].size.z = 0.0;
  try {
    model_of(text);
    ADD_FAILURE() << "nothing was said about its mass";
  } catch (const InputError& error) {
    EXPECT_TRUE(mentions(error.what(), "volume")) << error.what();
  }
  config_.materials[0].law = "grain";
  EXPECT_NEAR(mass_of(model_of(text), 0), 2400.0 * own, 1e-12);
}

TEST_F(SpheresFile, WithABadLineIsRefusedWithItsNumber) {
  for (const char* bad : {"1,2,3", "1,2,3,0", "1,2,3,-1", "1,2,x,1", "1,2,3,4,5", "1,2,nan,1"}) {
    try {
      model_of(std::string("0,0,0,0.01\n") + bad + "\n");
      ADD_FAILURE() << bad;
    } catch (const InputError& error) {
      EXPECT_TRUE(mentions(error.what(), "line 2")) << error.what();
    }
  }
  EXPECT_THROW(model_of("x,y,z,radius\n"), InputError);
  config_.bodies[0].file = "missing.csv";
  EXPECT_THROW(model_of(""), IoError);
}

TEST(Refused, BodiesThatOverlapAreNamedWithTheirElements) {
  Config config = small_slab();
  config.bodies.push_back(sphere_body("rock", {0.0, 0.0, 0.06}, 0.04, 60, 0.5));
  const std::string message = refusal(config);
  EXPECT_TRUE(mentions(message, "of body slab")) << message;
  EXPECT_TRUE(mentions(message, "of body rock")) << message;
  EXPECT_TRUE(mentions(message, "element")) << message;
}

TEST(Refused, EveryBadBodyIsNamedAtOnce) {
  Config config = small_slab();
  config.bodies[0].material = "c45";
  config.bodies[1].rebar.interface_law = "c30";
  config.bodies.push_back(sphere_body("rock", {0.0, 0.0, 0.2}, 0.0, 10, 0.5));
  const std::string message = refusal(config);
  EXPECT_TRUE(mentions(message, "3 problems")) << message;
  EXPECT_TRUE(mentions(message, "body.slab.material = \"c45\" is not a material")) << message;
  EXPECT_TRUE(
      mentions(message,
               "body.steel.rebar.interface = \"c30\" is not a material of law interface; there "
               "are: bond"))
      << message;
  EXPECT_TRUE(mentions(message, "body.rock.radius must be above 0")) << message;
}

TEST(Refused, BarsThatDoNotFitTheirBody) {
  const auto with = [](auto change) {
    Config config = small_slab();
    change(config.bodies[1]);
    return refusal(config);
  };
  EXPECT_TRUE(mentions(with([](BodyConfig& b) { b.rebar.cover = 0.003; }), "cover"));
  EXPECT_TRUE(mentions(with([](BodyConfig& b) { b.rebar.cover = 0.04; }), "layers"));
  EXPECT_TRUE(mentions(with([](BodyConfig& b) { b.rebar.bars = 26; }), "beside each other"));
  EXPECT_TRUE(mentions(with([](BodyConfig& b) { b.rebar.elements = 26; }), "along a bar"));
  EXPECT_TRUE(mentions(with([](BodyConfig& b) { b.rebar.in = "wall"; }),
                       "body.steel.rebar.in = \"wall\" is not a body; there are: slab"));
  EXPECT_TRUE(mentions(with([](BodyConfig& b) { b.velocity = {1.0, 0.0, 0.0}; }), "bars move"));
}

}  // namespace build_test
}  // namespace breccia::dem
