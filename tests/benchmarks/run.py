"""Time paneldraw beside its peers, in one run on one machine: ``python tests/benchmarks/run.py [NAME ...]``.

Prints our time a call and, for each peer, how many times as long it takes. Without a name, every group runs.
"""

from __future__ import annotations

import argparse
import importlib
import platform
from pathlib import Path

import measure

HERE = Path(__file__).parent
GROUPS = sorted(path.stem for path in HERE.glob("*.py") if path.stem not in ("run", "measure", "peers"))


def main() -> None:
    """Run the groups that the command line names."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("name", nargs="*", help=f"groups: {', '.join(GROUPS)}")
    parser.add_argument("--rounds", type=int, default=15, help="samples a statement, of which the median counts")
    parser.add_argument("--once", action="store_true", help="run each statement once a sample: whether it runs at all")
    arguments = parser.parse_args()
    for name in arguments.name:
        if name not in GROUPS:
            parser.error(f"no group is called {name!r}; there are {', '.join(GROUPS)}")
    if arguments.rounds < 1:
        parser.error("--rounds must be 1 or more")
    if arguments.once:
        measure.SAMPLE = 0.0
    from paneldraw import _compiled

    speed = "compiled" if _compiled.COMPILED else "interpreted"
    print(f"paneldraw {speed}, Python {platform.python_version()}, {platform.machine()}, {arguments.rounds} rounds")
    for name in arguments.name or GROUPS:
        module = importlib.import_module(name)
        print(f"\n{name}: {(module.__doc__ or '').strip()}")
        module.run(arguments.rounds)


if __name__ == "__main__":
    main()
