"""The notched beams of tianjuxue/jax-ldpm as files of one LDPM body: the published block, and blocks of coarse particles instead of its two elastic ones."""
import itertools
import math
import random

LENGTH = 525.5  # of an outer block [mm]
ORDER = ((0, 1, 2), (0, 1, 3), (0, 2, 1), (0, 2, 3), (0, 3, 1), (0, 3, 2), (1, 2, 0), (1, 2, 3), (1, 3, 0), (1, 3, 2), (2, 3, 0), (2, 3, 1))  # edge, corner opposite to the face


def less(p, q):
    return (p[0] - q[0], p[1] - q[1], p[2] - q[2])


def dot(p, q):
    return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]


def cross(p, q):
    return (p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0])


def volume(x, tet):
    a, b, c, d = (x[k] for k in tet)
    return dot(less(b, a), cross(less(c, a), less(d, a))) / 6


def ball(x, tet):
    """Centre and squared radius of the sphere through four points."""
    a, b, c, d = (x[k] for k in tet)
    u, v, w = less(b, a), less(c, a), less(d, a)
    vw, wu, uv = cross(v, w), cross(w, u), cross(u, v)
    twice = 2 * dot(u, vw)
    uu, vv, ww = dot(u, u), dot(v, v), dot(w, w)
    r = tuple((uu * vw[k] + vv * wu[k] + ww * uv[k]) / twice for k in range(3))
    return tuple(a[k] + r[k] for k in range(3)), dot(r, r)


def delaunay(points, far):
    """Tetrahedra of Delaunay's triangulation, points added one by one (Bowyer, Watson). far: a length much larger than the body."""
    x = list(points) + [(-far, -far, -far), (3 * far, -far, -far), (-far, 3 * far, -far), (-far, -far, 3 * far)]
    n = len(points)
    tets = {(n, n + 1, n + 2, n + 3): ball(x, (n, n + 1, n + 2, n + 3))}
    for k in range(n):
        inside = [t for t, (c, rr) in tets.items() if dot(e := less(x[k], c), e) < rr]
        faces = {}
        for t in inside:
            for face in itertools.combinations(t, 3):
                faces[face] = faces.get(face, 0) + 1
            del tets[t]
        for face, times in faces.items():
            if times == 1:
                t = tuple(sorted((*face, k)))
                tets[t] = ball(x, t)
    return [t for t in tets if t[3] < n]


def middle(p, v, radius):
    """Between a point and the sphere of a particle."""
    e = less(v, p)
    h = math.sqrt(dot(e, e))
    return tuple(p[k] + e[k] * (h - radius) / (2 * h) for k in range(3))


def mean(points):
    return tuple(sum(p[k] for p in points) / len(points) for k in range(3))


def corners_of(x, radius, tet):
    """The corners of the twelve facets of a tetrahedron, in the order of the files."""
    edge, face = {}, {}
    for i, j in itertools.combinations(range(4), 2):
        p, q, r, s = x[tet[i]], x[tet[j]], radius[tet[i]], radius[tet[j]]
        e = less(q, p)
        length = math.sqrt(dot(e, e))
        edge[i, j] = tuple(p[k] + e[k] * (r + (length - r - s) / 2) / length for k in range(3))
    for out in range(4):
        of = [k for k in range(4) if k != out]
        face[out] = mean([middle(edge[tuple(k for k in of if k != v)], x[tet[v]], radius[tet[v]]) for v in of])
    inner = mean([middle(face[v], x[tet[v]], radius[tet[v]]) for v in range(4)])
    for i, j, out in ORDER:
        yield from (inner, face[out], edge[i, j])


def outer_block(joint, side, seed):
    """Particles of an outer block, those of the joint first, and its tetrahedra. side: -1 left, 1 right of a joint at x = 0."""
    draw = random.Random(seed)
    points = list(joint)
    at, gap = 0.0, 14.0
    layers = []
    while at < LENGTH - 0.7 * gap:
        at = LENGTH if at + 1.6 * gap > LENGTH else at + gap
        layers.append((at, gap))
        gap = min(1.35 * gap, 65.0)
    for at, gap in layers:
        count_y, count_z = (max(2, round(width / gap)) for width in (100, 200))
        for i, j in itertools.product(range(count_y + 1), range(count_z + 1)):
            p = [at, 100 * i / count_y, 200 * j / count_z]
            free = (at < LENGTH, 0 < i < count_y, 0 < j < count_z)
            points.append((side * (p[0] + free[0] * draw.uniform(-0.1, 0.1) * gap), *(p[k] + free[k] * draw.uniform(-0.1, 0.1) * gap for k in (1, 2))))
    tets = [t for t in delaunay(points, 1e5) if abs(volume(points, t)) > 1e-3]
    filled = sum(abs(volume(points, t)) for t in tets)
    if abs(filled / (LENGTH * 2e4) - 1) > 1e-3:
        raise SystemExit(f"outer block: tetrahedra fill {filled} mm3")
    return points, tets


def beam(points, tets, radius, corners):
    """Adds the outer blocks to the block of 100 x 100 x 200 mm. corners: of the block's facets, 36 a tetrahedron, or None: by radii."""
    x, cells, size = list(points), [tuple(t) for t in tets], list(radius)
    corners = list(corners) if corners else [p for t in tets for p in corners_of(x, size, t)]
    for side, plane in ((-1, 0.0), (1, 100.0)):
        joint = [k for k, p in enumerate(points) if abs(p[0] - plane) < 1e-5]
        own, own_tets = outer_block([(0.0, points[k][1], points[k][2]) for k in joint], side, 3 + side)
        number = joint + list(range(len(x), len(x) + len(own) - len(joint)))
        x += [(p[0] + plane, p[1], p[2]) for p in own[len(joint):]]
        size += [0.0] * (len(own) - len(joint))
        for t in own_tets:
            cell = tuple(number[k] for k in t)
            cells.append(cell)
            corners += corners_of(x, size, cell)
    return x, cells, corners
