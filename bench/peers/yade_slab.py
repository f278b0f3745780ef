"""The slab of cases/rc_slab in YADE with its concrete model (Cpm), run as told line by line.

Usage: yade -n -x -j1 yade_slab.py FOLDER   (the arguments after the script's name are its own)

FOLDER holds elements.csv and links.csv as `breccia bench --paced` exports them, and dt.txt, the time
step in s. The elements are those of Breccia: same places, radii, masses, supports, velocity. Every link of
Breccia becomes one cohesive Cpm interaction, so both programs have the same links to the last one. Bars
are spheres like the others here, of the concrete model: YADE does less work on them than Breccia does.

Commands on standard input, one a line; each answer is one line on the pipe FOLDER/answers:
  steps N    N whole steps (forces, reset, collider, integration)
  until T    steps until the simulated time T in s
"""
import csv
import json
import sys
import time

folder = sys.argv[-1]


def rows(name):
    with open(f"{folder}/{name}.csv", newline="") as lines:
        table = list(csv.DictReader(lines))
    return table[1:]  # the first row holds units


concrete = O.materials.append(
    CpmMat(young=30e9, poisson=0.2, sigmaT=2.2e6, frictionAngle=0.5236, epsCrackOnset=7.3e-5,
           relDuctility=10, density=2400))
O.engines = [
    ForceResetter(),
    InsertionSortCollider([Bo1_Sphere_Aabb()]),
    InteractionLoop([Ig2_Sphere_Sphere_ScGeom()], [Ip2_CpmMat_CpmMat_CpmPhys(cohesiveThresholdIter=1)],
                    [Law2_ScGeom_CpmPhys_Cpm()]),
    NewtonIntegrator(damping=0.0, gravity=(0, 0, 0)),
]
for row in rows("elements"):
    radius, mass = float(row["radius"]), float(row["mass"])
    body = utils.sphere(tuple(float(row[c]) for c in "xyz"), radius, material=concrete)
    body.state.mass = mass
    body.state.inertia = Vector3(1, 1, 1) * (0.4 * mass * radius**2)
    if row["fixed"] != "0":
        body.state.blockedDOFs = "xyzXYZ"
    if row["group"] == "impactor":
        body.state.vel = (0, 0, -30)
    O.bodies.append(body)
links = rows("links")
for link in links:
    utils.createInteraction(int(link["a"]), int(link["b"]))
O.dt = float(open(f"{folder}/dt.txt").read())


def count_cohesive():
    return sum(1 for i in O.interactions if i.isReal and i.phys.isCohesive)


def take(steps):
    wall, processor = time.perf_counter(), time.process_time()
    O.run(steps, True)
    return {"seconds": time.perf_counter() - wall, "processor_seconds": time.process_time() - processor,
            "steps": steps, "time": O.time, "dt": O.dt}


def resident_bytes():
    import resource
    return 1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss


with open(f"{folder}/answers", "w") as answers:
    def answer(value):
        answers.write(json.dumps(value) + "\n")
        answers.flush()

    answer({"elements": len(O.bodies), "links": count_cohesive(), "version": yade.config.version,
            "p_wave_step": utils.PWaveTimeStep()})
    for line in sys.stdin:
        verb, value = line.split()
        if verb == "until":
            done = take(max(0, round((float(value) - O.time) / O.dt)))
        else:
            done = take(int(value))
        done["interactions"] = O.interactions.countReal()
        done["memory"] = resident_bytes()
        fastest = max(b.state.vel.norm() for b in O.bodies)
        done["fastest"] = fastest
        answer(done)
