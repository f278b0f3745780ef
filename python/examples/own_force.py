"""A load that no case file knows: wind on the upper half of a slab, stronger where it is faster."""

import pathlib

import numpy

import breccia as br

cases = pathlib.Path(__file__).resolve().parents[2] / "cases"
sim = br.Simulation(cases / "rc_slab/small.toml", threads=1)
wind = numpy.array([40.0, 0.0, 0.0])  # [m/s]
area = numpy.pi * sim.fields["radius"] ** 2
upper = sim.positions[:, 2] > numpy.median(sim.positions[:, 2])


def drag(sim):
    along = wind - sim.velocities[upper]
    speed = numpy.linalg.norm(along, axis=1, keepdims=True)
    return 0.5 * 1.2 * area[upper, None] * speed * along


force = sim.add_force(drag, on=upper)
sim.on_step(lambda sim: print(f"{1e6 * sim.time:.0f} us: {force.work:.3g} J by wind"), every=50)
sim.step(200)
print(f"of {sim.energies['work']:.3g} J of work; {sim.energies['error_relative']:.1e} is missing")
