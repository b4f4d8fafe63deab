"""CPU time of a script's import of paneldraw after `import numpy`, in a fresh interpreter, and what it brings along."""

from __future__ import annotations

import json
import subprocess
import sys
from statistics import median

WANTED = 0.03
OURS = "from paneldraw import ConeFilter, Framebuffer, Supersample"
LATE = ("PIL", "smbus2", "serial", "cobs", "spidev", "gpiod", "aiohttp")

PROGRAM = """
import json, sys, threading, time
import numpy
start = time.process_time()
{statement}
print(json.dumps([time.process_time() - start, threading.active_count() - 1, sorted(sys.modules)]))
"""


def fresh(statement: str) -> tuple[float, int, list[str]]:
    """CPU seconds that a statement takes after numpy in a new interpreter, threads it started, modules loaded then."""
    program = PROGRAM.format(statement=statement)
    output = subprocess.run([sys.executable, "-c", program], check=True, capture_output=True, text=True).stdout
    seconds, threads, modules = json.loads(output)
    return seconds, threads, modules


def run(rounds: int) -> None:
    """Print the cost of ours and of peers, taken in turn, and ours' threads and early imports."""
    statements = {
        "import paneldraw": OURS,
        "import luma.oled.device": "import luma.oled.device",
        "import adafruit_ssd1306": "import adafruit_ssd1306",
    }
    samples: dict[str, list[float]] = {name: [] for name in statements}
    missing: set[str] = set()
    for _ in range(rounds):
        for name, statement in statements.items():
            try:
                samples[name].append(fresh(statement)[0])
            except subprocess.CalledProcessError as error:
                if name == "import paneldraw":
                    raise
                if name not in missing:
                    print(f"  without {name}: {error.stderr.strip().splitlines()[-1]}")
                missing.add(name)
    ours = median(samples["import paneldraw"])
    verdict = "met" if ours <= WANTED else "NOT met"
    print(
        f"  {'import paneldraw, after numpy':<44}{1e3 * ours:9.1f} ms   (wanted at most {1e3 * WANTED:.0f}: {verdict})"
    )
    for name, seconds in samples.items():
        if name not in missing and seconds is not samples["import paneldraw"]:
            print(f"  {name:<44}{1e3 * median(seconds):9.1f} ms   {median(seconds) / ours:.3g}x")
    _, threads, modules = fresh(OURS)
    early = [name for name in LATE if name in modules]
    print(f"  threads started: {threads}; of {', '.join(LATE)} already imported: {', '.join(early) or 'none'}")
