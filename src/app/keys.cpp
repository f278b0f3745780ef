// breccia keys [PREFIX]: every key of a case file.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "app/commands.hpp"
#include "dem/config.hpp"
#include "exec/error.hpp"
#include "io/case_file.hpp"

namespace breccia::app {

void add_keys(CLI::App& program) {
  const auto prefix = std::make_shared<std::string>();
  CLI::App* const command = program.add_subcommand(
      "keys", "every key of a case file: type, unit, default, range, meaning");
  command->add_option("PREFIX", *prefix, "only keys that begin with this");
  command->callback([prefix] {
    const std::vector<KeyInfo> keys = list_keys<dem::Config>(*prefix);
    if (keys.empty()) throw InputError(fmt::format("no key begins with {}", *prefix));
    fmt::print("{}", format_keys(keys));
  });
}

}  // namespace breccia::app
