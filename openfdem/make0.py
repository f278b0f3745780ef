# Rock between plates, cut into triangles: a mesh of Abaqus, in metres.
points, elements = {}, {"ROCK": [], "UP": [], "DOWN": []}
for part, x0, y0, nx, ny in (("ROCK", -25, -50, 20, 40), ("UP", -35, 50, 28, 2), ("DOWN", -35, -55, 28, 2)):
    def node(i, j):
        return points.setdefault((part, x0 + 2.5 * i, y0 + 2.5 * j), len(points) + 1)
    for i in range(nx):
        for j in range(ny):
            a, b, c, d = node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)
            elements[part] += [(a, b, c), (a, c, d)] if (i + j) % 2 else [(a, b, d), (b, c, d)]
with open("Job-3.inp", "w") as out:
    out.write("*NODE\n" + "".join(f"{n}, {x / 1000}, {y / 1000}, 0\n" for (_, x, y), n in points.items()))
    number = 0
    for part, all in elements.items():
        out.write(f"*ELEMENT, TYPE=CPE3, ELSET={part}\n")
        for corners in all:
            number += 1
            out.write(f"{number}, {', '.join(map(str, corners))}\n")
