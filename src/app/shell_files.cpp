// breccia shell-file bash|zsh|fish|man: completions and the manual page, from the command tree.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <vector>

#include "app/commands.hpp"
#include "run/machine/machine.hpp"

namespace breccia::app {
namespace {

/// An option of a command as shells know it.
struct Flag {
  std::vector<std::string> names;  ///< with their dashes
  std::string meaning, value;      ///< value: what it takes; empty: nothing
};

/// A command that people may call.
struct Command {
  std::string name, meaning;
  std::vector<std::string> words;  ///< it takes, as CASE
  std::vector<Flag> flags;
  std::vector<Command> parts;  ///< commands of its own, as `info` of `mesh`
};

std::vector<Command> commands_of(const CLI::App& app);

Command command_of(const CLI::App& app) {
  Command command{app.get_name(), app.get_description(), {}, {}, commands_of(app)};
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_group().empty()) continue;
    if (option->get_positional() && option->get_lnames().empty()) {
      command.words.push_back(option->get_name(true));
      continue;
    }
    Flag flag;
    for (const std::string& name : option->get_snames()) flag.names.push_back("-" + name);
    for (const std::string& name : option->get_lnames()) flag.names.push_back("--" + name);
    flag.meaning = option->get_description();
    if (option->get_items_expected_max() > 0) flag.value = option->get_type_name();
    command.flags.push_back(std::move(flag));
  }
  return command;
}

std::vector<Command> commands_of(const CLI::App& app) {
  std::vector<Command> commands;
  for (const CLI::App* below : app.get_subcommands({}))
    if (!below->get_group().empty()) commands.push_back(command_of(*below));
  return commands;
}

std::string names_of(const std::vector<Command>& commands) {
  std::vector<std::string> names;
  for (const Command& c : commands) names.push_back(c.name);
  return fmt::format("{}", fmt::join(names, " "));
}

std::string replaced(std::string text, const std::string& what, const std::string& with) {
  for (std::size_t at = text.find(what); at != std::string::npos;
       at = text.find(what, at + with.size()))
    text.replace(at, what.size(), with);
  return text;
}

/// The lines of bash for each command; `at` is the place of its name among the words.
std::string bash_cases(const std::vector<Command>& commands, int at) {
  std::string cases;
  const std::string indent(static_cast<std::size_t>(4 * at), ' ');
  for (const Command& c : commands) {
    std::vector<std::string> flags;
    for (const Flag& flag : c.flags)
      flags.insert(flags.end(), flag.names.begin(), flag.names.end());
    cases += fmt::format("{}{}) flags='{}'", indent, c.name, fmt::join(flags, " "));
    if (!c.parts.empty())
      cases += fmt::format(
          "; [ \"$COMP_CWORD\" -ne {} ] || names='{}'\n{}case ${{COMP_WORDS[{}]}} in\n{}{}esac",
          at + 1, names_of(c.parts), indent + "  ", at + 1, bash_cases(c.parts, at + 1),
          indent + "  ");
    cases += " ;;\n";
  }
  return cases;
}

std::string bash_file(const std::vector<Command>& commands) {
  return fmt::format(
      R"(# Completion of breccia for bash; made by `breccia shell-file bash`.
_breccia() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} flags='--help --version' names=
  if [ "$COMP_CWORD" -eq 1 ]; then
    COMPREPLY=($(compgen -W '{} --help --version' -- "$word"))
    return
  fi
  case ${{COMP_WORDS[1]}} in
{}  esac
  if [[ $names ]]; then
    COMPREPLY=($(compgen -W "$names $flags" -- "$word"))
  elif [[ $word == -* ]]; then
    COMPREPLY=($(compgen -W "$flags" -- "$word"))
  else
    COMPREPLY=($(compgen -f -- "$word"))
  fi
}}
complete -o filenames -F _breccia breccia
)",
      names_of(commands), bash_cases(commands, 1));
}

/// Text in brackets of zsh's _arguments, in single quotes.
std::string zsh_text(const std::string& text) {
  std::string safe = replaced(text, "'", "'\\''");
  for (const char* special : {"[", "]", ":"})
    safe = replaced(safe, special, std::string("\\") + special);
  return safe;
}

/// Offers the names of commands, or what the one in `words[2]` takes.
std::string zsh_choice(const std::vector<Command>& commands) {
  std::string list, cases;
  for (const Command& c : commands) {
    list += fmt::format("    '{}:{}'\n", c.name, zsh_text(c.meaning));
    cases += fmt::format("    {})\n", c.name);
    if (!c.parts.empty()) {
      cases += zsh_choice(c.parts) + "    ;;\n";
      continue;
    }
    cases += "      _arguments";
    for (const Flag& flag : c.flags)
      for (const std::string& name : flag.names)
        cases += fmt::format(" \\\n        '{}[{}]{}'", name, zsh_text(flag.meaning),
                             flag.value.empty() ? "" : ":" + zsh_text(flag.value) + ":_files");
    cases += " \\\n        '*:file:_files' ;;\n";
  }
  return fmt::format(R"(  commands=(
{}  )
  if (( CURRENT == 2 )); then
    _describe command commands
    return
  fi
  shift words
  (( CURRENT-- ))
  case $words[1] in
{}  esac
)",
                     list, cases);
}

