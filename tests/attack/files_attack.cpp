// Damaged and forged checkpoints by the thousand, each loaded in a child of its own or in a batch.
//
//   attack_files damaged FILE.br RUNS SEED          prints "runs silent crashes hangs"
//   attack_files forged MODEL.br FILE.br RUNS SEED  prints "runs refused ran crashes hangs"
// FILE.br of `forged` is a checkpoint of the case of MODEL.br, or MODEL.br itself. Findings go to
// standard error with their number: the n-th mutant of a seed is always the same.

#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "exec/error.hpp"
#include "io/checkpoint.hpp"
#include "mutants.hpp"
#include "run/case.hpp"

namespace breccia::attack {
namespace {

enum Outcome { refused = 0, accepted = 1, fault = 2 };
struct Counts {
  long refused = 0, accepted = 0, crashes = 0, hangs = 0;
};

std::string content(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}
void put_content(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

Random random_of(unsigned long seed, long run) {
  std::seed_seq both{static_cast<std::uint64_t>(seed), static_cast<std::uint64_t>(run)};
  return Random(both);
}

/// Carries out work() in a child, which a signal or ten seconds may end.
template <class Work>
void count(Counts& counts, long run, const Work& work) {
  std::fflush(nullptr);
  const pid_t child = ::fork();
  if (child < 0) std::abort();
  if (child == 0) {
    ::alarm(10);
    int outcome = fault;
    try {
      outcome = work();
    } catch (const Error& error) {
      outcome = refused;
    } catch (const std::exception& error) {
      std::fprintf(stderr, "run %ld: %s\n", run, error.what());
    }
    ::_exit(outcome);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  const bool ended = WIFEXITED(status);
  if (!ended && WTERMSIG(status) == SIGALRM)
    ++counts.hangs;
  else if (!ended || WEXITSTATUS(status) == fault)
    ++counts.crashes;
  else
    ++(WEXITSTATUS(status) == accepted ? counts.accepted : counts.refused);
  if (!ended || WEXITSTATUS(status) == fault)
    std::fprintf(stderr, "run %ld: status %x\n", run, static_cast<unsigned>(status));
}

int damaged(const std::string& good, long runs, unsigned long seed, const std::string& bad) {
  const std::string bytes = content(good);
  constexpr long batch = 500;
  Counts counts;
  for (long first = 0; first < runs; first += batch) {
    const auto one = [&](long run) {
      Random random = random_of(seed, run);
      std::string mutant = bytes;
      mutate(mutant, random);
      put_content(bad, mutant);
      try {
        CheckpointReader reader(bad);
      } catch (const CheckpointError&) {
        return true;
      }
      std::fprintf(stderr, "run %ld is loaded silently\n", run);
      return false;
    };
    Counts together;
    count(together, first, [&] {
      ::alarm(600);
      bool all = true;
      for (long run = first; run < std::min(first + batch, runs); ++run) all = one(run) && all;
      return all ? refused : accepted;
    });
    if (together.refused > 0) {
      counts.refused += std::min(batch, runs - first);
      continue;
    }
    for (long run = first; run < std::min(first + batch, runs); ++run)  // which of them?
      count(counts, run, [&] { return one(run) ? refused : accepted; });
  }
  std::printf("%ld %ld %ld %ld\n", runs, counts.accepted, counts.crashes, counts.hangs);
  return counts.accepted + counts.crashes + counts.hangs > 0;
}

/// Changes a section or two, and writes the file with right digests.
void forge(const CheckpointReader& reader, const std::string& to, Random& random) {
  const auto& sections = reader.sections();
  const std::size_t one = below(random, sections.size()), other = below(random, sections.size());
  CheckpointWriter writer;
  for (std::size_t k = 0; k < sections.size(); ++k) {
    const auto& s = sections[k];
    std::string bytes(reinterpret_cast<const char*>(s.bytes.data()), s.bytes.size());
    if (k == one || (k == other && random() % 4 == 0)) mutate(bytes, random);
    const std::size_t width = std::max<std::size_t>(1, s.item_bytes);
    writer.section(s.name, bytes.data(), bytes.size() / width, width);
  }
  writer.write(to);
}

int forged(const std::string& path, const std::string& good, long runs, unsigned long seed,
           const std::string& bad) {
  const Case built = load_case(path, {});
  const bool model = path == good;
  const CheckpointReader reader(good);
  Counts counts;
  for (long run = 0; run < runs; ++run)
    count(counts, run, [&] {
      Random random = random_of(seed, run);
      forge(reader, bad, random);
      const std::unique_ptr<Method> method =
          make_method(model ? load_case(bad, {}) : built, Exec{}, nullptr);
      if (!model) {
        const CheckpointReader forgery(bad);
        method->load(&forgery);
      }
      const std::int64_t end = method->steps() + 20;
      for (int n = 0; n < 20 && method->steps() < end; ++n) method->advance({1.0, end});
      return accepted;
    });
  std::printf("%ld %ld %ld %ld %ld\n", runs, counts.refused, counts.accepted, counts.crashes,
              counts.hangs);
  return counts.crashes + counts.hangs > 0;
}

}  // namespace
}  // namespace breccia::attack

int main(int arguments, char** argument) {
  using namespace breccia::attack;
  const std::string kind = arguments > 1 ? argument[1] : "";
  const std::string bad = (std::filesystem::temp_directory_path() /
                           ("attack_files." + std::to_string(::getpid()) + ".br"))
                              .string();
  int result = 2;
  if (kind == "damaged" && arguments == 5)
    result =
        damaged(argument[2], std::atol(argument[3]), std::strtoul(argument[4], nullptr, 10), bad);
  else if (kind == "forged" && arguments == 6)
    result = forged(argument[2], argument[3], std::atol(argument[4]),
                    std::strtoul(argument[5], nullptr, 10), bad);
  else
    std::fputs("attack_files damaged FILE RUNS SEED | forged MODEL FILE RUNS SEED\n", stderr);
  std::filesystem::remove(bad);
  return result;
}
