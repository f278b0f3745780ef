import math, pathlib

def radius(z):  # 37.5 mm at the ends, 25.5 mm at the neck
    return 25.5 * math.sqrt(1.0 + (z / 69.56) ** 2)

rings, around = 24, 48
heights = [-75.0 + 150.0 * k / rings for k in range(rings + 1)]
ring = [[(radius(z) * math.cos(2 * math.pi * i / around), radius(z) * math.sin(2 * math.pi * i / around), z)
         for i in range(around)] for z in heights]
faces = []
for k in range(rings):
    for i in range(around):
        a, b, c, d = ring[k][i], ring[k][i - 1], ring[k + 1][i - 1], ring[k + 1][i]
        faces += [(b, a, d), (b, d, c)]
for end, z, turned in ((ring[0], -75.0, True), (ring[-1], 75.0, False)):
    for i in range(around):
        faces.append(((0, 0, z), end[i], end[i - 1]) if turned else ((0, 0, z), end[i - 1], end[i]))
lines = ["solid hyperboloid"]
for face in faces:
    lines += ["facet normal 0 0 0", "outer loop"] + ["vertex %.6f %.6f %.6f" % v for v in face] + ["endloop", "endfacet"]
pathlib.Path("hyperboloid.stl").write_text("\n".join(lines + ["endsolid"]) + "\n")