std::string zsh_file(const std::vector<Command>& commands) {
  return fmt::format(
      R"(#compdef breccia
# Completion of breccia for zsh; made by `breccia shell-file zsh`.
_breccia() {{
  local -a commands
{}}}
if [ "$funcstack[1]" = "_breccia" ]; then _breccia "$@"; else compdef _breccia breccia; fi
)",
      zsh_choice(commands));
}

/// Lines for commands that may follow where `where` holds, a condition of fish.
std::string fish_lines(const std::vector<Command>& commands, const std::string& where) {
  const auto quoted = [](const std::string& text) {
    return "'" + replaced(replaced(text, "\\", "\\\\"), "'", "\\'") + "'";
  };
  std::string text;
  for (const Command& c : commands)
    text += fmt::format("complete -c breccia -n '{}' -f -a {} -d {}\n", where, c.name,
                        quoted(c.meaning));
  for (const Command& c : commands) {
    const std::string seen = "__fish_seen_subcommand_from " + c.name;
    for (const Flag& flag : c.flags) {
      text += fmt::format("complete -c breccia -n '{}'", seen);
      for (const std::string& name : flag.names)
        text += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
      text += fmt::format(" -d {}{}\n", quoted(flag.meaning), flag.value.empty() ? "" : " -r");
    }
    if (!c.parts.empty())
      text += fish_lines(c.parts, fmt::format("{}; and not __fish_seen_subcommand_from {}", seen,
                                              names_of(c.parts)));
  }
  return text;
}

std::string fish_file(const std::vector<Command>& commands) {
  return "# Completion of breccia for fish; made by `breccia shell-file fish`.\n" +
         fish_lines(commands, "__fish_use_subcommand");
}

/// Text for troff, which reads dashes and a line's first dot or quote in its own way.
std::string roff(const std::string& text) {
  std::string safe = replaced(replaced(text, "\\", "\\e"), "-", "\\-");
  if (safe.starts_with(".") || safe.starts_with("'")) safe.insert(0, "\\&");
  return replaced(replaced(safe, "\n.", "\n\\&."), "\n'", "\n\\&'");
}

/// Sections on commands; `of` is the program, or the command that they are of.
std::string sections(const std::vector<Command>& commands, const std::string& of) {
  std::string text;
  for (const Command& c : commands) {
    text += fmt::format(".SS \"{} {}\"\n{}.\n", of, c.name, roff(c.meaning));
    if (!c.words.empty())
      text +=
          fmt::format(".br\nTakes \\fI{}\\fR.\n", roff(fmt::format("{}", fmt::join(c.words, " "))));
    for (const Flag& flag : c.flags)
      text += fmt::format(
          ".TP\n\\fB{}\\fR{}\n{}\n", roff(fmt::format("{}", fmt::join(flag.names, ", "))),
          flag.value.empty() ? "" : " \\fI" + roff(flag.value) + "\\fR", roff(flag.meaning));
    text += sections(c.parts, of + " " + c.name);
  }
  return text;
}

std::string manual_page(const CLI::App& program, const std::vector<Command>& commands) {
  return fmt::format(
             ".TH BRECCIA 1 \"\" \"breccia {}\" \"User Commands\"\n.SH NAME\nbreccia \\- how "
             "concrete and rock break\n.SH SYNOPSIS\n.B breccia\n.I COMMAND\n[\\fIOPTION\\fR]...\n"
             ".SH DESCRIPTION\n{}\n.SH COMMANDS\n",
             this_build().version, roff(program.get_description())) +
         sections(commands, "breccia") + ".SH EXIT STATUS\n" + roff(program.get_footer()) +
         "\n.SH SEE ALSO\n.B breccia keys\nlists every key of a case file.\n";
}

}  // namespace

void add_shell_file(CLI::App& program) {
  const auto kind = std::make_shared<std::string>();
  CLI::App* const command =
      program.add_subcommand("shell-file", "print the completion for a shell, or the manual page");
  command->group("");  // for packages
  command->add_option("KIND", *kind, "bash, zsh, fish or man")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh", "fish", "man"}));
  command->callback([kind, &program] {
    const std::vector<Command> commands = commands_of(program);
    fmt::print("{}", *kind == "bash"   ? bash_file(commands)
                     : *kind == "zsh"  ? zsh_file(commands)
                     : *kind == "fish" ? fish_file(commands)
                                       : manual_page(program, commands));
  });
}

}  // namespace breccia::app
