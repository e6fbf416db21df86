"""Try faults of every group, and say how many of each ended how; not zero where one went wrong.

make faults                          all, an hour
make faults ARGS=--quick             a few of each, as `make test` has them
make faults ARGS="--kills 0"         without runs of the workflow, 25 minutes
make faults ARGS="--only streams disk"     some of the runs: see `RUNS`
"""

import argparse
import sys
import tempfile
from functools import partial
from pathlib import Path

import numpy as np

from faults import (
    commands,
    file_cases,
    foreign_results,
    judging,
    lying_drives,
    message_fuzz,
    odd_surroundings,
    recording_cases,
    settings_cases,
    table_flips,
    whole_plans,
    word_cases,
    word_runs,
    wrong_units,
)

SEED = 17


def try_in_process(folder, tally, *, n_damaged, n_salvaged, n_messages, n_flips, n_files, n_drawn):
    """Try all that needs no run of the workflow."""
    cases = [
        *recording_cases.list_damage_cases(folder, n_damaged),
        *recording_cases.list_salvage_cases(folder, n_salvaged),
        *recording_cases.list_survey_cases(folder),
        *recording_cases.list_bomb_cases(folder),
        *recording_cases.list_scan_folder_cases(folder, n_files),
        *file_cases.list_file_cases(folder, n_files),
        *file_cases.list_hostile_cases(folder),
        *settings_cases.list_settings_cases(folder),
        *word_cases.list_word_cases(folder, n_drawn),
        *foreign_results.list_foreign_cases(folder),
    ]
    for case in cases:
        judging.judge(case, tally)
    message_fuzz.try_messages(tally, n_messages)
    rng = np.random.default_rng(SEED)
    for path, schema in table_flips.write_tables(folder, rng):
        table_flips.flip_bits(path, schema, n_flips, rng, tally)


MANY = {
    "n_damaged": 20,
    "n_salvaged": 40,
    "n_messages": 300,
    "n_flips": 2000,
    "n_files": 15,
    "n_drawn": 100,
}
FEW = {"n_damaged": 2, "n_salvaged": 3, "n_messages": 40, "n_flips": 10, "n_files": 2, "n_drawn": 1}


RUNS = {
    "words": lambda folder, tally, _: word_runs.try_words(folder, tally),
    "commands": commands.try_commands,
    "plans": lambda folder, tally, _: whole_plans.try_whole_plans(folder, tally),
    **{
        name: partial(odd_surroundings.try_kind, kind)
        for name, kind in odd_surroundings.KINDS.items()
    },
}
"""Runs of the workflow, each with a folder, a tally and a number of kills."""


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--quick", action="store_true", help="a few of each, no runs")
    parser.add_argument("--kills", type=int, default=60, help="0: no runs of the workflow")
    parser.add_argument("--only-runs", action="store_true", help="nothing but such runs")
    parser.add_argument("--only", nargs="+", choices=RUNS, help="nothing but these runs")
    asked = parser.parse_args()
    tally = judging.Tally()
    with tempfile.TemporaryDirectory() as folder:
        if not (asked.only_runs or asked.only):
            try_in_process(folder, tally, **(FEW if asked.quick else MANY))
            if not asked.quick:
                wrong_units.try_mistakes(Path(folder), tally)
                lying_drives.try_lies(Path(folder), tally)
            print(tally.table(), flush=True)
        if asked.kills and not asked.quick:
            for name in asked.only or RUNS:
                RUNS[name](Path(folder), tally, asked.kills)
            print(tally.table())
    return 1 if tally.wrong else 0


if __name__ == "__main__":
    sys.exit(main())
