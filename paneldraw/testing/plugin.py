"""The plugin that pytest finds: fixtures with simulated panels, and the options of `assert_frame`.

Every pytest session imports this module, on a machine with paneldraw: it imports nothing but pytest until a fixture is
asked for.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import pytest

from paneldraw.testing import running

if TYPE_CHECKING:
    from paneldraw.simulator import I2CBus, SPIBus
    from paneldraw.testing.panels import SerialPanel, SimPanel
    from paneldraw.testing.programs import SimRun

_FAILED = "_paneldraw_failed"


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add the flag that writes golden pictures, and where they and pictures of failures are."""
    group = parser.getgroup("paneldraw", "simulated panels")
    group.addoption("--update-frames", action="store_true", help="write the golden pictures of assert_frame anew")
    parser.addini("paneldraw_golden", "folder of golden pictures (default: golden/ beside each test file)")
    parser.addini("paneldraw_failures", "folder for pictures of failures (default: beside the report, or temporary)")


@pytest.hookimpl(hookwrapper=True, tryfirst=True)
def pytest_runtest_protocol(item: pytest.Item) -> Iterator[None]:
    """Remember which test runs, for `assert_frame`; a session within a test may run others."""
    running.tests.append(item)
    yield
    running.tests.pop()


def pytest_exception_interact(node: object) -> None:
    """Remember that a test failed: what it left open then is no news."""
    setattr(node, _FAILED, True)


def pytest_assertrepr_compare(op: str, left: object, right: object) -> list[str] | None:
    """Show framebuffers that differ as pictures."""
    if op != "==" or not all(_is_framebuffer(side) for side in (left, right)):
        return None
    from paneldraw.testing.seeing import difference

    return ["the framebuffers differ", *difference(left, right, ("left", "right")).splitlines()]


def _is_framebuffer(thing: object) -> bool:
    return type(thing).__name__ == "Framebuffer" and type(thing).__module__.startswith("paneldraw.")


def pytest_terminal_summary(terminalreporter: Any) -> None:
    """Name the golden pictures that were written."""
    if not terminalreporter.config.getoption("--update-frames"):
        return
    reports = [report for reports in terminalreporter.stats.values() for report in reports]
    properties = [pair for report in reports for pair in getattr(report, "user_properties", ())]
    written = sorted({path for name, path in properties if name == running.WRITTEN})
    terminalreporter.write_line(f"golden pictures written: {len(written)}")
    for path in written:
        terminalreporter.write_line(f"  {path}")


@pytest.fixture
def _paneldraw_leaves_nothing(request: pytest.FixtureRequest) -> Iterator[None]:
    """Demand that a test leaves no thread, device or socket of ours open; the fixtures here are gone by then."""
    from paneldraw.testing.leaks import Held

    before = Held.now()
    yield
    if not hasattr(request.node, _FAILED) and (left := before.left()):
        pytest.fail(f"the test left open: {', '.join(left)}", pytrace=False)


@pytest.fixture
def sim_panel(request: pytest.FixtureRequest, _paneldraw_leaves_nothing: None) -> Iterator[SimPanel]:
    """A panel on a simulated bus, of the URL that the test is parametrized with; default ``sim://ssd1306``."""
    from paneldraw.testing.panels import SimPanel

    with SimPanel(getattr(request, "param", "sim://ssd1306")) as panel:
        yield panel


@pytest.fixture
def serial_panel(request: pytest.FixtureRequest, _paneldraw_leaves_nothing: None) -> Iterator[SerialPanel]:
    """A panel behind a board on a simulated serial port; default ``serial:///dev/ttyACM0?chip=ssd1306``."""
    from paneldraw.testing.panels import SerialPanel

    with SerialPanel(getattr(request, "param", "serial:///dev/ttyACM0?chip=ssd1306")) as panel:
        yield panel


@pytest.fixture
def i2c_bus(request: pytest.FixtureRequest, _paneldraw_leaves_nothing: None) -> Iterator[I2CBus]:
    """A simulated I2C bus with the panels of URLs on it; default ``i2c://1/0x3c?chip=ssd1306``."""
    from paneldraw.testing.panels import bus_of

    with bus_of(getattr(request, "param", "i2c://1/0x3c?chip=ssd1306"), "i2c") as bus:
        yield bus


@pytest.fixture
def spi_bus(request: pytest.FixtureRequest, _paneldraw_leaves_nothing: None) -> Iterator[SPIBus]:
    """A simulated SPI bus with the panel of a URL at its chip select; default ``spi://0.0?chip=ssd1306``."""
    from paneldraw.testing.panels import bus_of

    with bus_of(getattr(request, "param", "spi://0.0?chip=ssd1306"), "spi") as bus:
        yield bus


@pytest.fixture
def sim_run(request: pytest.FixtureRequest, _paneldraw_leaves_nothing: None) -> Iterator[SimRun]:
    """Runs programs with simulated panels in place of the devices; default ``i2c://1/0x3c?chip=ssd1306``."""
    if sys.platform != "linux":
        pytest.skip("sim_run needs Linux, whose loader lends a program the simulated devices")
    from paneldraw.testing.programs import SimRun

    with SimRun(getattr(request, "param", "i2c://1/0x3c?chip=ssd1306")) as run:
        yield run
