"""Cracks of a plane run that meet each other, of lines of its cracks.csv."""
import math


def networks(cracks):
    """Groups of cracks that share ends."""
    groups, at = {}, {}

    def leader(i):
        while groups[i] != i:
            groups[i] = groups[groups[i]]
            i = groups[i]
        return i

    for i, c in enumerate(cracks):
        groups[i] = i
        for end in ((c["x0"], c["y0"]), (c["x1"], c["y1"])):
            key = (round(end[0] * 1e8), round(end[1] * 1e8))
            if key in at:
                groups[leader(i)] = leader(at[key])
            at[key] = i
    found = {}
    for i, c in enumerate(cracks):
        found.setdefault(leader(i), []).append(c)
    return list(found.values())


def ends(c):
    return ((c["x0"], c["y0"]), (c["x1"], c["y1"]))


def network_from(cracks, tip, reach):
    """The largest group with an end near the tip of a notch."""
    near = [n for n in networks(cracks)
            if any(math.dist(e, tip) < reach for c in n for e in ends(c))]
    return max(near, key=len, default=[])


# ---------------------------------------------------------------- quantities
