#include "io/case/suggestion.hpp"

#include <fmt/format.h>

#include <string_view>
#include <utility>

#include "core/nearest_name.hpp"

namespace breccia {
namespace {

/// Words of other programs, and of papers, for keys of cases.
constexpr std::pair<std::string_view, std::string_view> other_words[] = {
    {"center", "point"}, {"position", "center"},     {"position", "point"},
    {"axis", "normal"},  {"height", "length"},       {"E", "young"},
    {"nu", "poisson"},   {"rho", "density"},         {"mu", "friction"},
    {"ft", "tension"},   {"ft", "tensile_strength"}, {"element_size", "mesh_size"},
    {"dip", "angle"},    {"dip_angle", "angle"},     {"yield_force", "yield"}};

/// Keys of cases of spheres and tetrahedra that neither has of its own, and how they are given.
constexpr std::pair<std::string_view, std::string_view> above_both[] = {
    {"probe", "[[probe]], and reads what its `on` names"},
    {"check", "[[check]]"},
    {"output", "[output]"},
    {"time", "[time]"},
    {"checkpoint", "[checkpoint]"},
    {"gravity", "gravity = [...]"},
    {"seed", "seed = ..."}};

/// Words for the strength of a specimen, which is no key of a link or a joint.
bool is_compressive_strength(const std::string& word) {
  static const std::set<std::string> words{
      "compression", "compressive_strength", "compression_strength", "fc", "f_c", "fck", "ucs",
      "UCS"};
  return words.contains(word);
}

/// Up to four known words that hold `word`, of at least three letters: "sandstone-berea or
/// marble-cherokee".
std::string holding(const std::string& word, const std::set<std::string>& known) {
  std::string found;
  int count = 0;
  for (const std::string& candidate : known)
    if (word.size() >= 3 && candidate.find(word) != std::string::npos) {
      found += (found.empty() ? "" : " or ") + candidate;
      ++count;
    }
  return count <= 4 ? found : "";
}

}  // namespace

std::string nearest(const std::string& word, const std::set<std::string>& known) {
  std::string best;
  std::size_t least = 3 + word.size() / 4;
  for (const std::string& candidate : known)
    if (const std::size_t d = slips_between(word, candidate); d < least) {
      least = d;
      best = candidate;
    }
  return best;
}

std::string suggestion(const std::string& word, const std::set<std::string>& known) {
  if (word == "thickness")  // plane cases of other programs have one
    return ": a plane case counts each metre of thickness (N/m, J/m); multiply what comes out";
  if (word == "stage" && known.contains("body"))  // below spheres or tetrahedra
    return ": stages stand above both methods: [[stage]], with [stage.spheres] and "
           "[stage.tetrahedra]";
  for (const auto& [above, head] : above_both)
    if (word == above && known.contains("body"))
      return fmt::format(": it stands above both methods, {}", head);
  if (is_compressive_strength(word) && known.contains("cohesion"))
    return known.contains("friction_angle")
               ? ": a strength of specimens; of joints give cohesion, UCS (1 - sin a)/(2 cos a) by "
                 "the friction_angle a"
               : ": a strength of specimens, no number of links; 'breccia calibrate CASE "
                 "--material "
                 "NAME --target compression=...' finds the links' cohesion that shows it";
  for (const auto& [other, key] : other_words)
    if (word == other && known.contains(std::string(key)))
      return "; did you mean " + std::string(key) + "?";
  const std::string first = word.substr(0, word.find('/'));  // C35 of C35/45
  if (const std::string best = nearest(first, known); !best.empty())
    return "; did you mean " + best + "?";
  if (const std::string some = holding(word, known); !some.empty())
    return "; did you mean " + some + "?";
  std::string all;
  for (const std::string& candidate : known) all += (all.empty() ? "" : ", ") + candidate;
  return known.size() <= 12 && !known.empty() ? "; allowed are " + all : "";
}

}  // namespace breccia
