"""The serial link: the real host side against the real firmware on an emulated ATmega328P, in simulated time.

Simulated figures are the same on every machine. Needs what `tests/firmware_protocol` needs: avr-gcc and libsimavr.
"""

from __future__ import annotations

import os
import random
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "firmware_protocol"))

PIXEL = [(False, bytes.fromhex("b00810")), (True, b"\xff")]
EACH = 0.001
#: Screens a kind of fault, as many as a claim needs.
SCREENS = 200


def run(rounds: int) -> None:
    """Print the figures; ``rounds`` counts for the one that a clock measures."""
    host_cpu(rounds)
    import pytest
    from emulated import Board, built

    with tempfile.TemporaryDirectory() as folder:
        try:
            binaries = built(Path(folder))
        except pytest.skip.Exception as missing:
            print(f"  without the emulated chip: {missing}")
            return

        def board() -> Board:
            fresh = Board(*binaries)
            fresh.run(320_000)
            return fresh

        for baudrate, wanted in ((115_200, 10.5), (500_000, 33.0), (1_000_000, None)):
            throughput(board(), baudrate, wanted)
        for name, noise in (
            ("flipped", (EACH, 0.0, 0.0)),
            ("dropped", (0.0, EACH, 0.0)),
            ("inserted", (0.0, 0.0, EACH)),
            ("together", (EACH, EACH, EACH)),
        ):
            noisy(board(), board(), name, noise)


def throughput(board, baudrate: int, wanted: float | None) -> None:  # type: ignore[no-untyped-def]
    """Print random whole pictures a second, and what one pixel takes."""
    from emulated import BoardPort
    from simulated import whole

    from firmware_protocol import HostLink

    port = BoardPort(board)
    rng = random.Random(1)
    with HostLink(port, baudrate=baudrate, clock=port.clock) as link:
        link.write(whole(bytes(1024)))
        start = port.clock()
        for _ in range(30):
            link.write([(True, rng.randbytes(1024))])
        rate = 30 / (port.clock() - start)
        start = port.clock()
        bytes_sent = link.write(PIXEL)
        trip = 1000 * (port.clock() - start)
    board.close()
    aim = f" (wanted {wanted})" if wanted else ""
    print(f"  {baudrate:>9} baud: {rate:5.2f} random pictures/s{aim}; one pixel {bytes_sent} bytes, {trip:.2f} ms")


def noisy(clean, board, name: str, noise: tuple[float, float, float]) -> None:  # type: ignore[no-untyped-def]
    """Print how many screens come right over a noisy line, and what they cost on the wire, both ways."""
    from emulated import BoardPort
    from simulated import Noise, whole

    from firmware_protocol import HostLink

    def cost(port: BoardPort, count: int) -> tuple[int, float]:
        rng = random.Random(2)
        right = 0
        link = HostLink(port, baudrate=500_000, clock=port.clock)
        before = port.carried
        for _ in range(count):
            picture = rng.randbytes(1024)
            link.write(whole(picture))
            port.read()
            right += port.panel.ram == picture
        return right, (port.carried - before) / count

    _, once = cost(BoardPort(clean), 10)
    right, each = cost(BoardPort(board, noise=Noise(*noise), seed=5), SCREENS)
    clean.close()
    board.close()
    print(f"  1 in 1000 bytes {name:8}: {right} of {SCREENS} screens right, wire cost {each / once:.2f} (wanted 2.2)")


def host_cpu(rounds: int) -> None:
    """Print the host's CPU time for one pixel over a pseudo-terminal, the device in a process of its own."""
    if not hasattr(os, "fork"):
        print("  host CPU for one pixel: no pseudo-terminals here")
        return
    import pty
    import tty

    import serial

    from firmware_protocol import Device, HostLink

    far, near = pty.openpty()
    tty.setraw(near)
    child = os.fork()
    if child == 0:
        device = Device(lambda content: None)
        try:
            while True:
                os.write(far, device.receive(os.read(far, 4096)))
        finally:
            os._exit(0)
    os.close(far)
    link = HostLink(serial.Serial(os.ttyname(near), 115200))
    samples = []
    for _ in range(rounds):
        start = time.process_time()
        for _ in range(200):
            link.write(PIXEL)
        samples.append((time.process_time() - start) / 200)
    os.kill(child, 9)
    os.waitpid(child, 0)
    link.close()
    os.close(near)
    print(f"  host CPU for one pixel: {1e6 * sorted(samples)[len(samples) // 2]:.0f} us (wanted 150)")
