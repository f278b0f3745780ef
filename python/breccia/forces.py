"""Forces of your own, beside those of a case."""

import weakref

import numpy


class Force:
    """A force that was added to a simulation: force.work [J; in 2D J/m], force.off()."""

    def __init__(self, simulation, law, on):
        self._law = law
        self._is_on = True
        self._shape = simulation.positions.shape[1:]  # of an element, or of the corners of one
        if on is None:
            on = numpy.arange(simulation.items)
        on = numpy.asarray(on)
        self.on = numpy.flatnonzero(on) if on.dtype == bool else on.astype(numpy.int64).ravel()
        self._simulation = weakref.proxy(simulation)  # which keeps this: no circle
        self._number = simulation._add_force(self.on.tolist(), self._numbers)

    def _numbers(self, simulation):
        count = len(self.on)
        shape = (count, *self._shape)
        if not self._is_on:
            return numpy.zeros(shape)
        law = self._law
        force = numpy.asarray(law(simulation) if callable(law) else law, dtype=float)
        if len(self._shape) == 2 and force.ndim < 3:  # of whole triangles or tetrahedra
            corners, parts = self._shape
            force = numpy.broadcast_to(force, (count, parts))[:, None, :] / corners
        return numpy.broadcast_to(force, shape)

    @property
    def work(self):
        """Done so far [J; in 2D J/m]; it is part of sim.energies["work"]."""
        return self._simulation._work_of_force(self._number)

    def off(self):
        """The force of this moment is the last one that is not zero."""
        self._is_on = False
