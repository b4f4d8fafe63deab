"""What watching.md shows: the script's panel in a terminal, and, with Chromium at hand, the live page in a browser.

``python docs/screens.py`` takes the picture of the page anew.
"""

from __future__ import annotations

import io
import re
import subprocess
from contextlib import redirect_stdout
from pathlib import Path

from paneldraw import open_panel, simulator

HERE = Path(__file__).parent
PAGE = HERE / "watching.md"
SCREEN = HERE / "screens" / "page.png"
_SIZE = 960, 440


def script() -> str:
    """Return the script of the page."""
    return re.findall(r"^```python\n(.*?)^```$", PAGE.read_text(encoding="utf-8"), re.M | re.S)[0]


def run(url: str) -> str:
    """Run the script with a panel of a URL; return what it prints."""
    with redirect_stdout(io.TextIOWrapper(io.BytesIO(), encoding="utf-8")) as printed:
        exec(script().replace("open_panel()", f"open_panel({url!r})"), {})
    printed.seek(0)
    return printed.read()


def terminal() -> str:
    """Return the picture of the script's panel as text, as a page shows it."""
    lines = "\n".join(line.rstrip() for line in run("sim://ssd1306?size=96x16&view=terminal").splitlines())
    return f"```text\n{lines}\n```"


def browser() -> None:
    """Write what a browser shows of three panels with the script's picture."""
    looks = {"sim://ssd1306": "yellow-blue", "sim://ssd1327": None, "sim://st7567": None}
    panels = [open_panel(url) for url in looks]
    with simulator.serve((), port=0) as server:
        for panel, (url, look) in zip(panels, looks.items(), strict=True):
            exec(script().replace("open_panel()", "given"), {"given": panel})
            server.add(panel.simulated, f"{panel.controller.name} {panel.width}x{panel.height}, {url}", look)
        command = ["chromium", "--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars"]
        command += ["--virtual-time-budget=3000", f"--window-size={_SIZE[0]},{_SIZE[1]}", f"--screenshot={SCREEN}"]
        subprocess.run([*command, server.url], check=True, capture_output=True)


if __name__ == "__main__":
    browser()
