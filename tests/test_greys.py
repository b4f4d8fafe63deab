"""Which sub-pictures make greys, and what they take on the wire."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from paneldraw import Framebuffer, Panel, Supersample, simulator
from paneldraw.controllers import SSD1306
from paneldraw.demos.scenes import SCENES
from paneldraw.transports import I2CTransport
from paneldraw.transports.base import COMMAND, Cost, Plan
from paneldraw.update.greys import (
    EVEN,
    GREYS,
    LEAST_RATE,
    PACES,
    RESPONSES,
    SHORTEST,
    TORN,
    Choice,
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


WAYS = ({}, {"weighted": True}, {"timed": True})


@given(st.sampled_from(GREYS), st.sampled_from(WAYS), st.integers(0, 2**32 - 1))
def test_the_weights_of_the_sub_pictures_a_pixel_is_lit_in_add_up_to_its_level(
    greys: int, way: dict[str, bool], seed: int
) -> None:
    steps = np.random.default_rng(seed).integers(0, greys, (9, 70), dtype=np.uint8)
    cycle = Cycle(greys, **way)
    pictures = cycle.pictures(steps)
    assert pictures.max() <= 1
    assert np.array_equal(np.tensordot(cycle.weights, pictures, 1), steps)


@pytest.mark.parametrize("greys", GREYS)
def test_what_weighs_more_lasts_longer_or_is_brighter(greys: int) -> None:
    timed, weighted, equal = Cycle(greys, timed=True), Cycle(greys, weighted=True), Cycle(greys)
    assert timed.lasts == timed.weights == weighted.weights
    assert sum(timed.lasts) == sum(equal.lasts) == greys - 1
    assert set(weighted.lasts) == {1}
    with pytest.raises(ValueError, match="weighted and timed must not both be True"):
        Cycle(greys, weighted=True, timed=True)


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


def test_other_numbers_of_greys_are_refused() -> None:
    with pytest.raises(ValueError, match="greys must be one of 3, 4, 5, 8, 16, not 6"):
        Cycle(6)


def test_contrasts_give_light_in_the_ratio_of_the_weights() -> None:
    assert EVEN.contrasts((1, 2, 4), 0xCC) == (51, 102, 204)
    assert "assumed" in RESPONSES["ssd1306"].source
    bent = Response(tuple((c / 255) ** 2 for c in range(256)), "made up")
    light = [bent.light[c] for c in bent.contrasts((1, 2), 200)]
    assert light[1] / light[0] == pytest.approx(2, rel=0.02)


@pytest.mark.parametrize(
    "light",
    [(0.0, 1.0), tuple(range(255, -1, -1)), (0.0,) * 256, (math.nan,) * 256, (*range(255), math.inf)],
)
def test_a_table_that_is_none_is_refused(light: tuple[float, ...]) -> None:
    with pytest.raises(ValueError, match="light must be 256 figures that rise"):
        Response(light, "").contrasts((1, 2), 255)


def chosen(levels: np.ndarray, max_level: int = 3, greys: int = 4, clock: float = CLOCK, **how: Any) -> Choice | None:
    how = {"paces": PACES["ssd1306"]} | how
    return choose(Forecaster(SSD1306(), COST), levels, max_level, greys, clock, **how)


@pytest.mark.parametrize("updates", ["least", "plain", "whole"])
@pytest.mark.parametrize("way", WAYS)
def test_the_forecast_is_what_a_panel_sends_with_every_sub_picture(way: dict[str, bool], updates: str) -> None:
    cycle = Cycle(4, **way)
    forecaster = Forecaster(SSD1306(), COST, updates)
    packed = forecaster.packed(cycle.pictures(cycle.steps(disc().pixels, 3)))
    moving = np.logical_or.reduce([one != packed[0] for one in packed])
    forecast = forecaster.forecast(cycle, moving)
    bus = simulator.I2CBus({0x3C: simulator.SSD1306()}, timer=None)
    with Panel(SSD1306(), I2CTransport(bus), updates=updates) as panel:  # type: ignore[arg-type]
        driver = panel._driver
        driver.moving = moving
        for turn in range(3 * len(packed)):
            messages, began = bus.messages, bus.seconds
            if cycle.weighted:
                panel.contrast(100)
            driver.take(packed[turn % len(packed)])
            wire = driver.show(False, 0.0)[0] + 4 * cycle.weighted
            if turn >= len(packed):
                assert forecast == Forecast(wire, bus.messages - messages)
                assert forecast.seconds(CLOCK) == pytest.approx(bus.seconds - began, abs=4 / CLOCK)


@pytest.mark.parametrize("scene", ["clock", "wire cube", "ball"])
def test_each_byte_comes_at_the_same_time_of_every_slot(scene: str, monkeypatch: pytest.MonkeyPatch) -> None:
    fb = Framebuffer(128, 64, 2, antialias=Supersample(4))
    SCENES[scene](fb, 30)
    choice = chosen(fb.pixels)
    assert choice is not None
    layouts = []

    def batch(transport: I2CTransport, plan: Plan) -> int:
        layouts.append([(kind, bytes(payload) if kind == COMMAND else len(payload)) for kind, payload in plan])
        return send(transport, plan)

    send = I2CTransport.batch
    monkeypatch.setattr(I2CTransport, "batch", batch)
    chip = simulator.SSD1306()
    pictures = choice.cycle.pictures(choice.cycle.steps(fb.pixels, 3))
    with Panel(SSD1306(), I2CTransport(simulator.I2CBus({0x3C: chip}, timer=None))) as panel:
        driver = panel._driver
        driver.moving = choice.moving
        for turn in range(7):
            driver.take(choice.packed[turn % len(pictures)])
            driver.show(False, 0.0)
            assert np.array_equal(chip.pixels, pictures[turn % len(pictures)])
    assert len(layouts) == 7
    assert all(layout == layouts[1] for layout in layouts[1:])


def test_a_picture_without_grey_takes_nothing() -> None:
    choice = chosen(3 * (disc().pixels > 1).astype(np.uint8))
    assert choice is not None
    assert (choice.forecast, choice.seconds, choice.rate) == ((0, 0), (), float("inf"))


def test_a_sub_picture_gets_the_time_of_a_scan() -> None:
    choice = chosen(disc().pixels)
    assert choice is not None
    assert choice.pace is not None
    assert choice.pace.commands == (bytes.fromhex("D9 11"), bytes.fromhex("D5 F0"))
    assert choice.seconds == pytest.approx((52 * 64 / 510_000,) * 3)
    assert choice.rate == pytest.approx(51.08, abs=0.01)
    slower = chosen(disc().pixels, clock=200_000)
    assert slower is not None
    assert slower.pace in PACES["ssd1306"]
    assert slower.rate == pytest.approx(1 / (3 * 64 * slower.pace.line_seconds))


def test_paces_are_those_of_a_chip_that_takes_them() -> None:
    chip = simulator.SSD1306()
    assert list(PACES["ssd1306"]) == sorted(PACES["ssd1306"])
    for pace in PACES["ssd1306"]:
        chip.write(b"\x00" + b"".join(pace.commands))
        assert chip.frame_seconds == pytest.approx(64 * pace.line_seconds)
    assert chip.violations == []


def test_where_the_wire_is_slow_the_heavy_sub_picture_lasts_longer() -> None:
    fb = Framebuffer(128, 64, 2)
    SCENES["clock"](fb, 30)
    choice = chosen(fb.pixels)
    assert choice is not None
    assert (choice.cycle.greys, choice.cycle.timed) == (4, True)
    assert choice.rate >= 49
    taken = choice.forecast.seconds(CLOCK)
    assert 2 * taken <= 0.8 * sum(choice.seconds)
    assert min(choice.seconds) >= taken
    assert choice.pace is not None
    assert sum(choice.seconds) == pytest.approx(3 * 64 * choice.pace.line_seconds)
    assert max(choice.seconds) / 2 >= 64 * choice.pace.line_seconds * (1 - TORN)


def test_weighted_sub_pictures_come_more_often() -> None:
    equal, weighted = chosen(disc().pixels), chosen(disc().pixels, weighted=True)
    assert equal is not None
    assert weighted is not None
    assert weighted.rate > 1.4 * equal.rate


def test_a_chip_of_which_no_pace_is_known_is_not_flooded() -> None:
    choice = chosen(disc().pixels, clock=100_000_000, paces=())
    assert choice is not None
    assert choice.pace is None
    assert choice.seconds == (SHORTEST,) * 3


def test_as_many_greys_as_the_wire_carries() -> None:
    noise = np.random.default_rng(1).integers(0, 4, (64, 128), dtype=np.uint8)
    assert chosen(noise) is None
    few = np.where(np.arange(128) < 64, 3, noise).astype(np.uint8)
    choice = chosen(few, greys=16, clock=1_000_000, paces=())
    assert choice is not None
    assert 3 <= choice.cycle.greys < 16
    assert choice.rate >= LEAST_RATE
    choice = chosen(disc().pixels, greys=16, weighted=True)
    assert choice is not None
    assert choice.cycle.greys == 8
