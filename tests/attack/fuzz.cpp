// Every parser of the program fed with bytes from outside: one text for libFuzzer (clang,
// -DBR_FUZZ=ON) and for a plain loop that mutates the files of a corpus.
//
//   attack_fuzz PARSER SECONDS SEED FILE...    prints "runs", also on SIGTERM; a finding ends it by
//                                              its signal, with the input in
//                                              attack_fuzz.PARSER.last
// Parsers: as in parsers.py. Of `ldpm`, `facets`, and `record` an input is several files, parted by
// lines "====".

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>
#include <zlib.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "app/film_recipe.hpp"
#include "exec/error.hpp"
#include "io/case/units.hpp"
#include "io/checkpoint.hpp"
#include "io/picture/png_notes.hpp"
#include "io/vtu/vtu_reader.hpp"
#include "mutants.hpp"
#include "prepare/csv_numbers.hpp"
#include "prepare/ldpm/mesh_file.hpp"
#include "prepare/meshing/joint_sets.hpp"
#include "prepare/meshing/mesh_file.hpp"
#include "prepare/packing/spheres_file.hpp"
#include "prepare/shapes/surface.hpp"
#include "prepare/tetrahedra/tet_file.hpp"
#include "report/record.hpp"
#include "report/table.hpp"
#include "run/case.hpp"

