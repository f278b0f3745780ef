"""A case without a file: how much speed a collision leaves, by the step of time."""

import breccia as br


def case(safety):
    ball = {"shape": "element", "material": "rock", "radius": "10 mm"}
    return br.Case(
        {
            "method": "dem3d",
            "time": {"end": "2 ms", "safety": safety},
            "energy": {"warn": 0.0, "stop": 0.0},
            "material": {"rock": {"law": "grain", "young": "1 GPa"}},
            "body": [
                {"name": "left", "center": [-0.011, 0, 0], "velocity": [2.0, 0.0, 0.0], **ball},
                {"name": "right", "center": [0.011, 0, 0], "velocity": [-2.0, 0.0, 0.0], **ball},
            ],
        }
    )


for safety in (0.4, 0.2, 0.1):
    sim = br.Simulation(case(safety), threads=1)
    before = sim.velocities[0, 0]
    sim.run()
    print(f"safety {safety}: {sim.steps} steps, speeds are {-sim.velocities[0, 0] / before:.4f}")
