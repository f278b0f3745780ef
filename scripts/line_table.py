#!/usr/bin/env python3
"""Counts the lines of src: by folder, by purpose, and what a reader of one method meets. Tables for docs/architecture.md.

Every file has one purpose, the first whose pattern fits; a file without one is an error."""

import fnmatch
import pathlib
import sys

ROOT = pathlib.Path(__file__).parent.parent
FOLDERS = ["exec math", "core", "domain", "dem", "fdem", "fdem3", "fdem_shared", "coupled", "prepare", "io", "run", "app", "report laboratory api"]
PURPOSES = [  # words, lines at 20a0ddb, patterns
    ("laws", 1313, "*/laws/*"),
    ("device only: launches led by its clock, wide kernels, graphs, memory", 2434,
     "*/stepping/device_run.cpp fdem_shared/device_run.hpp */stepping/wide_kernels.hpp core/device_run.hpp core/timed.hpp core/step_clock.hpp "
     "exec/*device* exec/cuda.hpp exec/early.hpp exec/launch* exec/lockstep* exec/multiprocessors.hpp exec/peer_memory* "
     "exec/shadow_launches* exec/step_graph* exec/staging* domain/peer_link*"),
    ("tiles in a multiprocessor's memory", 0, "dem/tiles/*"),
    ("packs only (AVX2, AVX-512)", 1132,
     "*/lanes/* */stepping/kernel_lanes* fdem/contact/couple_lanes.hpp fdem/joints/joint_lanes.hpp exec/lanes* exec/whole_packs.hpp math/pack.hpp math/lanes.hpp math/records.hpp"),
    ("ranks", 4805, "domain/* dem/ranks* fdem*/ranks* fdem_shared/migration.hpp fdem_shared/rings.hpp */relations.hpp core/relation.hpp run/method/shared_world.hpp run/frames/frame_parts*"),
    ("search, pair lists, travel", 2055,
     "core/broad_phase* core/cell_grid* core/pair_list* core/incidence* core/travel* core/select* core/rows* core/drift* "
     "dem/search* dem/near.hpp fdem*/contact/search* fdem_shared/search.hpp fdem_shared/separated.hpp fdem_shared/shared_marks.hpp fdem/contact/nearness*"),
    ("ledger, probes, hash, fragments, stress", 1575,
     "*/emission* */energy* */energies.hpp */observe* */observations.hpp */readings.hpp */probes* core/probe* core/quantity* core/state_hash* core/pieces* core/unsound* core/gauge* dem/stress*"),
    ("stages, servos, tables over time, fluid, walls with mass", 0,
     "*/servos* */servo_forces.hpp */face_push.hpp */held_couples.hpp */over_time.hpp */prescribed.hpp */loaded_sides.hpp */fluid/* */setup/stages* */setup/removal* core/stages* core/servo* core/table_over_time* dem/free_walls* run/stage_control*"),
    ("state, kernels, step, set-up of the methods", 5498, "dem/* fdem/* fdem3/* fdem_shared/* coupled/* core/kernel* core/stepping* core/fields* core/world_space* "
     "core/planes* core/precision* core/region* core/read_only* core/set_up* core/on_host*"),
    ("plain execution: arrays, loops, sort, errors; vectors", 1287, "exec/* math/*"),
    ("case files, keys, units, checks of cases", 3128, "io/case/* core/* prepare/checks/* run/method/checks* run/method/shown* run/case*"),
    ("packings, bars, linking, LDPM particles and facets", 1498, "prepare/packing/* prepare/ldpm/*"),
    ("meshes and shapes", 2871, "prepare/meshing/* prepare/shapes/* prepare/*"),
    ("pictures", 2363, "io/picture/*"),
    ("frames: writers and readers", 1394, "io/vtu/* io/frame* run/frames/*"),
    ("checkpoints, durable files, digests", 1235, "io/* run/results/checkpoints* run/results/result_folder*"),
    ("outer loop, records, summary, machine", 2366, "run/*"),
    ("command line", 1059, "app/*"),
    ("report, laboratory, library", 0, "report/* laboratory/* api/*"),
]
LATER = [  # what has come since 20a0ddb in files of its own; the rest is that commit's tree, grown
    ("tetrahedra with joints and contact, meshes of solids", "fdem3/* prepare/tetrahedra/* prepare/*fdem3* run/*fdem3* */*solid*"),
    ("spheres and tetrahedra in one run", "coupled/* *coupled*"),
    ("LDPM: particles, facets, law", "*ldpm*"),
    ("steps in a multiprocessor's memory (tiles)", "dem/tiles/*"),
    ("stages, servos, tables over time, bodies taken out, walls with mass", "*stage* *servo* */over_time* */table_over_time* */removal* dem/free_walls*"),
    ("walls of any mesh, noses; acoustic emission; drift", "dem/wall_mesh* dem/wall_nose* dem/setup/wall* *emission* *drift*"),
    ("fluid in cracks, cavities, bolts", "*fluid* *bolt* *cavity*"),
    ("parallel bonds, effective moduli, joint sets, bedded rock, failure of rock beside a joint", "*parallel_bond* *effective* *joint_set* *bedd* */rock_failure*"),
    ("shapes of any surface; stiffness and fracture energy of packings", "prepare/shapes/* prepare/packing/stiffness* prepare/packing/elastic_network* prepare/packing/*energy*"),
    ("laboratory: sweeps, tests of a material, calibration", "laboratory/* app/calibrate* app/sweep* app/test.cpp app/targets* app/side_by_side*"),
    ("report in a browser, sentences of what a run shows", "report/* app/report* app/findings*"),
    ("library for C++ and Python", "api/*"),
    ("films, vector pictures, VTKHDF, live views", "*film* */vector_* */vtkhdf* */hdf_* app/camera_path* app/serve* app/watch* app/board* app/curve*"),
    ("library of materials, manual of keys, templates; commands doctor, explain, info, verify",
     "*material_library* app/explain* app/doctor* app/new* app/templates* app/materials* app/keys* app/geometry* app/info* app/verify* app/shell* *case_keys*"),
    ("forecasts, plan of memory, audit", "*forecast* *memory_plan* *audit*"),
    ("ranks that die or stop, GPUs that read each other, simulated ranks", "domain/watchdog* domain/together* domain/peer_link* exec/peer_memory* *simulated*"),
    ("a device's schedule on the processor", "exec/lockstep* exec/shadow_launches*"),
]
THEN = {"exec math": 2941, "core": 2343, "domain": 2930, "dem": 5646, "fdem fdem_shared": 6554, "prepare": 4994, "io": 5485, "run": 4061, "app": 1059}
SHARED_METHOD = "{m}/world.hpp {m}/case.hpp {m}/stepping/step.* {m}/stepping/host_run.cpp {m}/stepping/launches.hpp "
READER = {
    "dem": [
        ("**the method**: world, kernels, the laws of concrete links and contacts or of triangles, joints and couples, search, the step on the host",
         SHARED_METHOD.format(m="dem") + "dem/elements.hpp dem/element_kernels.hpp dem/pair_forces.hpp dem/link_sums.hpp dem/contacts.hpp dem/wall.hpp "
         "dem/laws/concrete_link.hpp dem/laws/concrete_parts.hpp dem/laws/contact.hpp dem/laws/pair_motion.hpp dem/laws/tension_softening.hpp dem/links/concrete.hpp "
         "dem/links/link_set.hpp dem/links/all.hpp dem/push_of_links.hpp dem/stepping/add_links.hpp dem/search.cpp dem/near.hpp"),
        ("other laws: steel, interface, parallel bond, LDPM; joints that wake; corners that move as one; loads; what tetrahedra alone need of the search; fluid; bolts; walls with mass or a nose",
         "dem/laws/* dem/links/* dem/free_walls* dem/wall_*"),
        ("set-up, keys, stages, servos", "dem/setup/* dem/servos*"),
        ("energies, probes, hash, counts, stress", "dem/emission* dem/energy* dem/probes* dem/observe* dem/stress*"),
        ("launches on a device, wide kernels, packs", "dem/stepping/* dem/lanes/*"),
        ("tiles in a multiprocessor's memory", "dem/tiles/*"),
        ("ranks", "dem/ranks* dem/relations.hpp"),
    ],
    "fdem": [
        ("", SHARED_METHOD.format(m="fdem") + "fdem/shape.hpp fdem/triangles/triangle* fdem/triangles/motion.hpp fdem/joints/joints.hpp fdem/joints/joint_kernels.hpp fdem/laws/elastic_triangle.hpp fdem/laws/joint_bond.hpp "
         "fdem/laws/potential_contact.hpp fdem/contact/couples.hpp fdem/contact/search* "
         "fdem_shared/shape.hpp fdem_shared/search.hpp fdem_shared/shared_marks.hpp fdem_shared/exposed.hpp fdem_shared/step* fdem_shared/host_run.hpp "
         "fdem_shared/motion.hpp fdem_shared/prescribed.hpp fdem_shared/stable_parts.hpp"),
        ("", "fdem/joints/* fdem/laws/* fdem/triangles/loads.hpp fdem_shared/bundle* fdem_shared/insertion* fdem_shared/separated.hpp fdem/fluid/* fdem_shared/fluid/* fdem_shared/sides_now.hpp fdem_shared/bolts/* fdem/bolts* fdem_shared/laws/* fdem/contact/nearness.hpp"),
        ("", "fdem/setup/* fdem/servos* fdem_shared/setup/* fdem_shared/servo* fdem_shared/face_push.hpp fdem_shared/held_couples.hpp fdem_shared/rigid* fdem_shared/over_time.hpp fdem_shared/loaded_sides.hpp"),
        ("", "fdem/emission* fdem3/emission* fdem_shared/emission.hpp fdem/energy* fdem/probes* fdem/observe* fdem_shared/energies.hpp fdem_shared/obs* fdem_shared/joint_stages.hpp fdem_shared/readings.hpp"),
        ("", "fdem/stepping/* fdem_shared/columns.hpp fdem_shared/wanted.hpp fdem_shared/device_run.hpp fdem_shared/busy_items.hpp fdem_shared/noting_move.hpp fdem/lanes/* fdem/contact/couple_lanes.hpp fdem/joints/joint_lanes.hpp"),
        ("", "nothing"),
        ("", "fdem/ranks* fdem/relations.hpp fdem_shared/ranks.hpp fdem_shared/ghosts.hpp fdem_shared/migration.hpp fdem_shared/rings.hpp fdem_shared/relations.hpp"),
    ],
}

