"""`paneldraw bench`: the table adds up, and the chart shows it."""

from __future__ import annotations

import importlib
import itertools
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from running import assert_one_line_of_advice

from paneldraw import Panel, simulator
from paneldraw.cli import bench
from paneldraw.controllers import SSD1306
from paneldraw.demos.scenes import SCENES
from paneldraw.transports import I2CTransport


@pytest.fixture(scope="module")
def lines():
    return bench.measured(3)


def test_every_scene_costs_less_than_a_whole_frame(lines):
    assert [line.name for line in lines] == [*SCENES, "mean"]
    assert all(0 <= line.wire_bytes < bench.FULL_FRAME for line in lines)
    assert sum(line.wire_bytes > 0 for line in lines) >= 9
    assert lines[-1].wire_bytes == pytest.approx(np.mean([line.wire_bytes for line in lines[:-1]]))


def test_no_scene_costs_more_than_a_whole_frame_a_box_or_page_runs(monkeypatch):
    """The rules of the benchmark, on its 120 frames a scene."""
    monkeypatch.syspath_prepend(Path(__file__).parent.parent / "benchmarks")
    scenes = importlib.import_module("scenes")
    costs = []
    for name, scene in SCENES.items():
        pictures = scenes.frames(scene, scenes.FRAMES)
        steps = [scenes.changes(*pair) for pair in itertools.pairwise(pictures)]
        panel = scenes.Panels()
        costs.append(panel.count(scenes.ours(panel), pictures))
        for rule in scenes.RULES.values():
            assert costs[-1] <= sum(map(rule, steps)), (name, rule)
    assert np.mean(costs) / scenes.FRAMES < scenes.WANTED


def test_bytes_are_what_the_panel_reports(lines):
    transport = I2CTransport(simulator.I2CBus({0x3C: simulator.SSD1306(128, 64)}, timer=None))
    with Panel(SSD1306(128, 64), transport) as panel:
        reports = []
        for frame in range(4):
            with panel.frame() as fb:
                SCENES["ball"](fb, frame)
            reports.append(panel.stats.wire_bytes)
    assert lines[0].wire_bytes == pytest.approx((reports[-1] - reports[0]) / 3)


def test_rates_follow_from_bytes_and_the_clock(lines):
    for line in lines:
        assert line.bits >= 9 * line.wire_bytes
    whole = bench.table(lines)[-1].split()
    assert whole == ["whole", "frame", "1034.0", "11", "43", "107"]


def test_a_scene_at_rest_may_have_any_rate():
    assert bench.table([bench.Line("rest", 0, 0)])[2].split() == ["rest", "0.0", "any", "any", "any"]


def test_a_bar_is_as_long_as_its_bytes():
    fb = bench.chart([bench.Line(name, share * bench.FULL_FRAME, 1000) for name, share in (("a", 0.5), ("b", 0.25))])
    first, second, whole = (np.count_nonzero(row >= 120) for row in fb.pixels[[44, 60, 76]])
    assert (first, second, whole) == (130, 65, 260)


def test_the_command_prints_the_table_and_saves_the_chart(run, tmp_path):
    path = tmp_path / "chart.png"
    done = run("bench", "--frames", 2, "--save", path)
    assert done.returncode == 0, done.stderr
    rows = done.stdout.splitlines()
    assert [row[:12].strip() for row in rows[2:-1]] == [*SCENES, "mean", "whole frame"]
    assert rows[-1] == f"wrote {path}"
    with Image.open(path) as chart:
        assert np.asarray(chart).max() == 255


def test_what_cannot_be_saved_is_said_before_the_work(run, tmp_path):
    assert_one_line_of_advice(run("bench", "--save", tmp_path / "none" / "chart.png"), 1)
    done = run("bench", "--save", "chart.gif")
    assert done.returncode == 2
    assert "chart.gif does not end in .png" in done.stderr
