"""`paneldraw check` shows on the glass what its steps say, and tells a chip that disobeys; `panels` lists the chips."""

from __future__ import annotations

import time

import numpy as np
import pytest

from paneldraw import Panel, open_panel, simulator
from paneldraw.cli import check, main
from paneldraw.controllers import CHIPS, SH1106, SSD1306
from paneldraw.transports import I2CTransport


def seen_steps(controller, chip, answers=lambda question: "y"):
    """Run the card; return the findings, and the picture of the glass at every step."""
    panel = Panel(controller, I2CTransport(simulator.I2CBus({0x3C: chip})), updates="whole")
    glass = []
    found = check.run(panel, lambda panel, shows: glass.append((shows, chip.pixels.copy())), answers)
    return found, glass


@pytest.mark.parametrize(("make", "twin"), [(SSD1306, simulator.SSD1306), (SH1106, simulator.SH1106)])
@pytest.mark.parametrize("offset", [0, 2])
def test_a_chip_that_obeys_shows_what_every_step_says(make, twin, offset):
    if make is SSD1306 and offset:
        wiring = {"column_offset": 14, "com_pins": 0x12}
        controller, chip = SSD1306(100, 64, **wiring), twin(100, 64, **wiring)
    else:
        controller, chip = make(column_offset=offset), twin(column_offset=offset)
    found, glass = seen_steps(controller, chip)
    bar = np.zeros_like(chip.pixels)
    bar[:8, :32] = 1
    tricks = [picture for shows, picture in glass if "solid bar" in shows]
    assert len(tricks) == (4 if make is SSD1306 else 3)
    for picture in tricks:
        np.testing.assert_array_equal(picture, bar)
    assert glass[0][1][0].all()
    assert glass[0][1][:, -1].all()
    assert found.parameters == ["chained_control=1", "contrast=255"]


@pytest.mark.parametrize("name", ["ssd1327", "ssd1322", "ssd1362"])
def test_windows_of_grays_are_tried_too(name):
    panel = open_panel(f"sim://{name}?updates=whole")
    glass = []
    found = check.run(panel, lambda panel, shows: glass.append((shows, panel.simulated.pixels.copy())), lambda _: "y")
    bar = np.zeros((panel.height, panel.width), np.uint8)
    bar[:8, :32] = 15
    tricks = [picture for shows, picture in glass if "solid bar" in shows]
    assert len(tricks) == 1
    np.testing.assert_array_equal(tricks[0], bar)
    assert found.parameters == ["contrast=255"]
    assert panel.simulated.violations == []


class Forgetful(simulator.SSD1306):
    """A clone whose pointer is somewhere else behind every write."""

    def write(self, payload):
        super().write(payload)
        if payload[0] == 0x40:
            self.registers.column = 100


def test_a_clone_that_disobeys_is_told_to_be_sent_to_plainly():
    wrong = []

    def answer(question):
        return "n" if "pointer stands" in question else "y"

    found, glass = seen_steps(SSD1306(), Forgetful(), answer)
    bar = np.zeros((64, 128), np.uint8)
    bar[:8, :32] = 1
    wrong = [not np.array_equal(picture, bar) for shows, picture in glass if "solid bar" in shows]
    assert wrong[0]
    assert found.parameters == ["updates=plain", "contrast=255"]


@pytest.mark.parametrize("key", check.SYMPTOMS)
def test_what_is_wrong_with_the_card_says_what_to_try(key):
    found, glass = seen_steps(SSD1306(), simulator.SSD1306(), lambda question: key)
    assert found.advice == [check.SYMPTOMS[key][1]]
    assert len(glass) == 1


def test_the_command_asks_and_names_the_url_to_use(monkeypatch, capsys):
    answers = iter("yyyny" + "y")
    monkeypatch.setattr(check, "ask", lambda question: next(answers))
    assert main(["check", "--panel", "sim://ssd1306?size=128x32"]) == 0
    assert capsys.readouterr().out.splitlines()[-1] == ("use: sim://ssd1306?size=128x32&updates=plain&contrast=255")


def test_the_chips_are_listed_and_each_is_described(capsys):
    assert main(["panels"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in lines] == ["chip", *CHIPS]
    for name, chip in CHIPS.items():
        assert main(["panels", name]) == 0
        told = capsys.readouterr().out
        assert chip.name in told
        assert ("by itself: scrolls" in told) == (chip().scroll is not None)
        for parameter in chip.parameters:
            line = next(line for line in told.splitlines() if line.startswith(f"  {parameter} "))
            assert line.split(maxsplit=1)[1], f"{parameter} needs a description"
    assert main(["panels", "ssd130"]) == 1
    assert "did you mean ssd130" in capsys.readouterr().err


@pytest.mark.parametrize(("command", "on"), [("clear", True), ("off", False)])
def test_the_last_acts_of_a_service(command, on, monkeypatch):
    from paneldraw.cli import _opened

    panels = []

    def opened(options):
        panels.append(_opened(options))
        panels[0].show(np.ones((64, 128), np.uint8))
        return panels[0]

    monkeypatch.setattr("paneldraw.cli._opened", opened)
    assert main([command, "--panel", "sim://ssd1306"]) == 0
    chip = panels[0].simulated
    assert chip.registers.on == on
    assert not chip.pixels.any()


def test_text_inverted(capsys):
    assert main(["text", "hi", "--invert"]) == 0
    assert "█" * 40 in capsys.readouterr().out


@pytest.mark.parametrize(("answers", "greys"), [("y", "greys=4"), ("fy", "greys=3"), ("ff", ""), ("bn", "")])
def test_greys_are_tried_until_they_are_steady(answers, greys):
    asked, opened = iter(answers), []

    def open_greys(count):
        opened.append(open_panel(f"sim://ssd1306?greys={count}"))
        return opened[-1]

    levels = []

    def show(panel, shows):
        time.sleep(0.1)
        levels.append(panel.depth)

    found = check.run_greys(open_greys, show, lambda _: next(asked))
    assert found.parameters == ([greys] if greys else [])
    assert found.advice == (["a faster bus, and bus_clock= with its rate"] if "f" in answers else [])
    assert levels == [2] * len(answers)
    assert not any(panel.stats.fewer_greys for panel in opened)
    assert opened[0].stats.sub_pictures >= 3  # a cycle at least


def test_greys_are_checked_from_the_shell(monkeypatch, capsys):
    monkeypatch.setattr(check, "ask", lambda question: "y")
    assert main(["check", "--greys", "--panel", "sim://ssd1306"]) == 0
    assert capsys.readouterr().out.endswith("use: sim://ssd1306?greys=4\n")
