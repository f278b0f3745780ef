"""Breccia in Python: how concrete and rock break.

    import breccia as br

    sim = br.Simulation(br.Case("cases/rc_slab"))
    sim.run(until=1e-3, stop=lambda sim: sim.energies["fracture"] > 2.0)
    sim.velocities          # numpy, on the CPU without a copy
    sim.hash                # that of the command line

    run = br.load("out/rc_slab")
    run.history["kinetic"]  # a column as numpy; run.history.frame is a pandas.DataFrame

Errors are those of the program, with its texts: br.InputError, br.NumericsError, ... all br.Error.
"""

from collections.abc import Mapping

from . import _breccia
from ._breccia import (
    CheckFailed,
    CheckpointError,
    DeviceError,
    Error,
    FileError,
    InputError,
    NumericsError,
    __version__,
)
from .case import Case
from .results import Result, load

__all__ = [
    "Case",
    "CheckFailed",
    "CheckpointError",
    "DeviceError",
    "Error",
    "Fields",
    "FileError",
    "InputError",
    "NumericsError",
    "Result",
    "Simulation",
    "load",
    "run",
]


class Fields(Mapping):
    """The arrays of a simulation by name; fields.units has their units.

    On the CPU an array is the state itself, read-only: it changes with each step. What is worked
    out (damage, stress, fragment) is a copy, and so is everything from a GPU.
    """

    def __init__(self, simulation):
        self._simulation = simulation
        self.units = simulation._names()

    def __getitem__(self, name):
        return self._simulation._array(name)

    def __contains__(self, name):
        return name in self.units

    def __iter__(self):
        return iter(self.units)

    def __len__(self):
        return len(self.units)


class Simulation(_breccia.Simulation):
    """A case that runs in this process. It writes nothing: br.run() leaves a result folder.

    case     a br.Case, or anything that br.Case() takes
    device   "cpu", "cuda" or "cuda:N"
    threads  of the host; default: all there are
    allow_scripts  let gmsh run .geo files of the case, which may do whatever you may
    """

    def __init__(self, case, device="cpu", threads=0, allow_scripts=False):
        self.case = case if isinstance(case, Case) else Case(case)
        super().__init__(self.case._case, device, threads, allow_scripts)
        self.fields = Fields(self)

    def run(self, until=None, stop=None, every=100):
        """Steps to the first step at or past `until` [s]; default: the end of the case.

        `stop(sim)` is asked every so many steps and ends the run with True. Returns whether the
        end was reached.
        """
        return self._run(self.case.end_time if until is None else until, stop, every)

    @property
    def positions(self):
        """Centres of the elements, (n, 3); in 2D the corners of the triangles, (n, 3, 2) [m]."""
        return self.fields["position"]

    @property
    def velocities(self):
        """Of elements or corners, shaped like positions; half a step earlier [m/s]."""
        return self.fields["velocity"]

    @property
    def damage(self):
        """Of each element or triangle, 0 whole to 1 lost [-]; worked out anew."""
        return self.fields["damage"]

    def __repr__(self):
        return f"<breccia.Simulation {self.case.name}: step {self.steps}, {self.time:.6g} s>"


def run(case, folder, device="cpu", threads=0, allow_scripts=False, replace=False, quiet=True):
    """Runs a case as `breccia run CASE -o FOLDER` would and returns br.load(FOLDER).

    replace  the run that the folder holds; else it is refused
    """
    case = case if isinstance(case, Case) else Case(case)
    _breccia.run(case._case, str(folder), device, threads, allow_scripts, replace, quiet)
    return load(folder)
