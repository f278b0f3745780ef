#pragma once
// Kinds of options that several commands have.

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "app/side_by_side_options.hpp"

namespace breccia::app {

/// One that may be repeated, with one value each.
inline CLI::Option* add_repeated(CLI::App* command, const char* name,
                                 std::vector<std::string>& values, const char* help,
                                 const char* type) {
  return command->add_option(name, values, help)
      ->type_name(type)
      ->take_all()
      ->expected(1)
      ->allow_extra_args(false);
}

/// A whole number from 1 on.
template <class Count>
CLI::Option* add_count(CLI::App* command, const char* name, Count& value, const char* help) {
  return command->add_option(name, value, help)->type_name("N")->check([](const std::string& text) {
    return count_problem(text);
  });
}

}  // namespace breccia::app
