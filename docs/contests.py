"""The tables of benchmarks.md, made of what a run of the benchmarks prints.

``python tests/benchmarks/run.py drawing show scenes imports | python docs/contests.py``
"""

from __future__ import annotations

import re
import sys
from collections.abc import Iterable
from pathlib import Path

from worked_examples import table

PAGE = Path(__file__).with_name("benchmarks.md")
_CONTEST = re.compile(r"^  (?P<name>\S.*?)  +(?P<ours>[\d.]+ [um]s)(?P<peers>.*)$")
_PEER = re.compile(r"(?P<peer>[A-Za-z].*?) (?P<ratio>[\d.e+]+)x(?: \(wanted.*?\))?(?:   |$)")
_SCENE = re.compile(r"^  (?P<name>\S.*?)((?:  +[\d.]+){7})$")


def tables(printed: str) -> str:
    """Return a section with a table for each group of a run, and what is known of the machine."""
    head, *groups = re.split(r"\n(?=\w+: )", printed.strip())
    parts = [f"\n{head.strip()}.\n"]
    for group in groups:
        title, *lines = group.splitlines()
        name, _, about = title.partition(": ")
        if any(map(_SCENE.match, lines)):
            heads = "scene|ours|luma.oled|Adafruit|displayio|full frame|box|page runs"
            rows: Iterable[Iterable[object]] = (
                (found["name"], *found[2].split()) for found in map(_SCENE.match, lines) if found
            )
        else:
            heads = "|ours|times ours"
            rows = [_row(found) for found in map(_CONTEST.match, lines) if found]
        parts.append(f"## {name.capitalize()}\n\n{about}\n{table(heads, rows)}")
    return "\n".join(parts)


def _row(found: re.Match[str]) -> tuple[str, str, str]:
    ratios = [
        f"{peer['peer'].strip()} {_short(float(peer['ratio']))}" for peer in _PEER.finditer(found["peers"].strip())
    ]
    return found["name"], found["ours"].replace(" us", "\N{NO-BREAK SPACE}µs"), ", ".join(ratios)


def _short(ratio: float) -> str:
    """A ratio in two figures."""
    return f"{float(f'{ratio:.2g}'):,g}"


def main() -> None:
    """Put what standard input has between the marks of the page."""
    page = PAGE.read_text(encoding="utf-8")
    made = tables(sys.stdin.read())
    marks = r"(?<=^<!-- run -->\n)(?s:.*?)(?=^<!-- end -->$)"
    PAGE.write_text(re.sub(marks, lambda _: made, page, count=1, flags=re.M), encoding="utf-8")


if __name__ == "__main__":
    main()
