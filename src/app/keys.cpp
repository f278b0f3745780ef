// breccia keys [WORDS]: every key of a case file, or those that words are about.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <set>

#include "app/commands.hpp"
#include "app/coupled_keys.hpp"
#include "dem/setup/config.hpp"
#include "exec/error.hpp"
#include "fdem/setup/config.hpp"
#include "fdem3/setup/config.hpp"
#include "io/case/key_pages.hpp"
#include "io/case/suggestion.hpp"
#include "run/case_keys.hpp"

namespace breccia::app {
namespace {

struct KeysCommand {
  std::vector<std::string> words;
  std::string method;
  bool json = false, markdown = false, schema = false;

  void execute() const {
    std::vector<MethodKeys> methods{{"dem3d", list_keys<dem::Config>("")},
                                    {"fdem2d", list_keys<fdem::Config>("")},
                                    {"fdem3d", list_keys<fdem3::Config>("")},
                                    {both_methods, keys_between()}};
    if (schema || method == both_methods) methods.back().keys = list_keys<coupled::Config>("");
    if (schema) {
      fmt::print("{}", key_schema(methods));
      return;
    }
    std::erase_if(methods,
                  [&](const MethodKeys& m) { return !method.empty() && m.method != method; });
    const std::string wanted = fmt::format("{}", fmt::join(words, " "));
    const auto chosen = [&](const auto& about) {
      std::vector<MethodKeys> some;
      for (const MethodKeys& m : methods) some.push_back({m.method, about(m.keys, wanted)});
      return key_list(some);
    };
    KeyList found = chosen(keys_about);
    if (found.empty() && words.size() > 1) found = chosen(keys_about_each);
    if (found.empty()) refuse(wanted, methods);
    fmt::print("{}", json       ? keys_as_json(found)
                     : markdown ? keys_as_markdown(found)
                                : keys_for_terminal(found));
  }

  static void refuse(const std::string& wanted, const std::vector<MethodKeys>& methods) {
    std::set<std::string> names;
    for (const MethodKeys& m : methods)
      for (const KeyInfo& key : m.keys)
        for (std::size_t at = 0; at < key.path.size();) {
          const std::size_t end = std::min(key.path.find_first_of(".[", at), key.path.size());
          if (end > at && key.path[at] != ']' && key.path[at] != '<')
            names.insert(key.path.substr(at, end - at));
          at = end + 1;
        }
    throw InputError(
        fmt::format("no key has {} in its name or meaning{}", wanted, suggestion(wanted, names)));
  }
};

}  // namespace

void add_keys(CLI::App& program) {
  const auto keys = std::make_shared<KeysCommand>();
  CLI::App* const command =
      program.add_subcommand("keys", "every key of a case file: example, allowed values, meaning");
  command->add_option(
      "WORDS", keys->words,
      "only keys that begin with this, or have these words in name or meaning: all of "
      "them or, if none has, any");
  command->add_option("--method", keys->method, "only keys of this method")
      ->check(CLI::IsMember({"dem3d", "fdem2d", "fdem3d", both_methods}));
  CLI::Option* const json = command->add_flag("--json", keys->json, "as JSON");
  CLI::Option* const markdown =
      command->add_flag("--markdown", keys->markdown, "as a page of Markdown")->excludes(json);
  command
      ->add_flag("--schema", keys->schema,
                 "the JSON Schema by which editors complete and check case files")
      ->excludes(json)
      ->excludes(markdown);
  command->footer(
      "Examples:\n  breccia keys young\n  breccia keys body.pack\n"
      "  breccia keys --schema > breccia.schema.json");
  command->callback([keys] { keys->execute(); });
}

}  // namespace breccia::app
