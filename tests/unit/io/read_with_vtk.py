#!/usr/bin/python3
"""Reads a result folder with VTK's own readers and compares it with what was written.

usage: read_with_vtk.py FOLDER EXPECTED.json
EXPECTED: a list of {"time", "step", "points", "cells", "cell_type", "links", "link_type", "point_fields",
"line_fields", "groups"}; a field is name: [components, unit, minimum, maximum, type] of its first component. Needs Debian's python3-vtk9.
"""
import json
import os
import sys
import xml.etree.ElementTree as xml

from vtkmodules.vtkCommonDataModel import vtkUnstructuredGrid
from vtkmodules.vtkCommonCore import vtkDataArray
from vtkmodules.vtkIOHDF import vtkHDFReader
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader


def fail(what):
    sys.exit("read_with_vtk: " + what)


def expect(what, found, wanted):
    if found != wanted:
        fail(f"{what} is {found}, not {wanted}")


def entries(folder, name):
    """(time, part, file) of a .pvd; the readers of VTK leave this format to ParaView."""
    root = xml.parse(os.path.join(folder, name)).getroot()
    expect(f"{name} type", root.get("type"), "Collection")
    return [(float(e.get("timestep")), int(e.get("part")), e.get("file")) for e in root.iter("DataSet")]


def entries_of_series(folder, name):
    """Likewise of a .hdf.series."""
    with open(os.path.join(folder, name), encoding="utf-8") as file:
        series = json.load(file)
    expect(f"version of {name}", series["file-series-version"], "1.0")
    return [(entry["time"], 0, entry["name"]) for entry in series["files"]]


def read(path):
    errors = []
    reader = vtkHDFReader() if path.endswith(".hdf") else vtkXMLUnstructuredGridReader()
    reader.AddObserver("ErrorEvent", lambda *arguments: errors.append(arguments[-1]))
    if not reader.CanReadFile(path):
        fail(f"VTK does not recognise {path}")
    reader.SetFileName(path)
    reader.Update()
    if errors or reader.GetErrorCode():
        fail(f"VTK reports errors in {path}: {errors}")
    grid = vtkUnstructuredGrid()
    grid.DeepCopy(reader.GetOutput())
    return grid


def check_fields(what, data, wanted):
    found = {data.GetArrayName(i) for i in range(data.GetNumberOfArrays())}
    expect(f"fields of {what}", found, set(wanted))
    for name, (components, unit, low, high, kind) in wanted.items():
        array = data.GetArray(name)
        expect(f"components of {what} {name}", array.GetNumberOfComponents(), components)
        if what.endswith(".vtu"):  # VTK reads no units of VTKHDF
            expect(f"unit of {what} {name}", array.GetInformation().Get(vtkDataArray.UNITS_LABEL()), unit)
        expect(f"type of {what} {name}", array.GetDataTypeAsString(), kind)
        if array.GetNumberOfTuples() > 0:
            expect(f"range of {what} {name}", list(array.GetRange(0)), [low, high])


def check_time(what, grid, wanted):
    expect(f"TIME of {what}", grid.GetFieldData().GetArray("TIME").GetValue(0), wanted["time"])
    expect(f"CYCLE of {what}", grid.GetFieldData().GetArray("CYCLE").GetValue(0), wanted["step"])
    codes = grid.GetFieldData().GetArray("groups")
    text = bytes(int(codes.GetValue(i)) for i in range(codes.GetNumberOfValues())) if codes else b""
    found = text.decode().split("\0")[:-1]
    expect(f"groups of {what}", found, wanted["groups"])


def main(folder, expected_file):
    with open(expected_file, encoding="utf-8") as file:
        expected = json.load(file)
    times = [frame["time"] for frame in expected]
    if os.path.exists(os.path.join(folder, "elements.pvd")):
        elements, links = entries(folder, "elements.pvd"), entries(folder, "links.pvd")
        both = sorted([(t, 0, f) for t, _, f in elements] + [(t, 1, f) for t, _, f in links])
        expect("entries of result.pvd", sorted(entries(folder, "result.pvd")), both)
    else:
        elements, links = entries_of_series(folder, "elements.hdf.series"), entries_of_series(folder, "links.hdf.series")
    expect("times of the elements", [entry[0] for entry in elements], times)
    expect("times of the links", [entry[0] for entry in links], times)
    for frame, (_, _, element_file), (_, _, link_file) in zip(expected, elements, links):
        grid = read(os.path.join(folder, element_file))
        expect(f"points of {element_file}", grid.GetNumberOfPoints(), frame["points"])
        expect(f"cells of {element_file}", grid.GetNumberOfCells(), frame["cells"])
        for cell in range(grid.GetNumberOfCells()):
            expect(f"type of cell {cell} in {element_file}", grid.GetCellType(cell), frame["cell_type"])
        check_fields(element_file, grid.GetPointData(), frame["point_fields"])
        check_time(element_file, grid, frame)
        lines = read(os.path.join(folder, link_file))
        expect(f"cells of {link_file}", lines.GetNumberOfCells(), frame["links"])
        for cell in range(lines.GetNumberOfCells()):
            expect(f"type of cell {cell} in {link_file}", lines.GetCellType(cell), frame["link_type"])
        check_fields(link_file, lines.GetCellData(), frame["line_fields"])
        check_time(link_file, lines, frame)


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2])
