"""Runs a case into a folder, as the command line would, and reads its curves."""

import pathlib

import breccia as br

cases = pathlib.Path(__file__).resolve().parents[2] / "cases"
case = br.Case(cases / "rc_slab/small.toml", set={"time.end": "0.2 ms", "output.pictures": False})
run = br.run(case, "out/curves", replace=True)

energy = run.history
lost = energy["kinetic"][0] - energy["kinetic"][-1]
print(f"{case.name}: {run.summary['steps']} steps, hash {run.hash}")
print(f"the rock lost {lost:.2f} {energy.units['kinetic']} in {1e6 * energy['time'][-1]:.0f} us")
fastest = [abs(frame["points.velocity"]).max() for frame in run.frames]
print("fastest element of each frame [m/s]:", ", ".join(f"{v:.2f}" for v in fastest))
