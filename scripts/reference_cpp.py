#!/usr/bin/env python3
"""Writes the page of the C++ library from its header, through doxygen's XML: reference_cpp.py HEADER."""
import pathlib
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as xml


def text(node):
    return " ".join("".join(node.itertext()).split()) if node is not None else ""


def told(node):
    parts = []
    for kind in ("briefdescription", "detaileddescription"):
        for part in node.findall(f"{kind}/para"):
            for listed in part.findall("parameterlist"):
                for item in listed.findall("parameteritem"):
                    name = text(item.find("parameternamelist"))
                    parts.append(f"- {'throws ' if listed.get('kind') == 'exception' else ''}`{name}`: {text(item.find('parameterdescription'))}")
                part.remove(listed)
            for section in part.findall("simplesect"):
                parts.append(f"- {section.get('kind')}: {text(section)}")
                part.remove(section)
            if text(part):
                parts.insert(len(parts) if not parts or not parts[-1].startswith("- ") else 0, text(part).replace("<", "&lt;") + "\n")
    return "\n".join(parts)


def declaration(member):
    kind = member.get("kind")
    if kind == "enum":
        return f"enum {text(member.find('name'))} {{ {', '.join(text(v.find('name')) for v in member.findall('enumvalue'))} }}"
    begin = " ".join(filter(None, [text(member.find("type")), text(member.find("name"))]))
    return begin + (text(member.find("argsstring")) if kind == "function" else text(member.find("initializer")) and " " + text(member.find("initializer")))


def members(compound):
    for member in compound.iter("memberdef"):
        if member.get("prot") == "public" and member.get("kind") in ("function", "variable", "enum", "typedef"):
            yield member


def main(header):
    with tempfile.TemporaryDirectory() as folder:
        settings = f"INPUT={header}\nOUTPUT_DIRECTORY={folder}\nGENERATE_XML=YES\nGENERATE_HTML=NO\nGENERATE_LATEX=NO\nQUIET=YES\nWARNINGS=NO\nEXTRACT_ALL=YES\n" \
                   "MACRO_EXPANSION=YES\nEXPAND_ONLY_PREDEF=YES\nPREDEFINED=BR_API=\nJAVADOC_AUTOBRIEF=YES\nCASE_SENSE_NAMES=YES\n"
        subprocess.run(["doxygen", "-"], input=settings, text=True, check=True, stdout=subprocess.DEVNULL)
        compounds = {path.stem: xml.parse(path).getroot().find("compounddef") for path in sorted(pathlib.Path(folder, "xml").glob("*.xml")) if path.stem != "index"}
    print("# C++ API\n\nWritten from [breccia/breccia.hpp](../../include/breccia/breccia.hpp); how to link with it: [install](../install.md#as-a-library).\n")
    shown = 0
    for kind in ("class", "struct", "namespace"):
        for compound in compounds.values():
            if compound is None or compound.get("kind") != kind or compound.get("prot", "public") != "public":
                continue
            listed = list(members(compound))
            if not listed:
                continue
            print(f"## `{text(compound.find('compoundname'))}`\n\n{told(compound)}\n")
            for member in listed:
                print(f"```cpp\n{declaration(member)}\n```\n{told(member)}\n")
                shown += 1
    return 0 if shown > 20 else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
