#include "prepare/packing/spheres_file.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <sstream>

#include "exec/error.hpp"
#include "io/whole_file.hpp"
#include "prepare/csv_numbers.hpp"

namespace breccia::prepare {

namespace {

constexpr const char* wanted = "x,y,z,radius in metres with a positive radius";

bool add(Spheres& spheres, const std::vector<double>& v) {
  if (!(v[3] > 0.0)) return false;
  spheres.position.push_back({v[0], v[1], v[2]});
  spheres.radius.push_back(v[3]);
  return true;
}

std::vector<std::string> words_of(const std::string& line) {
  std::istringstream stream(line);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

double number_of(const std::string& word) {
  double value = 0.0;
  const auto [rest, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  const bool good = error == std::errc{} && rest == word.data() + word.size();
  return good && std::isfinite(value) ? value : std::nan("");
}

/// Where x, y, z and the radius stand in a line of a dump.
struct Columns {
  std::array<std::size_t, 4> at{};
  double over_radius = 1.0;  ///< 2: the column holds diameters
  std::size_t count = 0;
};
Columns columns_of(const std::string& heading, const std::string& where) {
  const std::vector<std::string> names = words_of(heading);  // ITEM: ATOMS id type x ...
  Columns columns;
  columns.count = names.size() - 2;
  const auto find = [&](std::initializer_list<const char*> any) -> std::size_t {
    for (std::size_t k = 2; k < names.size(); ++k)
      for (const char* name : any)
        if (names[k] == name) return k - 2;
    return columns.count;
  };
  columns.at = {find({"x", "xu"}), find({"y", "yu"}), find({"z", "zu"}), find({"radius", "r"})};
  if (columns.at[3] == columns.count) {
    columns.at[3] = find({"diameter"});
    columns.over_radius = 2.0;
  }
  for (const std::size_t k : columns.at)
    if (k == columns.count)
      throw InputError(where +
                       ": a dump of spheres needs columns x, y, z and radius (or diameter)");
  return columns;
}

/// The last snapshot of a dump.
Spheres read_dump(const std::string& text, const std::string& path) {
  Spheres spheres;
  std::istringstream file(text);
  Columns columns;
  std::size_t number = 0;
  bool atoms = false;
  for (std::string line; std::getline(file, line);) {
    const std::string where = fmt::format("{}, line {}", path, ++number);
    if (line.starts_with("ITEM:")) {
      atoms = line.starts_with("ITEM: ATOMS");
      if (!atoms) continue;
      spheres = {};
      columns = columns_of(line, where);
      continue;
    }
    const std::vector<std::string> words = words_of(line);
    if (!atoms || words.empty()) continue;
    if (words.size() != columns.count)
      throw InputError(fmt::format("{} has {} columns, not the {} that the heading names", where,
                                   words.size(), columns.count));
    std::vector<double> v;
    for (const std::size_t k : columns.at) v.push_back(number_of(words[k]));
    v[3] /= columns.over_radius;
    if (std::isnan(v[0] + v[1] + v[2] + v[3]) || !add(spheres, v))
      throw InputError(where + " is not " + wanted);
  }
  return spheres;
}

constexpr const char* atoms_of_data = "Atoms";

/// Whether it is a data file of LAMMPS: a first line of any text, then counts such as "12 atoms".
bool is_data(const std::string& text) {
  std::istringstream file(text);
  std::string line;
  bool counts = false;
  for (std::size_t number = 0; std::getline(file, line); ++number) {
    const std::vector<std::string> words = words_of(line);
    if (number > 0 && words.size() >= 2 && words[1] == "atoms") counts = true;
    if (counts && !words.empty() && words[0] == atoms_of_data) return true;
  }
  return false;
}

/// The section Atoms of a data file in the style sphere: number, type, diameter, density, x, y, z.
Spheres read_data(const std::string& text, const std::string& path) {
  Spheres spheres;
  std::istringstream file(text);
  std::size_t number = 0;
  bool atoms = false;
  for (std::string line; std::getline(file, line);) {
    const std::string where = fmt::format("{}, line {}", path, ++number);
    const std::vector<std::string> words = words_of(line.substr(0, line.find('#')));
    if (words.empty()) continue;
    if (std::isnan(number_of(words[0]))) {  // the heading of a section
      atoms = words[0] == atoms_of_data;
      const std::size_t style = line.find('#');
      if (atoms && style != std::string::npos &&
          words_of(line.substr(style + 1)) != std::vector<std::string>{"sphere"})
        throw InputError(where +
                         ": atoms of style sphere are read: id type diameter density x y z");
      continue;
    }
    if (!atoms) continue;
    std::vector<double> v;
    for (const std::size_t k : {4, 5, 6, 2})
      v.push_back(k < words.size() ? number_of(words[k]) : std::nan(""));
    v[3] *= 0.5;
    if (std::isnan(v[0] + v[1] + v[2] + v[3]) || !add(spheres, v))
      throw InputError(where +
                       " is not id type diameter density x y z, as atoms of style sphere are");
  }
  return spheres;
}

/// Lines of numbers between blanks.
Spheres read_blanks(const std::string& text, const std::string& path) {
  Spheres spheres;
  std::istringstream file(text);
  std::size_t number = 0;
  for (std::string line; std::getline(file, line);) {
    ++number;
    const std::vector<std::string> words = words_of(line);
    if (words.empty() || words[0].front() == '#') continue;
    std::vector<double> v;
    for (std::size_t k = 0; k < std::min<std::size_t>(4, words.size()); ++k)
      v.push_back(number_of(words[k]));
    if (v.size() < 4 || std::isnan(v[0] + v[1] + v[2] + v[3]) || !add(spheres, v))
      throw InputError(fmt::format("{}, line {} is not {}", path, number, wanted));
  }
  return spheres;
}

/// Whether the first line with numbers has blanks and no comma between four of them.
bool has_blanks(const std::string& text) {
  std::istringstream file(text);
  for (std::string line; std::getline(file, line);) {
    const std::vector<std::string> words = words_of(line);
    if (words.empty() || words[0].front() == '#') continue;
    return line.find(',') == std::string::npos && words.size() >= 4 &&
           !std::isnan(number_of(words[0]));
  }
  return false;
}

}  // namespace

Spheres read_spheres(const std::string& path) {
  Spheres spheres;
  const std::string text = read_whole_file(path);
  if (text.starts_with("ITEM:"))
    spheres = read_dump(text, path);
  else if (is_data(text))
    spheres = read_data(text, path);
  else if (has_blanks(text))
    spheres = read_blanks(text, path);
  else
    read_csv(path, 4, wanted, [&](const std::vector<double>& v) { return add(spheres, v); });
  if (spheres.radius.empty()) throw InputError(fmt::format("{} holds no spheres", path));
  return spheres;
}

}  // namespace breccia::prepare
