"""Time that the live page takes to draw a frame of 128 x 128 greys in a headless Chromium."""

from __future__ import annotations

import sys
from pathlib import Path
from statistics import median
from typing import Any

import measure
import numpy as np

from paneldraw import open_panel, simulator

sys.path.insert(0, str(Path(__file__).parent.parent))

WANTED = 4.0
"""Milliseconds."""
DRAWS = 50
_BATCH = f"""
(() => {{
  const panel = panels.get(0), start = performance.now();
  for (let times = 0; times < {DRAWS}; times++) {{
    panel.draw(panel.newest);
    panel.pen.getImageData(0, 0, 1, 1);  // so that nothing is put off
  }}
  return (performance.now() - start) / {DRAWS};
}})()
"""
_TURN = """
(async () => {
  const panel = panels.get(0), start = performance.now();
  for (let times = 0; times < 30; times++) {
    panel.draw(panel.newest);
    await new Promise(requestAnimationFrame);
  }
  return (performance.now() - start) / 30;
})()
"""


def run(rounds: int) -> None:
    """Print what a draw takes alone, and how long it is from one to the next where each is shown."""
    from simulator import browsers

    if browsers.CHROMIUM is None:
        print(f"  not timed, as there is no Chromium; at most {WANTED:.0f} ms a draw are wanted")
        return
    panel = open_panel("sim://ssd1327")
    panel.show(np.random.default_rng(1).integers(0, 16, (128, 128), np.uint8))

    async def measured(browser: browsers.Browser, url: str) -> tuple[list[Any], float]:
        async with browser.page(url) as page:
            await page.size(1280, 800)
            await page.until("panels.size && panels.get(0).newest")
            return [await page.value(_BATCH) for _ in range(rounds)], await page.value(_TURN)

    with browsers.Browser() as browser, simulator.serve(panel.simulated, port=0) as server:
        taken, turn = browsers.run(measured(browser, server.url))
    verdict = measure.VERDICTS.judge("draw", f"at most {WANTED:.0f} ms", WANTED / median(taken), 1.0)
    print(f"  {'a draw':<44}{median(taken):9.3f} ms   at most {WANTED:.0f}: {verdict}", flush=True)
    print(f"  {'from draw to draw, at 60 pictures a second':<44}{turn:9.3f} ms", flush=True)
