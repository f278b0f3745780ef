// breccia keys [PREFIX]: every key of a case file.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "app/commands.hpp"
#include "dem/setup/config.hpp"
#include "exec/error.hpp"
#include "fdem/setup/config.hpp"
#include "io/case/case_file.hpp"

namespace breccia::app {

void add_keys(CLI::App& program) {
  const auto prefix = std::make_shared<std::string>();
  CLI::App* const command = program.add_subcommand(
      "keys", "every key of a case file: type, unit, default, range, meaning");
  command->add_option("PREFIX", *prefix, "only keys that begin with this");
  command->callback([prefix] {
    const std::vector<KeyInfo> dem = list_keys<dem::Config>(*prefix);
    const std::vector<KeyInfo> fdem = list_keys<fdem::Config>(*prefix);
    if (dem.empty() && fdem.empty())
      throw InputError(fmt::format("no key begins with {}", *prefix));
    const auto show = [](const char* method, const std::vector<KeyInfo>& keys) {
      if (!keys.empty()) fmt::print("method = \"{}\"\n{}", method, format_keys(keys));
    };
    show("dem3d", dem);
    if (!dem.empty() && !fdem.empty()) fmt::print("\n");
    show("fdem2d", fdem);
  });
}

}  // namespace breccia::app
