#!/usr/bin/env python3
"""Opens the files of the frame that paraview.cpp writes with meshio (Debian's python3-meshio), which knows VTK's format
by itself; passes with a word where it is not installed."""

import sys

try:
    import meshio
except ImportError:
    print("no meshio here (package python3-meshio): its reading is not tested")
    sys.exit(0)

folder = sys.argv[1]
elements = meshio.read(f"{folder}/fields/elements_0000.vtu")
lines = meshio.read(f"{folder}/fields/links_0000.vtu")
if sys.argv[2:] == ["solid"]:
    assert elements.cells[0].type == "tetra" and elements.cells[0].data.tolist() == [[0, 1, 2, 3], [4, 5, 6, 7]], elements
    assert lines.cells[0].type == "triangle" and lines.cells[0].data.tolist() == [[8, 9, 10]], lines
    assert elements.cell_data["stress"][0].tolist() == [list(range(6)), list(range(10, 16))]  # xx, yy, zz, xy, yz, xz
    assert elements.cell_data["exposed"][0].tolist() == [15, 7] and lines.cell_data["mode"][0].tolist() == [0.25]
    assert sorted(elements.cell_data) == ["exposed", "pressure", "stress"], elements.cell_data
    sys.exit(0)
ids = elements.point_data["id"]
assert elements.cells[0].type == "triangle" and elements.cells[0].data.tolist() == [[0, 1, 2], [1, 2, 3]], elements
assert ids.dtype == "int32" and ids.tolist() == [2**24 + 1 + i for i in range(4)], ids
assert elements.point_data["damage"].dtype == "float32" and elements.point_data["damage"][0] == -7.5
assert elements.point_data["velocity"].shape == (4, 3)
assert lines.cells[0].type == "line" and lines.cell_data["kind"][0].tolist() == [0, 1, 2]
stress = elements.cell_data["stress"][0]
assert stress.tolist() == [[1, 3, 7, 5, 0, 0], [2, 4, 8, 6, 0, 0]], stress  # xx, yy, zz, xy, yz, xz
assert sorted(elements.cell_data) == ["group", "stress"], elements.cell_data
