"""Time paneldraw beside its peers, in one run on one machine: ``python tests/benchmarks/run.py [NAME ...]``.

Prints our time a call and, for each peer, how many times as long it takes. Without a name, every group runs.
``drawing`` stands for the groups of drawing calls.
"""

from __future__ import annotations

import argparse
import importlib
import os
import platform
from pathlib import Path

import measure

HERE = Path(__file__).parent
GROUPS = sorted(path.stem for path in HERE.glob("*.py") if path.stem not in ("run", "measure", "peers", "canvases"))
SETS = {"drawing": ("lines", "shapes", "pixels", "text")}

#: One thread each, and nobody opens a window or talks. To be set before numpy and the peers are imported.
QUIET = {
    "OMP_NUM_THREADS": "1",
    "OPENBLAS_NUM_THREADS": "1",
    "MKL_NUM_THREADS": "1",
    "NUMBA_NUM_THREADS": "1",
    "SDL_VIDEODRIVER": "dummy",
    "SDL_AUDIODRIVER": "dummy",
    "PYGAME_HIDE_SUPPORT_PROMPT": "1",
}


def main() -> None:
    """Run the groups that the command line names."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("name", nargs="*", help=f"groups: {', '.join([*SETS, *GROUPS])}")
    parser.add_argument("--rounds", type=int, default=15, help="samples a statement, of which the median counts")
    parser.add_argument("--once", action="store_true", help="run each statement once a sample: whether it runs at all")
    arguments = parser.parse_args()
    for name in arguments.name:
        if name not in GROUPS and name not in SETS:
            parser.error(f"no group is called {name!r}; there are {', '.join([*SETS, *GROUPS])}")
    if arguments.rounds < 1:
        parser.error("--rounds must be 1 or more")
    if arguments.once:
        measure.SAMPLE = 0.0
    os.environ.update(QUIET)
    from paneldraw import _compiled

    speed = "compiled" if _compiled.COMPILED else "interpreted"
    print(f"paneldraw {speed}, Python {platform.python_version()}, {platform.machine()}, {arguments.rounds} rounds")
    names = [group for name in arguments.name or GROUPS for group in SETS.get(name, (name,))]
    for name in dict.fromkeys(names):
        module = importlib.import_module(name)
        print(f"\n{name}: {(module.__doc__ or '').strip()}")
        module.run(arguments.rounds)
    verdicts = measure.VERDICTS
    if verdicts.met or verdicts.missed:
        print(f"\n{verdicts.met} of {verdicts.met + len(verdicts.missed)} wanted ratios are met; not:")
        print("\n".join(f"  {missed}" for missed in verdicts.missed) or "  none")


if __name__ == "__main__":
    main()
