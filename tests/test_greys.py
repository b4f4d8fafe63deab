"""Which sub-pictures make greys, and what they take on the wire."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from paneldraw import Framebuffer, Panel, Supersample, simulator
from paneldraw.controllers import SSD1306
from paneldraw.transports import I2CTransport
from paneldraw.transports.base import Cost
from paneldraw.update.greys import (
    EVEN,
    GREYS,
    LEAST_RATE,
    PACES,
    RESPONSES,
    Cycle,
    Forecast,
    Forecaster,
    Response,
    choose,
    phases,
)

COST = Cost(2, 2, 2, 8191)
CLOCK = 400_000


def disc() -> Framebuffer:
    fb = Framebuffer(128, 64, 2)
    fb.circle(64, 32, 28, fill=True, antialias=Supersample(4))
    return fb


@given(st.sampled_from(GREYS), st.booleans(), st.integers(0, 2**32 - 1))
def test_the_weights_of_the_sub_pictures_a_pixel_is_lit_in_add_up_to_its_level(
    greys: int, weighted: bool, seed: int
) -> None:
    steps = np.random.default_rng(seed).integers(0, greys, (9, 70), dtype=np.uint8)
    cycle = Cycle(greys, weighted=weighted)
    pictures = cycle.pictures(steps)
    assert pictures.max() <= 1
    assert np.array_equal(np.tensordot(cycle.weights, pictures, 1), steps)


@pytest.mark.parametrize("greys", GREYS)
def test_a_pixel_changes_twice_a_cycle_at_most(greys: int) -> None:
    steps = np.random.default_rng(1).integers(0, greys, (64, 128), dtype=np.uint8)
    pictures = Cycle(greys).pictures(steps)
    changes = (pictures != np.roll(pictures, 1, axis=0)).sum(axis=0)
    assert np.array_equal(changes, np.where((steps == 0) | (steps == greys - 1), 0, 2))


@pytest.mark.parametrize("greys", GREYS)
def test_as_many_pixels_of_a_level_are_lit_in_each_sub_picture_in_any_corner(greys: int) -> None:
    for level in range(1, greys - 1):
        pictures = Cycle(greys).pictures(np.full((64, 64), level, np.uint8))
        corners = pictures.reshape(greys - 1, 4, 16, 4, 16).mean(axis=(2, 4))
        assert np.abs(corners - level / (greys - 1)).max() < 0.05


def test_neighbors_seldom_begin_together() -> None:
    found = phases(64, 64, 3)
    alike = np.mean([(found == np.roll(found, 1, axis)).mean() for axis in (0, 1)])
    assert alike < 0.2  # by chance it would be a third
    assert phases(70, 130, 3).shape == (70, 130)


@pytest.mark.parametrize(
    ("greys", "max_level", "gamma", "steps"),
    [(4, 3, 1.0, [0, 1, 2, 3]), (3, 3, 1.0, [0, 1, 1, 2]), (4, 3, 2.2, [0, 0, 1, 3]), (8, 3, 1.0, [0, 2, 5, 7])],
)
def test_levels_go_to_the_nearest_light(greys: int, max_level: int, gamma: float, steps: list[int]) -> None:
    levels = np.arange(max_level + 1, dtype=np.uint8)
    assert Cycle(greys).steps(levels, max_level, gamma).tolist() == steps


def test_the_order_of_weighted_sub_pictures_is_the_one_of_fewest_changes() -> None:
    packed = [np.frombuffer(bytes(text, "ascii"), np.uint8) for text in ("aaaa", "bbbb", "aaab", "bbba")]
    assert Cycle(16, weighted=True).order(packed) in ((0, 2, 1, 3), (0, 3, 1, 2), (0, 2, 3, 1), (0, 1, 3, 2))
    assert Cycle(5).order(packed) == (0, 1, 2, 3)


def test_other_numbers_of_greys_are_refused() -> None:
    with pytest.raises(ValueError, match="greys must be one of 3, 4, 5, 8, 16, not 6"):
        Cycle(6)


def test_contrasts_give_light_in_the_ratio_of_the_weights() -> None:
    assert EVEN.contrasts((1, 2, 4), 0xCC) == (51, 102, 204)
    assert "assumed" in RESPONSES["ssd1306"].source
    bent = Response(tuple((c / 255) ** 2 for c in range(256)), "made up")
    light = [bent.light[c] for c in bent.contrasts((1, 2), 200)]
    assert light[1] / light[0] == pytest.approx(2, rel=0.02)


@pytest.mark.parametrize("light", [(0.0, 1.0), tuple(range(255, -1, -1)), (0.0,) * 256])
def test_a_table_that_is_none_is_refused(light: tuple[float, ...]) -> None:
    with pytest.raises(ValueError, match="light must be 256 figures that rise"):
        Response(light, "").contrasts((1, 2), 255)


@pytest.mark.parametrize("weighted", [False, True])
def test_the_forecast_is_what_a_panel_sends(weighted: bool) -> None:
    fb, cycle = disc(), Cycle(4, weighted=weighted)
    bus = simulator.I2CBus({0x3C: simulator.SSD1306()}, timer=None)
    pictures = cycle.pictures(cycle.steps(fb.pixels, 3))
    sent, messages, busy = [], [], []
    with Panel(SSD1306(), I2CTransport(bus)) as panel:
        for turn in (*range(len(pictures)), *range(len(pictures))):
            before, began = bus.messages, bus.seconds
            if weighted:
                panel.contrast(100)
            report = panel.show(pictures[turn])
            sent.append(report.wire_bytes + 4 * weighted)
            messages.append(bus.messages - before)
            busy.append(bus.seconds - began)
    forecaster = Forecaster(SSD1306(), COST)
    forecast = forecaster.forecast(cycle, forecaster.packed(pictures), range(len(pictures)))
    turns = len(pictures)
    assert forecast == Forecast(tuple(sent[turns:]), tuple(messages[turns:]))
    assert forecast.slot(CLOCK) == pytest.approx(max(busy[turns:]), abs=4 / CLOCK)


def test_a_picture_without_grey_takes_nothing() -> None:
    forecaster = Forecaster(SSD1306(), COST)
    levels = 3 * (disc().pixels > 1).astype(np.uint8)
    choice = choose(forecaster, levels, 3, 4, CLOCK)
    assert choice is not None
    assert (sum(choice.forecast.wire_bytes), choice.forecast.rate(CLOCK)) == (0, float("inf"))


def test_a_sub_picture_gets_the_time_of_a_scan() -> None:
    paces = [(command, 64 * line) for command, line in PACES["ssd1306"]]
    choice = choose(Forecaster(SSD1306(), COST), disc().pixels, 3, 4, CLOCK, paces=paces)
    assert choice is not None
    assert choice.pace == bytes.fromhex("D5 F0")
    assert choice.slot == pytest.approx(54 * 64 / 510_000)
    assert choice.rate == pytest.approx(49.19, abs=0.01)
    slower = choose(Forecaster(SSD1306(), COST), disc().pixels, 3, 4, 330_000, paces=paces)
    assert slower is not None
    assert slower.slot in [slot for _, slot in paces]
    assert slower.forecast.slot(330_000, 0.8) <= slower.slot


def test_as_many_greys_as_the_wire_carries() -> None:
    forecaster = Forecaster(SSD1306(), COST)
    noise = np.random.default_rng(1).integers(0, 4, (64, 128), dtype=np.uint8)
    assert choose(forecaster, noise, 3, 4, CLOCK) is None
    few = np.where(np.arange(128) < 64, 3, noise).astype(np.uint8)
    choice = choose(forecaster, few, 3, 16, 1_000_000)
    assert choice is not None
    assert 3 <= choice.cycle.greys < 16
    assert choice.forecast.rate(1_000_000, 0.8) >= LEAST_RATE
    choice = choose(forecaster, disc().pixels, 3, 16, CLOCK, weighted=True)
    assert choice is not None
    assert choice.cycle.greys > 4
