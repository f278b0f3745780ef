// breccia doctor: what this machine can do, and what to install for the rest.

#include <fmt/format.h>
#include <omp.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <sstream>

#include "app/commands.hpp"
#include "domain/mpi_ranks.hpp"
#include "exec/device.hpp"
#include "exec/error.hpp"
#include "io/file.hpp"
#include "io/vtu/vtkhdf.hpp"
#include "laboratory/optimiser.hpp"
#include "prepare/meshing/meshing.hpp"
#include "run/machine/machine.hpp"
#include "run/machine/memory_plan.hpp"

namespace breccia::app {
namespace {

namespace fs = std::filesystem;

void line(bool good, const std::string& what, const std::string& words) {
  fmt::print("  {} {:<10}{}\n", good ? "yes" : "no ", what, words);
}

void tell_program(const std::string& program, const char* use, const char* package) {
  const std::string file = prepare::on_path(program);
  line(!file.empty(), program,
       file.empty() ? fmt::format("{}: apt install {}", use, package)
                    : fmt::format("{} ({})", use, file));
}

/// Bytes a second that reach the disk under the present folder; 0: it cannot be written to.
double disk_speed() {
  const std::string path = fmt::format("./.breccia_doctor_{}", ::getpid());
  const std::vector<std::byte> block(std::size_t{1} << 20, std::byte{7});
  constexpr int blocks = 48;
  try {
    const auto begin = std::chrono::steady_clock::now();
    {
      File file(path, File::Use::create);
      for (int k = 0; k < blocks; ++k) file.write(block);
      file.sync();
      file.close();
    }
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begin;
    fs::remove(path);
    return static_cast<double>(blocks) * static_cast<double>(block.size()) / spent.count();
  } catch (const IoError&) {
    std::error_code ignored;
    fs::remove(path, ignored);
    return 0.0;
  }
}

std::string packs_text() {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq"))
    return "packs of 8 (AVX-512)";
  if (__builtin_cpu_supports("avx2")) return "packs of 4 (AVX2)";
#endif
  return "no packs (neither AVX2 nor AVX-512)";
}

void examine() {
  const Build& build = this_build();
  fmt::print("breccia {} ({}, {}, {})\n", build.version,
             build.commit.empty() ? "no commit" : build.commit, build.type, build.compiler);
  line(build.type == "Release", "fast", "built as " + build.type);
  const int cores = omp_get_num_procs();
  line(true, "cores", fmt::format("{}: {}", cores, processor_name()));
  line(true, "vectors", packs_text());
  const double memory = available_memory();
  // Largest cases by the bytes of an element or triangle (run/machine/memory_plan.cpp).
  line(memory > 1e9, "memory",
       fmt::format("{} free: about {:.0f} million elements or triangles", memory_text(memory),
                   std::ceil(1e-6 * memory / 2400.0)));
  line(build.mpi, "MPI",
       build.mpi ? "mpirun -n N breccia run CASE"
                 : "not in this program: package breccia-mpi, or a build with libopenmpi-dev");
  if (build.mpi && prepare::on_path("mpirun").empty())
    line(false, "mpirun", "apt install openmpi-bin");
  int devices = 0;
  std::string why = "not in this program: package breccia-cuda, or a build by preset cuda";
  if (build.cuda) {
    try {
      devices = device_count();
      why = devices > 0 ? fmt::format("{} here: --device cuda", devices) : "no NVIDIA GPU found";
    } catch (const Error& error) {
      why = error.what();
    }
  }
  line(devices > 0, "GPU", why);
  line(has_hdf5(), "HDF5",
       has_hdf5() ? "output.format = \"vtkhdf\""
                  : "not in this program: a build with libhdf5-dev writes VTKHDF");
  line(laboratory::has_nlopt(), "NLopt",
       laboratory::has_nlopt() ? "calibrate --method cobyla, sbplx, bobyqa"
                               : "not in this program: a build with libnlopt-dev has it");
  tell_program("gmsh", "free meshes of 2D bodies", "gmsh");
  tell_program("ffmpeg", "films from pictures", "ffmpeg");
  tell_program("paraview", "looks at fields (result.pvd)", "paraview");
  std::error_code error;
  const fs::space_info space = fs::space(".", error);
  const double speed = disk_speed();
  line(speed > 0.0, "disk",
       speed > 0.0 ? fmt::format("{} free here, {:.0f} MB/s",
                                 memory_text(static_cast<double>(space.available)), 1e-6 * speed)
                   : "this folder cannot be written to");
}

}  // namespace

void add_doctor(CLI::App& program) {
  program.add_subcommand("doctor", "what this machine can do, and what it lacks")
      ->callback(examine);
}

}  // namespace breccia::app
