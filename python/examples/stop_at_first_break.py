"""Runs the small slab until its first link breaks, and tells where."""

import pathlib

import breccia as br

cases = pathlib.Path(__file__).resolve().parents[2] / "cases"
sim = br.Simulation(cases / "rc_slab/small.toml")


def broken(sim):
    return (sim.fields["links.concrete.opening"] < 0.0).any()


if sim.run(stop=broken, every=5):
    print("nothing broke")
else:
    which = int((sim.fields["links.concrete.opening"] < 0.0).argmax())
    ends = [sim.fields[f"links.concrete.{end}"][which] for end in "ab"]
    x, y, z = 1e3 * sim.positions[ends].mean(axis=0)
    print(f"{1e6 * sim.time:.1f} us: the first link breaks at ({x:.1f}, {y:.1f}, {z:.1f}) mm")
    print(f"{sim.energies['kinetic']:.1f} J kinetic, {sim.energies['elastic']:.2f} J elastic")
