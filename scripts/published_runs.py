"""Runs of scripts that compare with published tests: several at a time, and their numbers as a table."""
import concurrent.futures
import csv
import pathlib


def run_all(jobs, run, each):
    """Calls run(*arguments) for each tuple of arguments, so many at a time; the first error ends all."""
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        for one in [pool.submit(run, *arguments) for arguments in each]:
            one.result()


def save_plot(figure, axes, path, dpi=110, columns=2):
    """Legends lie below the plots, where they hide no curve."""
    figure.tight_layout()
    for a in axes:
        a.legend(fontsize=8, loc="upper center", bbox_to_anchor=(0.5, -0.18), ncol=columns, frameon=False)
    figure.savefig(path, dpi=dpi, bbox_inches="tight")


def write_record(path, fields, records):
    """Writes the records, dictionaries of the fields, as CSV."""
    with open(path, "w", newline="") as file:
        writer = csv.DictWriter(file, fields, lineterminator="\n")
        writer.writeheader()
        writer.writerows(records)


def merge_record(path, fields, records, run_of):
    """Writes the records into a file; lines of other runs, told apart by the fields `run_of`, stay before them. @returns all lines"""
    made = {tuple(str(one[key]) for key in run_of) for one in records}
    before = []
    if path.exists():
        with open(path, newline="") as file:
            before = [one for one in csv.DictReader(file) if tuple(one[key] for key in run_of) not in made]
    write_record(path, fields, before + records)
    return before + records


def add_options(parser, device=True):
    """Options of scripts that make runs and record them."""
    parser.add_argument("--binary", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parent.parent / "build/release/breccia")
    if device:
        parser.add_argument("--device", default="cpu")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--record", type=pathlib.Path)
