"""A specimen of spheres in YADE with its concrete model (Cpm), pressed or pulled along z.

Usage: yade -n -x -j1 yade_specimen.py SPHERES.csv CURVE.csv RATE END HELD HEIGHT AREA RANGE LAYER

SPHERES.csv holds x,y,z,radius in m. Layers of thickness LAYER at both ends part at RATE (1/s; below 0: approach) until the
strain END; HELD = 1: they are held across and against turning, 0: free. The parameters of the material are those of YADE's
own examples/concrete/uniax.py; damping is 0.3, as in `breccia test`. CURVE.csv gets strain and stress (Pa), tension positive.
"""
import csv
import math
import sys

spheres, curve = sys.argv[-9], sys.argv[-8]
rate, end, held, height, area, reach, layer = map(float, sys.argv[-7:])

concrete = O.materials.append(
    CpmMat(young=24e9, poisson=0.2, sigmaT=3.5e6, frictionAngle=math.atan(0.8), epsCrackOnset=1e-4, relDuctility=30,
           density=2400 / 0.56))
with open(spheres, newline="") as lines:
    for row in csv.DictReader(lines):
        O.bodies.append(utils.sphere(tuple(float(row[c]) for c in "xyz"), float(row["radius"]), material=concrete))
ends = {1: [], -1: []}
for b in O.bodies:
    z = b.state.pos[2]
    b.state.vel = (0, 0, rate * z)  # no shock at the start
    for sense, members in ends.items():
        if sense * z > height / 2 - layer:
            members.append(b.id)
            b.state.blockedDOFs = "xyzXYZ" if held else "z"
            b.state.vel = (0, 0, sense * rate * height / 2)
box = Bo1_Sphere_Aabb(aabbEnlargeFactor=reach)
touch = Ig2_Sphere_Sphere_ScGeom(interactionDetectionFactor=reach)
O.engines = [
    ForceResetter(),
    InsertionSortCollider([box], verletDist=0.0005),
    InteractionLoop([touch], [Ip2_CpmMat_CpmMat_CpmPhys()], [Law2_ScGeom_CpmPhys_Cpm()]),
    NewtonIntegrator(damping=0.3, gravity=(0, 0, 0)),
]
O.dt = 0.7 * utils.PWaveTimeStep()
O.step()
links = sum(1 for i in O.interactions if i.isReal)
touch.interactionDetectionFactor = 1.0
box.aabbEnlargeFactor = 1.0


def mean_place(members):
    return sum(O.bodies[i].state.pos[2] for i in members) / len(members)


start = mean_place(ends[1]) - mean_place(ends[-1])
steps = int(end / abs(rate) / O.dt)
with open(curve, "w") as file:
    file.write("strain,stress\n")
    for row in range(200):
        O.run(steps // 200, True)
        force = 0.5 * (sum(O.forces.f(i)[2] for i in ends[-1]) - sum(O.forces.f(i)[2] for i in ends[1]))
        file.write(f"{(mean_place(ends[1]) - mean_place(ends[-1])) / start - 1},{force / area}\n")
print(f"links {links}")
