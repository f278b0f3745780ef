#include "run/machine/exec_choice.hpp"

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <charconv>

#include "dem/tiles/tile_run.hpp"
#include "domain/mpi_ranks.hpp"
#include "exec/device.hpp"
#include "exec/error.hpp"

namespace breccia {

namespace {

/// Takes an ending off a word. @returns whether it was there
bool take_off(std::string& word, const std::string& ending) {
  if (!word.ends_with(ending)) return false;
  word.resize(word.size() - ending.size());
  return true;
}

}  // namespace

Exec exec_on(const std::string& wanted, int threads, Communicator* ranks) {
  Exec exec;
  std::string device = wanted;
  if (device.starts_with("cuda")) {
    exec.tiles = dem::tiles_where_they_pay;
    if (take_off(device, "+tiles"))
      exec.tiles = dem::tiles_in_any_case;
    else if (take_off(device, "+launches"))
      exec.tiles = 0;
  }
  const int share = std::max(1, omp_get_num_procs() / ranks_on_this_machine(ranks));
  exec.threads = threads > 0 ? threads : share;
  if (device == "cpu") return exec;
  if (device != "cuda" && !device.starts_with("cuda:"))
    throw InputError(
        fmt::format("device {}: there are cpu, cuda and cuda:N, and +tiles or +launches behind "
                    "those with a GPU",
                    wanted));
  exec.space = Space::cuda;
  const std::size_t colon = device.find(':');
  if (colon == std::string::npos) {
    use_device_in_turn(number_on_this_machine(ranks));
    return exec;
  }
  int number = 0;
  const char* const end = device.data() + device.size();
  const auto [stop, error] = std::from_chars(device.data() + colon + 1, end, number);
  if (error != std::errc{} || stop != end || number < 0)
    throw InputError(fmt::format("device {}: N is the number of a GPU, from 0", wanted));
  use_device(number);
  return exec;
}

}  // namespace breccia
