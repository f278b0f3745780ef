// Every parser of the program fed with bytes from outside: one text for libFuzzer (clang,
// -DBR_FUZZ=ON) and for a plain loop that mutates the files of a corpus.
//
//   attack_fuzz PARSER SECONDS SEED FILE...    prints "runs", also on SIGTERM; a finding ends it by
//                                              its signal, with the input in
//                                              attack_fuzz.PARSER.last
// Parsers: as in parsers.py. Of `ldpm` an input is two files, parted by a line "====".

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "exec/error.hpp"
#include "io/case/units.hpp"
#include "io/checkpoint.hpp"
#include "io/vtu/vtu_reader.hpp"
#include "mutants.hpp"
#include "prepare/csv_numbers.hpp"
#include "prepare/ldpm/mesh_file.hpp"
#include "prepare/meshing/joint_sets.hpp"
#include "prepare/meshing/mesh_file.hpp"
#include "prepare/packing/spheres_file.hpp"
#include "prepare/shapes/surface.hpp"
#include "prepare/tetrahedra/tet_file.hpp"
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
      const std::string mark = "\n====\n";
      const std::size_t at = text.find(mark);
      as_file("fuzzed-data-particles.dat", text.substr(0, at));
      prepare::read_ldpm_mesh(
          as_file("fuzzed-data-tets.dat", at == text.npos ? "" : text.substr(at + mark.size())));
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

// What the handler of a signal writes: the input in work, or the number of those done.
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
    for (std::size_t n = 1 + below(random, 4); n-- > 0;) mutate(text, random);
    if (random() % 8 == 0 && !text.empty())  // a part of another file
      text.insert(below(random, text.size()), corpus[below(random, corpus.size())], 0,
                  below(random, 256));
    input = text.data();
    input_size = text.size();
    if (runs % 64 == 0) ::alarm(5);  // for so many inputs, or one that hangs
    parse(parser, text);
  }
  ::alarm(0);
  std::filesystem::remove_all(scratch());
  std::printf("%ld\n", runs.load());
  return 0;
}
#endif
