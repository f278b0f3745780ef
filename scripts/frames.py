"""Reads the frames of a result folder (fields/elements_NNNN.vtu, links_NNNN.vtu) with the standard library alone."""
import array
import pathlib
import re
import struct
import zlib

CODES = {"Float32": "f", "Float64": "d", "Int32": "i", "Int64": "q", "UInt8": "B", "Int8": "b", "UInt32": "I", "UInt64": "Q"}


def appended(data, offset, code):
    """The array that begins at this place of the appended data, its blocks uncompressed."""
    blocks, size, last = struct.unpack_from("<3Q", data, offset)
    if blocks == 0:
        return array.array(code)
    sizes = struct.unpack_from(f"<{blocks}Q", data, offset + 24)
    at = offset + 24 + 8 * blocks
    text = b""
    for length in sizes:
        text += zlib.decompress(data[at:at + length])
        at += length
    return array.array(code, text)


def read(path):
    """Name -> list of numbers, or of tuples where an array has several components; 'points' are the places."""
    data = pathlib.Path(path).read_bytes()
    mark = data.index(b"<AppendedData")
    start = data.index(b"_", data.index(b">", mark)) + 1
    head = data[:mark].decode()
    result = {}
    points = head.index("<Points>")
    for found in re.finditer(r"<DataArray ([^>]*)>", head):
        attributes = dict(re.findall(r'(\w+)="([^"]*)"', found.group(1)))
        if attributes.get("format") != "appended":
            continue
        values = appended(data, start + int(attributes["offset"]), CODES[attributes["type"]])
        width = int(attributes.get("NumberOfComponents", 1))
        name = "points" if points < found.start() < head.index("</Points>") else attributes["Name"]
        result[name] = list(values) if width == 1 else list(zip(*(values[k::width] for k in range(width))))
    return result


def last(folder, kind="elements"):
    return read(sorted((pathlib.Path(folder) / "fields").glob(f"{kind}_*.vtu"))[-1])


def first(folder, kind="elements"):
    return read(sorted((pathlib.Path(folder) / "fields").glob(f"{kind}_*.vtu"))[0])
