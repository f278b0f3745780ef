#!/usr/bin/env python3
"""Writes the page of all commands, as their own --help says them: reference_commands.py PROGRAM."""
import re
import subprocess
import sys


def help_of(program, *command):
    return subprocess.run([program, *command, "--help"], check=True, capture_output=True, text=True).stdout.rstrip()


def commands_of(help):
    """The names that a help text lists."""
    _, _, below = help.partition("Subcommands:")
    return re.findall(r"^  (\w[\w-]*) {2,}\S", below, re.MULTILINE)


def sections(program, *command):
    """Prints a section on each command of a command; their number."""
    names = commands_of(help_of(program, *command))
    count = len(names)
    for name in names:
        print(f"\n## `{' '.join(('breccia', *command, name))}`\n\n```text\n{help_of(program, *command, name)}\n```")
        count += sections(program, *command, name)
    return count


def main(program):
    print(f"# Commands\n\nWritten from the program's own `--help`.\n\n```text\n{help_of(program)}\n```")
    return 0 if sections(program) > 5 else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