namespace breccia::attack {
namespace {

std::string scratch() {
  static const std::string folder =
      (std::filesystem::temp_directory_path() / ("attack_fuzz." + std::to_string(::getpid())))
          .string();
  std::filesystem::create_directories(folder + "/fields");
  return folder;
}
std::string as_file(const std::string& name, const std::string& text) {
  const std::string path = scratch() + "/" + name;
  std::ofstream(path, std::ios::binary) << text;
  return path;
}

/// The files of an input; those that it has not are empty.
std::vector<std::string> files_in(const std::string& text, std::size_t count) {
  static const std::string mark = "\n====\n";
  std::vector<std::string> files;
  for (std::size_t begin = 0; files.size() < count;) {
    const std::size_t end = std::min(text.find(mark, begin), text.size());
    files.push_back(text.substr(begin, end - begin));
    begin = std::min(end + mark.size(), text.size());
  }
  return files;
}

/// A PNG whose chunks have the sums of what they hold, so that it is read.
std::string with_right_sums(std::string png) {
  for (std::size_t at = 8; at + 12 <= png.size();) {
    std::size_t length = 0;
    for (std::size_t k = 0; k < 4; ++k)
      length = length << 8 | static_cast<unsigned char>(png[at + k]);
    if (length > png.size() - at - 12) break;
    const auto sum = ::crc32(0, reinterpret_cast<const Bytef*>(png.data() + at + 4),
                             static_cast<uInt>(length + 4));
    for (std::size_t k = 0; k < 4; ++k)
      png[at + 8 + length + k] = static_cast<char>(sum >> (24 - 8 * k));
    at += 12 + length;
  }
  return png;
}

/// A result for any bytes, or one of the program's own errors.
void parse(const std::string& parser, const std::string& text) {
  try {
    if (parser == "case") {
      case_of_text(text, "fuzzed", ".", {});
    } else if (parser == "gmsh") {
      prepare::parse_gmsh(text, "fuzzed.msh");
    } else if (parser == "abaqus") {
      prepare::parse_abaqus(text, "fuzzed.inp");
    } else if (parser == "tet_gmsh") {
      prepare::parse_tet_gmsh(text, "fuzzed.msh");
    } else if (parser == "tet_abaqus") {
      prepare::parse_tet_abaqus(text, "fuzzed.inp");
    } else if (parser == "stl") {
      prepare::read_surface(as_file("fuzzed.stl", text), 1e-3);
    } else if (parser == "spheres") {
      prepare::read_spheres(as_file("fuzzed.csv", text));
    } else if (parser == "ldpm") {
      const auto files = files_in(text, 2);
      as_file("fuzzed-data-particles.dat", files[0]);
      prepare::read_ldpm_mesh(as_file("fuzzed-data-tets.dat", files[1]));
    } else if (parser == "facets") {
      const auto files = files_in(text, 3);
      as_file("facets-para-mesh.000.vtk", files[0]);
      const std::string corners = as_file("facets-data-facetsVertices.dat", files[1]);
      prepare::read_ldpm_mesh(files[2].empty() ? corners
                                               : as_file("facets-data-facets.dat", files[2]));
    } else if (parser == "joints") {
      fdem::JointSetConfig set;
      set.file = text.starts_with("x") ? "fuzzed.csv" : "fuzzed.wkt";
      as_file(set.file, text);
      prepare::lines_of_set(set, 1, 0, scratch());
    } else if (parser == "csv") {
      prepare::read_csv(as_file("fuzzed.csv", text), 4, "x,y,z,r",
                        [](const auto&) { return true; });
    } else if (parser == "vtu") {
      as_file("fields/elements_0000.vtu", text);
      as_file("fields/links_0000.vtu", text);
      as_file("elements.pvd", text.starts_with("<?xml") && text.find("Collection") != text.npos
                                  ? text
                                  : "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\">\n"
                                    "<Collection>\n<DataSet timestep=\"0\" part=\"0\" "
                                    "file=\"fields/elements_0000.vtu\"/>\n</Collection>\n"
                                    "</VTKFile>\n");
      frame_times(scratch());
      read_frame(scratch(), 0);
    } else if (parser == "vtkhdf") {
      as_file("fields/elements_0000.hdf", text);
      const std::string list = text.starts_with("{")
                                   ? text
                                   : R"({"file-series-version":"1.0",)"
                                     R"("files":[{"name":"fields/elements_0000.hdf","time":0.0}]})";
      as_file("links.hdf.series", list);
      as_file("elements.hdf.series", list);
      frame_times(scratch());
      read_frame(scratch(), 0);
    } else if (parser == "png") {
      notes_of(with_right_sums(text), "fuzzed.png");
    } else if (parser == "film") {
      app::recipe_in(text, "fuzzed.mp4");
    } else if (parser == "recipe") {
      app::recipe_of_text(text, "fuzzed.mp4");
    } else if (parser == "table") {
      const std::string path = as_file("fuzzed.csv", text);
      try {
        report::read_table(path);
      } catch (const Error&) {
      }
      report::read_measured(path);
    } else if (parser == "record") {
      static constexpr const char* names[] = {"summary.json", "history.csv", "fragments.csv",
                                              "cracks.csv",   "log.jsonl",   "case.toml"};
      const auto files = files_in(text, std::size(names));
      for (std::size_t k = 0; k < files.size(); ++k) as_file(names[k], files[k]);
      report::read_record(scratch());
    } else if (parser == "units") {
      std::string problem, better;
      parse_quantity(text, "Pa", problem, &better);
      parse_unit(text);
    } else if (parser == "checkpoint") {
      CheckpointReader reader(as_file("fuzzed.br", text));
    } else {
      std::fprintf(stderr, "no parser %s\n", parser.c_str());
      std::exit(2);
    }
  } catch (const Error&) {
  }
}

/// A number or a line of a text changed, as no damage by chance does it.
void change_words(std::string& text, const std::string& other, Random& random) {
  static constexpr const char* words[] = {
      "0",           "-1", "nan", "inf", "1e308", "5e-324", "1e9",  "-1e300",   "\"\"",
      "99999999999", "[]", "{}",  "[[",  "]",     "=",      "true", "\"8 mm\"", "-0.0"};
  const auto line_of = [&](const std::string& from) {
    const std::size_t begin = from.rfind('\n', below(random, from.size())) + 1;
    return std::pair{begin, std::min(from.find('\n', begin), from.size() - 1) + 1 - begin};
  };
  if (text.empty() || other.empty()) return;
  const auto [begin, size] = line_of(text);
  if (random() % 3 == 0) {  // a line of another file
    const auto [from, length] = line_of(other);
    text.insert(begin, other, from, length);
  } else if (random() % 4 == 0) {  // a line that moves
    const std::string line = text.substr(begin, size);
    text.erase(begin, size);
    text.insert(text.rfind('\n', below(random, text.size())) + 1, line);
  } else {
    const char* const digits = "0123456789";
    const std::size_t first = text.find_first_of(digits, below(random, text.size()));
    if (first == text.npos) return;
    const std::size_t after = text.find_first_not_of("0123456789.eE-+", first);
    text.replace(first, std::min(after, text.size()) - first, words[random() % std::size(words)]);
  }
}

// Words that the handler of a signal writes: the input in work, or the number of those done.
std::string last;
const char* input = nullptr;
std::size_t input_size = 0;
std::atomic<long> runs{0};

extern "C" void on_finding(int number) {
  const int file = ::open(last.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (::write(file, input, input_size) < 0) ::_exit(2);
  ::signal(number, SIG_DFL);
  ::raise(number);
}
extern "C" void on_end(int) {
  char digits[24];
  std::size_t at = sizeof digits;
  digits[--at] = '\n';
  long left = runs.load();
  do digits[--at] = static_cast<char>('0' + left % 10);
  while ((left /= 10) > 0);
  ::_exit(::write(1, digits + at, sizeof digits - at) < 0);
}

}  // namespace
}  // namespace breccia::attack

#ifdef BR_LIBFUZZER
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  static const char* const parser = std::getenv("ATTACK_PARSER");
  breccia::attack::parse(parser == nullptr ? "case" : parser,
                         {reinterpret_cast<const char*>(bytes), size});
  return 0;
}
#else
int main(int arguments, char** argument) {
  using namespace breccia::attack;
  using Clock = std::chrono::steady_clock;
  if (arguments < 5) {
    std::fputs("attack_fuzz PARSER SECONDS SEED FILE...\n", stderr);
    return 2;
  }
  const std::string parser = argument[1];
  const auto end = Clock::now() + std::chrono::duration<double>(std::atof(argument[2]));
  Random random(std::strtoul(argument[3], nullptr, 10));
  std::vector<std::string> corpus;
  for (int k = 4; k < arguments; ++k) {
    std::ifstream file(argument[k], std::ios::binary);
    corpus.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
    parse(parser, corpus.back());  // as it is: former findings, too
  }
  last = "attack_fuzz." + parser + ".last";
  for (const int number : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGALRM})
    ::signal(number, on_finding);
  ::signal(SIGTERM, on_end);
  for (; runs % 64 != 0 || Clock::now() < end; ++runs) {
    std::string text = corpus[below(random, corpus.size())];
    for (std::size_t n = 1 + below(random, 4); n-- > 0;)
      if (random() % 2 == 0)
        mutate(text, random);
      else
        change_words(text, corpus[below(random, corpus.size())], random);
    if (random() % 8 == 0 && !text.empty())  // a part of another file
      text.insert(below(random, text.size()), corpus[below(random, corpus.size())], 0,
                  below(random, 256));
    input = text.data();
    input_size = text.size();
    ::alarm(10);  // one that hangs
    parse(parser, text);
  }
  ::alarm(0);
  std::filesystem::remove_all(scratch());
  std::printf("%ld\n", runs.load());
  return 0;
}
#endif
