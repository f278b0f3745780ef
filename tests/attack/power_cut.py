#!/usr/bin/env python3
"""A run's changes to files, in their order, are written down and replayed up to each instant; bytes
that were not synced, and names that were not, may be missing then. A checkpoint that stood durably
before the cut must be there after it, and each that is there under its name must verify."""

import os
import random
import shutil
import sys
import time

from common import Attack, CASES, arguments, breccia, checkpoints, resume, run, state_hash, tool

STEPS = 100
LIBRARY = tool("libattack_faults.so")


def events_of(path):
    events = []
    with open(path, "rb") as file:
        while line := file.readline():
            what, name, other, size, offset = line.decode().rstrip("\n").split("\t")
            events.append((what, name, other, file.read(int(size)) if what == "write" else b"", int(offset)))
    return events


class Disk:
    """Files by number, as memory and as the disk has them, and the names of both."""

    def __init__(self):
        self.data, self.synced = {}, {}
        self.names, self.durable, self.pending = {}, {}, []
        self.next = 0

    def apply(self, event):
        what, name, other, data, offset = event
        if what == "create":
            self.names[name] = self.next
            self.data[self.next], self.synced[self.next] = b"", b""
            self.next += 1
            self.pending.append(("set", name, self.names[name]))
        elif what == "write" and name in self.names:
            old = self.data[self.names[name]]
            at = len(old) if offset < 0 else offset
            self.data[self.names[name]] = old[:at].ljust(at, b"\0") + data + old[at + len(data):]
        elif what == "cut" and name in self.names:
            self.data[self.names[name]] = self.data[self.names[name]][:offset]
        elif what == "sync" and name in self.names:
            self.synced[self.names[name]] = self.data[self.names[name]]
        elif what == "sync":  # a folder: its names are on the disk
            self.commit(len([p for p in self.pending]), name)
        elif what == "rename" and name in self.names:
            self.names[other] = self.names.pop(name)
            self.pending.append(("rename", name, other, self.names[other]))
        elif what == "unlink" and name in self.names:
            del self.names[name]
            self.pending.append(("unlink", name))

    @staticmethod
    def change(names, one):
        if one[0] == "set":
            names[one[1]] = one[2]
        elif one[0] == "rename":
            names.pop(one[1], None)
            names[one[2]] = one[3]
        else:
            names.pop(one[1], None)

    def commit(self, count, folder):
        rest = []
        for one in self.pending[:count]:
            if os.path.dirname(one[1]).rstrip("/") == folder.rstrip("/"):
                self.change(self.durable, one)
            else:
                rest.append(one)
        self.pending = rest + self.pending[count:]

    def after_cut(self, random_):
        """One of the states that the disk may be in: some pending names, some of the bytes."""
        names = dict(self.durable)
        for one in self.pending:
            if random_.random() < 0.5:
                self.change(names, one)
        files = {}
        for name, number in names.items():
            synced, data = self.synced[number], self.data[number]
            keep = random_.choice(("synced", "all", "part", "zeros"))
            if keep == "synced" or data == synced:
                files[name] = synced
            elif keep == "all":
                files[name] = data
            elif keep == "part":
                files[name] = data[: random_.randint(0, len(data))] if not data.startswith(synced) else \
                    data[: random_.randint(len(synced), len(data))]
            else:
                files[name] = synced[: len(data)] + b"\0" * (len(data) - len(synced))
        return files


def main():
    options = arguments(__doc__, 100).parse_args()
    result = 0
    for case in CASES:
        attack = Attack(f"power cut, {case}", "cuts")
        folder, log = attack.path("run"), attack.path("log")
        code, text = run(case, folder, STEPS,
                         env=dict(LD_PRELOAD=LIBRARY, FAULT_BELOW=folder, FAULT_RECORD=log))
        attack.expect(code == 0, f"undisturbed: {code}: {text}")
        good = state_hash(folder)
        events = events_of(log)
        random_ = random.Random(options.seed)
        resumed = 0
        for _ in range(options.runs):
            if time.time() - attack.begun > options.seconds / len(CASES):
                break
            disk = Disk()
            cut = random_.randint(1, len(events))
            for event in events[:cut]:
                disk.apply(event)
            shutil.rmtree(folder)
            os.makedirs(os.path.join(folder, "checkpoints"))
            for name, data in disk.after_cut(random_).items():
                os.makedirs(os.path.dirname(name), exist_ok=True)
                with open(name, "wb") as file:
                    file.write(data)
            attack.runs += 1
            for path in checkpoints(folder):
                told, why = breccia("info", path)
                attack.expect(told == 0, f"cut {cut}: {path}: {told}: {why[-200:]}")
            durable = [n for n in disk.durable if n.endswith(".br") and n in disk.names]
            attack.expect(not durable or checkpoints(folder), f"cut {cut}: a durable checkpoint is lost")
            if checkpoints(folder):
                told, why = resume(folder, "--steps", str(STEPS))
                attack.expect(told == 0 and state_hash(folder) == good,
                              f"cut {cut}: resume ends with {told}, hash {state_hash(folder)}: {why[-300:]}")
                resumed += 1
        attack.note = f"({len(events)} events, {resumed} resumed)"
        result |= attack.end()
    return result


if __name__ == "__main__":
    sys.exit(main())
