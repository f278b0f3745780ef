"""What a run left in its folder."""

import csv
import json
import os
from collections.abc import Mapping, Sequence

import numpy

from . import _breccia
from ._breccia import FileError


def column(values):
    """Numbers as an array of float; words, such as names of stages, as one of str."""
    try:
        return numpy.array(values, dtype=float)
    except ValueError:
        return numpy.array(values, dtype=str)


class Table(Mapping):
    """A CSV file of a run: columns by name as numpy arrays, and their units.

    table["time"], table.units["time"]; table.frame is a pandas.DataFrame with units in its attrs.
    """

    def __init__(self, path):
        try:
            with open(path, newline="") as file:
                rows = list(csv.reader(file))
        except OSError as error:
            raise FileError(f"{path}: {error.strerror}") from error
        if len(rows) < 2:
            raise FileError(f"{path}: names and units are missing")
        names, units, numbers = rows[0], rows[1], rows[2:]
        if numbers and len(numbers[-1]) < len(names):  # of a run that is writing it now
            numbers.pop()
        self.units = dict(zip(names, units))
        self._columns = {name: column([row[i] for row in numbers]) for i, name in enumerate(names)}

    def __getitem__(self, name):
        return self._columns[name]

    def __iter__(self):
        return iter(self._columns)

    def __len__(self):
        return len(self._columns)

    @property
    def frame(self):
        """The same as a pandas.DataFrame; needs pandas."""
        import pandas

        frame = pandas.DataFrame(self._columns)
        frame.attrs["units"] = dict(self.units)
        return frame


class Frames(Sequence):
    """Frames of a run: frames.times [s], frames[i] a dict of arrays named as in ParaView.

    "position", "radius", "lines", "triangles", "tetrahedra", and fields as "points.velocity", in float32.
    frames.units has the units of all.
    """

    def __init__(self, folder):
        self._folder = folder
        self.times = numpy.array(_breccia.frame_times(folder))

    @property
    def units(self):
        return _breccia.frame_units(self._folder, 0) if len(self.times) else {}

    def __getitem__(self, number):
        if isinstance(number, slice):
            return [self[i] for i in range(*number.indices(len(self)))]
        count = len(self.times)
        if not -count <= number < count:
            raise IndexError(f"frame {number} of {count}")
        return _breccia.read_frame(self._folder, number % count)

    def __len__(self):
        return len(self.times)


class Result:
    """A result folder: summary (a dict), history, frames, and tables such as cracks."""

    def __init__(self, folder):
        self.folder = os.fspath(folder)
        path = os.path.join(self.folder, "summary.json")
        try:
            with open(path) as file:
                self.summary = json.load(file)
        except OSError as error:
            raise FileError(f"{path}: {error.strerror}") from error
        self.history = Table(os.path.join(self.folder, "history.csv"))

    @property
    def frames(self):
        return Frames(self.folder)

    def table(self, name):
        """DIR/<name>.csv: "cracks" or "fragments" of 2D runs."""
        return Table(os.path.join(self.folder, name + ".csv"))

    @property
    def hash(self):
        """Of the final state."""
        return self.summary.get("state_hash")

    def __repr__(self):
        steps = self.summary.get("steps")
        return f"<breccia.Result {self.folder}: {self.summary.get('status')}, {steps} steps>"


def load(folder):
    """Reads a result folder; of a run that still goes on, what is there by now."""
    return Result(folder)