FOLDERS_OF = {"dem": ["dem"], "fdem": ["fdem", "fdem_shared"]}


def is_code(line):
    text = line.strip()
    return bool(text) and not text.startswith("//")


def counted(files):
    lines = [line for path in files for line in path.read_text().splitlines()]
    return len(lines), sum(map(is_code, lines))


def sorted_into(patterns, files, source):
    """The files of each pattern list, the first that fits; and those of none."""
    groups, left = [[] for _ in patterns], []
    for path in files:
        name = path.relative_to(source).as_posix()
        fits = [k for k, words in enumerate(patterns) if any(fnmatch.fnmatch(name, word) for word in words.split())]
        (groups[fits[0]] if fits else left).append(path)
    return groups, left


def main():
    source = ROOT / "src"
    files = sorted(path for path in source.rglob("*") if path.suffix in (".hpp", ".cpp"))
    print("| folder | lines | code |\n|---|---|---|")
    for names in FOLDERS:
        own = [path for path in files if path.relative_to(source).parts[0] in names.split()]
        print(f"| `{'`, `'.join(names.split())}` | {counted(own)[0]:,} | {counted(own)[1]:,} |")
    print(f"| all | {counted(files)[0]:,} | {counted(files)[1]:,} |\n")

    groups, left = sorted_into([patterns for _, _, patterns in PURPOSES], files, source)
    print("| purpose | then | now | files |\n|---|---|---|---|")
    for (words, then, _), group in zip(PURPOSES, groups):
        print(f"| {words} | {then:,} | {counted(group)[0]:,} | {len(group)} |".replace("| 0 | ", "| - | "))
    print()
    later, grown = sorted_into([patterns for _, patterns in LATER], files, source)
    print("| came since, in files of its own | lines | code | files |\n|---|---|---|---|")
    for (words, _), group in zip(LATER, later):
        print(f"| {words} | {counted(group)[0]:,} | {counted(group)[1]:,} | {len(group)} |")
    whole = [path for group in later for path in group]
    print(f"| all of these | {counted(whole)[0]:,} | {counted(whole)[1]:,} | {len(whole)} |\n")
    print("| the tree of then | then | now |\n|---|---|---|")
    for names, then in THEN.items():
        own = [path for path in grown if path.relative_to(source).parts[0] in names.split()]
        print(f"| `{'`, `'.join(names.split())}` | {then:,} | {counted(own)[0]:,} |")
    print(f"| all | {sum(THEN.values()):,} | {counted(grown)[0]:,} |\n")
    print("| | DEM | FDEM |\n|---|---|---|")
    both = {m: sorted_into([patterns for _, patterns in READER[m]], [p for p in files if p.relative_to(source).parts[0] in FOLDERS_OF[m]], source) for m in READER}
    for k, (words, _) in enumerate(READER["dem"]):
        cells = []
        for m in READER:
            lines, code = counted(both[m][0][k])
            cells.append("-" if lines == 0 else f"**{lines:,}** ({code:,})" if k == 0 else f"{lines:,}")
        print(f"| {words} | {' | '.join(cells)} |")
    left += both["dem"][1] + both["fdem"][1]
    for path in left:
        print(f"{path.relative_to(ROOT)} has no purpose: name one in scripts/line_table.py", file=sys.stderr)
    return 1 if left else 0


if __name__ == "__main__":
    sys.exit(main())
