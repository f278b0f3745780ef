"""Cases: from a file, from text, or from a dict."""

import os

from . import _breccia


def toml_value(value):
    """A value as a TOML file writes it."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return '"' + value.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n") + '"'
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{toml_key(k)} = {toml_value(v)}" for k, v in value.items()) + " }"
    if hasattr(value, "tolist"):  # numpy's numbers and arrays
        return toml_value(value.tolist())
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(toml_value(v) for v in value) + "]"
    return repr(value)


def toml_key(key):
    plain = key and all(c.isascii() and (c.isalnum() or c in "_-") for c in key)
    return key if plain else toml_value(key)


def toml_text(case):
    """A dict of a whole case as the text of a case file."""
    return "".join(f"{toml_key(key)} = {toml_value(value)}\n" for key, value in case.items())


class Case:
    """A case that has been read, checked and completed.

    case    a path (case file, folder with case.toml, prepared model), the text of a case file (it
            has more than one line), or a dict of its keys
    set     values of keys that override it: {"time.end": 1e-3, "material.concrete.young": "30 GPa"}
    name    of a case that is text or a dict
    folder  where files that such a case names are looked for
    """

    def __init__(self, case, set=None, name="case", folder="."):
        overrides = [f"{key}={toml_value(value)}" for key, value in (set or {}).items()]
        if isinstance(case, dict):
            case = toml_text(case) + "\n"
        text = os.fspath(case)
        if "\n" in text:
            self._case = _breccia.Case.from_text(text, name, os.fspath(folder), overrides)
        else:
            self._case = _breccia.Case.from_file(text, overrides)

    @property
    def name(self):
        """As in summary.json."""
        return self._case.name

    @property
    def text(self):
        """The completed case: every key with the value used, in SI."""
        return self._case.text

    @property
    def digest(self):
        """SHA-256 of the completed case."""
        return self._case.digest

    @property
    def method(self):
        """dem3d or fdem2d."""
        return self._case.method

    @property
    def end_time(self):
        """time.end of the case [s]."""
        return self._case.end_time

    def __repr__(self):
        return f"<breccia.Case {self.name}: {self.method}, {self.digest[:12]}>"
