#!/usr/bin/env python3
"""Writes the page of all commands, as their own --help says them: reference_commands.py PROGRAM."""
import re
import subprocess
import sys


def help_of(program, *command):
    return subprocess.run([program, *command, "--help"], check=True, capture_output=True, text=True).stdout.rstrip()


def main(program):
    whole = help_of(program)
    names = re.findall(r"^  (\w[\w-]*) {2,}\S", whole[whole.index("Subcommands:"):], re.MULTILINE)
    print(f"# Commands\n\nWritten from the program's own `--help`.\n\n```text\n{whole}\n```")
    for name in names:
        print(f"\n## `breccia {name}`\n\n```text\n{help_of(program, name)}\n```")
    return 0 if len(names) > 5 else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
