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

import math
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
from .forces import Force
from .results import Result, load

__all__ = [
    "Case",
    "CheckFailed",
    "CheckpointError",
    "DeviceError",
    "Error",
    "Fields",
    "FileError",
    "Force",
    "InputError",
    "NumericsError",
    "Result",
    "Simulation",
    "Tensor",
    "load",
    "run",
]


class Tensor:
    """A field for from_dlpack() of numpy, PyTorch, CuPy, JAX: the state itself, in the memory of the
    GPU if that computes. It changes with each step; whoever writes to it spoils the run.
    """

    def __init__(self, simulation, name):
        self._simulation, self._name = simulation, name

    def __dlpack__(self, stream=None):
        # The simulation has waited for its own stream: other streams may read at once.
        return self._simulation._dlpack(self._name)

    def __dlpack_device__(self):
        cpu, cuda = 1, 2
        gpu = self._simulation._gpu(self._name)
        return (cuda, gpu) if gpu >= 0 else (cpu, 0)


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

    def tensor(self, name):
        """For from_dlpack(), also of a GPU without a copy."""
        if name not in self.units:
            self[name]  # says which names there are
        return Tensor(self._simulation, name)

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
        self._callbacks = []

    def on_step(self, call, every=1):
        """call(sim) after every so many steps, from here on."""
        if every < 1:
            raise ValueError("on_step(call, every): every is a number of steps above zero")
        self._callbacks.append((call, every, self.steps))
        return call

    def add_force(self, law, on=None):
        """Forces beside those of the case, from now on; returns a br.Force.

        law  law(sim), asked once a step, or constant numbers: x, y, z of each element [N] or, in 2D,
             x, y of each triangle, shared alike by its corners, or (n, 3, 2) of corners [N/m];
             of tetrahedra x, y, z of each, or (n, 4, 3) of corners [N]. One force for all may be
             given once.
        on   rows of the arrays, or True where it acts; default: everywhere

        The time step does not know how stiff such a force is: lower time.safety for stiff ones.
        """
        return Force(self, law, on)

    def step(self, count=1):
        """So many steps; none once the last stage of the case is over."""
        if not self._callbacks or count <= 0:
            return super().step(count)
        end = self.steps + count
        self._watched(math.inf, lambda sim: sim.steps >= end, [count])

    def _watched(self, until, stop, everies):
        """Runs to `until` with callbacks; stop(sim) is asked every so many steps from here."""
        begin = self.steps
        gap = math.gcd(*everies, *(n for _, every, at in self._callbacks for n in (every, begin - at)))

        def look(sim):
            for call, every, at in self._callbacks:
                if (sim.steps - at) % every == 0:
                    call(sim)
            asked = stop is not None and (sim.steps - begin) % everies[0] == 0
            return bool(asked and stop(sim))

        return self._run(until, look, gap)

    def run(self, until=None, stop=None, every=100):
        """Steps to the first step at or past `until` [s]; default: the end of the case.

        `stop(sim)` is asked every so many steps and ends the run with True. Returns whether the
        end was reached: `until`, or the end of the last stage.
        """
        until = self.case.end_time if until is None else until
        if not self._callbacks:
            return self._run(until, stop, every)
        return self._watched(until, stop, [every])

    @property
    def positions(self):
        """Centres of elements, (n, 3); corners of triangles, (n, 3, 2), or tetrahedra, (n, 4, 3) [m]."""
        return self.fields["position"]

    @property
    def velocities(self):
        """Of elements or corners, shaped like positions; half a step earlier [m/s]."""
        return self.fields["velocity"]

    @property
    def damage(self):
        """Of each element, triangle or tetrahedron, 0 whole to 1 lost [-]; worked out anew."""
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
