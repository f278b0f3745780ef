#!/usr/bin/env python3
"""Writes the page of the Python package from its docstrings: PYTHONPATH=build/release/python reference_python.py."""
import inspect
import sys

import breccia


def text_of(thing):
    return inspect.getdoc(thing) or ""


def signature(thing):
    try:
        return str(inspect.signature(thing))
    except (TypeError, ValueError):
        return None


def block(text):
    return f"\n```text\n{text}\n```\n" if text else "\n"


def member_lines(of, name):
    member = inspect.getattr_static(of, name)
    value = getattr(of, name, None)
    if callable(value) or isinstance(member, (staticmethod, classmethod)):
        return f"### `{of.__name__}.{name}{signature(value) or '(...)'}`\n{block(text_of(value))}"
    return f"### `{of.__name__}.{name}`\n{block(text_of(member))}"


def main():
    print("# Python API\n\nWritten from the package's docstrings; how to use it: [Breccia in Python](../python.md).\n")
    print("```text\n" + text_of(breccia) + "\n```\n" if text_of(breccia) else "")
    silent = []
    names = [name for name in (getattr(breccia, "__all__", None) or dir(breccia)) if not name.startswith("_")]
    for name in names:
        thing = getattr(breccia, name)
        if inspect.ismodule(thing) or not getattr(thing, "__module__", "").split(".")[0].startswith(("breccia", "pybind11")):
            continue
        if inspect.isclass(thing) and issubclass(thing, Exception):
            also = [base.__name__ for base in thing.__mro__[1:] if base.__module__ == "builtins" and base.__name__ not in ("Exception", "BaseException", "object")]
            print(f"## `{name}`\n\n" + (f"An `Error`, also a `{also[0]}`." if also else "The base of all errors of the package.") + "\n")
            continue
        print(f"## `{name}{'' if inspect.isclass(thing) else signature(thing) or '(...)'}`\n{block(text_of(thing))}")
        if not text_of(thing):
            silent.append(name)
        if inspect.isclass(thing):
            for member in vars(thing):
                if not member.startswith("_"):
                    print(member_lines(thing, member))
    if silent:
        print("without a docstring: " + ", ".join(silent), file=sys.stderr)
    return 0


if __name__ == "__main__":
    sys.exit(main())
