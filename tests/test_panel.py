from __future__ import annotations

import errno
import re
import threading

import numpy as np
import pytest
from PIL import Image

from paneldraw import Framebuffer, Panel, open_panel, simulator
from paneldraw.controllers import SSD1306
from paneldraw.errors import (
    PanelBusyError,
    PanelDisconnectedError,
    PanelError,
    PanelNotFoundError,
    PanelTimeoutError,
    TransportError,
)
from paneldraw.transports import I2CTransport

SIZES = [(128, 64), (128, 32), (96, 16), (72, 40), (64, 48), (64, 32), (48, 64)]


def simulated(query=""):
    panel = open_panel(f"sim://ssd1306{query}")
    return panel, panel.simulated


def noise(seed, size=(128, 64)):
    return np.random.default_rng(seed).integers(0, 2, size[::-1], np.uint8)


def spots(picture, seed, count=12):
    """The picture with some pixels turned over, here and there."""
    random = np.random.default_rng(seed)
    changed = picture.copy()
    changed[random.integers(0, picture.shape[0], count), random.integers(0, picture.shape[1], count)] ^= 1
    return changed


# -- Pictures


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("rotate", [0, 90, 180, 270])
def test_every_size_shows_every_picture_in_every_turn(size, rotate):
    panel, chip = simulated(f"?size={size[0]}x{size[1]}&rotate={rotate}")
    picture = noise(rotate, (panel.width, panel.height))
    for _ in range(3):
        panel.show(picture)
        np.testing.assert_array_equal(chip.pixels, np.rot90(picture, -rotate // 90))
        picture = spots(picture, rotate)
    assert chip.violations == []


def test_rotate_at_run_time_turns_the_next_picture():
    panel, chip = simulated()
    panel.show(noise(1))
    panel.rotate = 90
    assert (panel.width, panel.height) == (64, 128)
    portrait = noise(2, (64, 128))
    panel.show(portrait)
    np.testing.assert_array_equal(chip.pixels, np.rot90(portrait, -1))


def test_a_frame_is_shown_on_leaving_and_only_then():
    panel, chip = simulated()
    with panel.frame() as fb:
        fb.line(0, 0, 127, 63)
        assert not chip.pixels.any()
    np.testing.assert_array_equal(chip.pixels, fb.pixels)


def test_a_frame_begins_blank_or_where_the_last_one_ended():
    panel, chip = simulated()
    with panel.frame() as fb:
        fb.pixel(1, 1, 1)
    with panel.frame(clear=False) as fb:
        fb.pixel(2, 2, 1)
    assert np.argwhere(chip.pixels).tolist() == [[1, 1], [2, 2]]
    with panel.frame() as fb:
        fb.pixel(3, 3, 1)
    assert np.argwhere(chip.pixels).tolist() == [[3, 3]]
    fb.pixel(4, 4, 1)
    panel.show()
    assert np.argwhere(chip.pixels).tolist() == [[3, 3], [4, 4]]


def test_a_block_that_raises_shows_nothing():
    panel, chip = simulated()
    picture = noise(3)
    panel.show(picture)
    wire = panel.transport.bus.bytes

    def fill_and_fail():
        with panel.frame() as fb:
            fb.fill(1)
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        fill_and_fail()
    assert panel.transport.bus.bytes == wire
    np.testing.assert_array_equal(chip.pixels, picture)


@pytest.mark.parametrize("depth", [1, 2, 4, 8])
def test_what_is_deeper_is_lit_from_half_its_levels(depth):
    panel, chip = simulated()
    fb = Framebuffer(128, 64, depth)
    fb.pixels[:] = np.arange(128) % (fb.max_level + 1)
    panel.show(fb)
    np.testing.assert_array_equal(chip.pixels, fb.pixels > fb.max_level / 2)


def test_every_kind_of_picture():
    panel, chip = simulated()
    picture = noise(4)
    grey = np.where(picture, 200, 100).astype(np.uint8)
    for source in (
        picture,
        picture.astype(bool),
        picture.astype(np.int64),
        Image.fromarray(picture * 255).convert("1"),
        Image.fromarray(grey),
        Image.fromarray(grey).convert("RGB"),
    ):
        panel.show(np.zeros((64, 128), np.uint8))
        panel.show(source)
        np.testing.assert_array_equal(chip.pixels, picture)


@pytest.mark.parametrize(
    ("source", "kind", "complaint"),
    [
        (np.zeros((128, 64), np.uint8), ValueError, "128 x 64 pixels like the panel, not 64 x 128"),
        (np.zeros((64, 128, 3), np.uint8), ValueError, r"like the panel, not an array of shape \(64, 128, 3\)"),
        (np.zeros(8192, np.uint8), ValueError, "128 x 64"),
        (np.full((64, 128), 2, np.uint8), ValueError, "levels from 0 to 1"),
        (np.full((64, 128), -1), ValueError, "levels from 0 to 1"),
        (np.zeros((64, 128)), TypeError, "not float64"),
        (Framebuffer(96, 16), ValueError, "128 x 64"),
        (Image.new("1", (64, 128)), ValueError, "128 x 64"),
        ([[0] * 128] * 64, TypeError, "not list"),
    ],
)
def test_what_is_no_picture_of_this_panel(source, kind, complaint):
    panel, chip = simulated()
    panel.show(noise(5))
    wire = panel.transport.bus.bytes
    with pytest.raises(kind, match=f"source must.*{complaint}"):
        panel.show(source)
    assert panel.transport.bus.bytes == wire
    np.testing.assert_array_equal(chip.pixels, noise(5))


# -- Bytes


def test_reports_and_their_sums():
    panel, _ = simulated()
    bus = panel.transport.bus
    before = bus.bytes, bus.messages
    picture = noise(6)
    reports = []
    for _ in range(5):
        reports.append(panel.show(picture))
        picture = spots(picture, 6)
    reports.append(panel.show(spots(noise(6), 6)))
    reports.append(panel.show(spots(noise(6), 6)))
    assert sum(report.wire_bytes for report in reports) == bus.bytes - before[0] == panel.stats.wire_bytes
    assert sum(report.messages for report in reports) == bus.messages - before[1] == panel.stats.messages
    assert sum(report.changed_bytes for report in reports) == panel.stats.changed_bytes
    assert (reports[0].changed_bytes, reports[-1].changed_bytes) == (1024, 0)
    assert [report.unchanged for report in reports] == [False] * 6 + [True]
    assert (panel.stats.frames, panel.stats.unchanged) == (7, 1)
    assert all(report.seconds > 0 for report in reports)


def test_one_pixel_after_the_first_picture_is_eight_bytes():
    panel, _ = simulated()
    picture = noise(7)
    panel.show(picture)
    picture[20, 77] ^= 1
    report = panel.show(picture)
    assert (report.wire_bytes, report.messages, report.changed_bytes) == (8, 2, 1)


def test_force_sends_everything_whatever_the_panel_is_thought_to_hold():
    panel, chip = simulated()
    panel.show(noise(8))
    chip.write(b"\x00\x20\x00\x21\x05\x09\x22\x01\x02")  # somebody else moved the pointer
    chip.write(b"\x40" + bytes(100))
    report = panel.show(noise(8), force=True)
    assert report.changed_bytes == 1024
    np.testing.assert_array_equal(chip.pixels, noise(8))


# -- Settings


def test_dim_goes_below_contrast_zero_and_a_recovery_keeps_it():
    panel, chip = simulated()
    panel.show(noise(1))
    seen = []
    for level in (255, 192, 128, 127, 60, 0):
        panel.dim(level)
        seen.append((chip.contrast, chip.registers.precharge, chip.registers.vcomh))
    assert seen[:3] == [(255, 0xF1, 0x30), (129, 0xF1, 0x30), (1, 0xF1, 0x30)]
    assert seen[3:] == [(0, 0xF1, 0x00), (0, 0x22, 0x00), (0, 0x11, 0x00)]
    chip.power_cycle()
    panel.invalidate()
    panel.show(noise(3))
    assert (chip.contrast, chip.registers.precharge, chip.registers.vcomh) == (0, 0x11, 0x00)
    panel.dim(255)
    assert (chip.contrast, chip.registers.precharge, chip.registers.vcomh) == (255, 0xF1, 0x30)
    with pytest.raises(ValueError, match="must be 0 to 255, not 256"):
        panel.dim(256)


def test_a_command_of_the_users_is_sent_again_after_a_restart_if_it_is_to_be_kept():
    panel, chip = simulated()
    panel.command(b"\xd9\x11", keep=True)
    panel.command(bytearray(b"\xd5\xf0"))
    assert (chip.registers.precharge, chip.registers.clock) == (0x11, 0xF0)
    chip.power_cycle()
    panel.invalidate()
    panel.show(noise(4))
    assert (chip.registers.precharge, chip.registers.clock) == (0x11, 0x80)
    np.testing.assert_array_equal(chip.pixels, noise(4))
    with pytest.raises(ValueError, match="command must not be empty"):
        panel.command(b"")
    with pytest.raises(TypeError, match="command must be bytes, not str"):
        panel.command("AF")


def test_contrast_from_the_start():
    _, chip = simulated("?contrast=7")
    assert chip.contrast == 7
    with pytest.raises(ValueError, match="contrast must be 0 to 255, not 300"):
        simulated("?contrast=300")


def test_contrast_invert_sleep_and_wake():
    panel, chip = simulated()
    picture = noise(9)
    panel.show(picture)
    panel.contrast(17)
    assert chip.contrast == 17
    panel.invert(True)
    np.testing.assert_array_equal(chip.pixels, 1 - picture)
    panel.invert(False)
    panel.sleep()
    assert not chip.pixels.any()
    picture = spots(picture, 9)
    panel.show(picture)
    assert not chip.pixels.any()
    panel.wake()
    np.testing.assert_array_equal(chip.pixels, picture)
    assert chip.violations == []


@pytest.mark.parametrize(("level", "kind"), [(-1, ValueError), (256, ValueError), (1.5, TypeError), ("9", TypeError)])
def test_contrast_out_of_range(level, kind):
    panel, _ = simulated()
    with pytest.raises(kind):
        panel.contrast(level)


def test_the_panel_stays_dark_until_there_is_a_picture():
    chip = simulator.SSD1306(128, 64)
    assert chip.ram.any()
    panel = Panel(SSD1306(), I2CTransport(simulator.I2CBus({0x3C: chip})))
    assert not chip.pixels.any()
    panel.show(noise(10))
    assert len(chip.frames) == 1


@pytest.mark.parametrize("attribute", ["rotate", "on_close"])
def test_settings_that_do_not_exist(attribute):
    with pytest.raises(ValueError, match=f"{attribute} must be one of"):
        Panel(SSD1306(), I2CTransport(simulator.I2CBus({0x3C: simulator.SSD1306()})), **{attribute: 45})


def test_rotate_at_run_time_is_checked_too():
    panel, _ = simulated()
    with pytest.raises(ValueError, match="rotate must be one of 0, 90, 180, 270, not 45"):
        panel.rotate = 45
    assert panel.rotate == 0


# -- Closing


@pytest.mark.parametrize("on_close", ["keep", "clear", "off"])
def test_what_is_left_behind(on_close):
    panel, chip = simulated(f"?on_close={on_close}")
    with panel:
        panel.show(noise(11))
    if on_close == "keep":
        np.testing.assert_array_equal(chip.pixels, noise(11))
    else:
        assert not chip.pixels.any()
    assert chip.registers.on == (on_close != "off")
    panel.close()


def test_a_closed_panel_says_so():
    panel, _ = simulated()
    panel.close()
    for use in (lambda: panel.show(noise(0)), panel.wake, panel.sleep, lambda: panel.contrast(1), panel.invert):
        with pytest.raises(PanelError, match="closed"):
            use()


class Closing:
    """A transport that notes being closed."""

    def __init__(self, transport):
        self.transport, self.cost, self.closed = transport, transport.cost, False
        self.command, self.data, self.batch = transport.command, transport.data, transport.batch
        self.reset = transport.reset

    def close(self):
        self.closed = True


def test_the_transport_is_closed_though_the_farewell_fails():
    bus = simulator.I2CBus({0x3C: simulator.SSD1306()})
    transport = Closing(I2CTransport(bus))
    panel = Panel(SSD1306(), transport, on_close="off")
    bus.devices.clear()
    with pytest.raises(PanelDisconnectedError):
        panel.close()
    assert transport.closed


def test_what_went_wrong_first_is_what_the_script_hears_of():
    panel, _ = simulated("?on_close=off")

    def fail():
        with panel:
            panel.transport.bus.devices.clear()
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        fail()


# -- Faults


#: What the kernel says where a panel does not answer; one code stands for all where time is short.
NO_ANSWER = [errno.EREMOTEIO, *(pytest.param(code, marks=pytest.mark.thorough) for code in (errno.ENXIO, errno.EIO))]
PICTURES = [noise(12), spots(noise(12), 13, 40), noise(14)]


def messages_of_the_last_two():
    panel, _ = simulated()
    panel.contrast(33)
    return sum([panel.show(picture).messages for picture in PICTURES][1:])


@pytest.mark.usefixtures("own_time")
@pytest.mark.parametrize("code", NO_ANSWER)
@pytest.mark.parametrize("at_byte", [None, 0, 1, 2, 3, 5])
@pytest.mark.parametrize("lose_power", [False, True])
@pytest.mark.parametrize("passes", [True, False])
def test_after_a_fault_at_any_message_the_next_show_is_whole(code, at_byte, lose_power, passes):
    count = messages_of_the_last_two()
    assert count > 20
    for message in range(count) if passes else range(0, count, 5):
        panel, chip = simulated()
        panel.contrast(33)
        panel.show(PICTURES[0])
        then = chip.power_cycle if lose_power else None
        panel.transport.bus.fail(code, after=message, at_byte=at_byte, then=then, times=1 if passes else None)
        errors = []
        for picture in PICTURES[1:]:
            try:
                panel.show(picture)
            except TransportError as error:
                errors.append(error.errno)
                panel.transport.bus.clear_faults()
                assert panel.show(picture).changed_bytes == 1024
            np.testing.assert_array_equal(chip.pixels, picture)
        assert errors == ([] if passes else [code])
        assert panel.stats.retries >= 1
        assert chip.contrast == 33


@pytest.mark.usefixtures("own_time")
@pytest.mark.parametrize("code", [errno.EAGAIN, errno.EBUSY, errno.ETIMEDOUT])
@pytest.mark.parametrize("at_byte", [None, 0, 1, 2, 3])
def test_a_transient_fault_at_any_message_is_survived(code, at_byte):
    for message in range(0, 24, 3):
        panel, chip = simulated()
        panel.show(noise(15))
        picture = spots(noise(15), 16, 40)
        panel.transport.bus.fail(code, after=message, at_byte=at_byte)
        panel.show(picture)
        np.testing.assert_array_equal(chip.pixels, picture)
        panel.transport.bus.clear_faults()
        assert panel.stats.retries <= 1
        np.testing.assert_array_equal(chip.pixels, picture)


@pytest.mark.parametrize(("code", "kind"), [(errno.EBUSY, PanelBusyError), (errno.ETIMEDOUT, PanelTimeoutError)])
def test_patience_ends(code, kind):
    panel, chip = simulated()
    panel.show(noise(17))
    panel.transport.bus.fail(code, times=None)
    with pytest.raises(kind) as caught:
        panel.show(noise(18))
    assert caught.value.errno == code
    panel.transport.bus.clear_faults()
    panel.show(noise(18))
    np.testing.assert_array_equal(chip.pixels, noise(18))


@pytest.mark.parametrize("at_byte", [None, *range(35)])
def test_an_init_that_was_cut_off_is_made_up_for(at_byte):
    chip = simulator.SSD1306(128, 64)
    bus = simulator.I2CBus({0x3C: chip})
    bus.fail(at_byte=at_byte)
    with pytest.raises(PanelNotFoundError):
        Panel(SSD1306(), I2CTransport(bus))
    panel = Panel(SSD1306(), I2CTransport(bus))
    panel.show(noise(19))
    np.testing.assert_array_equal(chip.pixels, noise(19))


@pytest.mark.parametrize("setting", ["contrast", "invert", "sleep", "wake"])
@pytest.mark.parametrize("at_byte", [None, 1, 2])
def test_a_setting_that_failed_holds_after_the_next_show(setting, at_byte):
    panel, chip = simulated()
    picture = noise(20)
    panel.show(picture)
    if setting == "wake":
        panel.sleep()
    panel.transport.bus.fail(at_byte=at_byte, times=None)
    change = {"contrast": lambda: panel.contrast(7), "invert": panel.invert}.get(setting, getattr(panel, setting))
    with pytest.raises(PanelDisconnectedError):
        change()
    panel.transport.bus.clear_faults()
    panel.show(picture)
    assert chip.contrast == (7 if setting == "contrast" else 0xCF)
    wanted = {"invert": 1 - picture, "sleep": 0 * picture}.get(setting, picture)
    np.testing.assert_array_equal(chip.pixels, wanted)


def test_a_transient_fault_of_a_setting_leaves_the_picture():
    panel, chip = simulated()
    panel.show(noise(21))
    panel.transport.bus.fail(errno.ETIMEDOUT, at_byte=2, then=chip.power_cycle)
    panel.contrast(99)
    assert chip.contrast == 99
    np.testing.assert_array_equal(chip.pixels, noise(21))


def test_an_interrupted_show_is_made_up_for():
    panel, chip = simulated()
    panel.show(noise(22))

    def interrupt():
        raise KeyboardInterrupt

    panel.transport.bus.fail(after=1, at_byte=2, then=interrupt)
    with pytest.raises(KeyboardInterrupt):
        panel.show(noise(23))
    panel.show(noise(23))
    np.testing.assert_array_equal(chip.pixels, noise(23))


def test_invalidate_after_a_power_cut():
    panel, chip = simulated()
    panel.show(noise(24))
    chip.power_cycle()
    panel.invalidate()
    panel.show(noise(24))
    np.testing.assert_array_equal(chip.pixels, noise(24))


# -- Threads


def test_frames_of_several_threads_never_mix():
    panel, chip = simulated()
    pictures = [noise(seed) for seed in range(4)]
    failures = []

    def draw(picture):
        try:
            for _ in range(20):
                panel.show(picture)
                with panel.frame() as fb:
                    fb.pixels[:] = picture
        except BaseException as error:
            failures.append(error)

    threads = [threading.Thread(target=draw, args=(picture,)) for picture in pictures]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert failures == []
    for frame in chip.frames:
        assert any(np.array_equal(frame.pixels, picture) for picture in pictures)
    assert panel.stats.frames == 160
    assert chip.violations == []


# -- URLs


def test_a_panel_by_url():
    panel = open_panel("sim://ssd1306?size=96x16&rotate=180&on_close=off")
    assert (panel.controller, panel.rotate, panel.on_close) == (SSD1306(96, 16), 180, "off")


def test_without_a_url_the_environment_says_which(monkeypatch):
    monkeypatch.setenv("PANELDRAW_PANEL", "sim://ssd1306?size=64x32")
    assert open_panel().width == 64
    for empty in (lambda: monkeypatch.setenv("PANELDRAW_PANEL", ""), lambda: monkeypatch.delenv("PANELDRAW_PANEL")):
        empty()
        assert (open_panel().width, open_panel().height) == (128, 64)


# -- What people type


@pytest.mark.parametrize("controller", [SSD1306(), SSD1306, "ssd1306", "SSD1306"])
def test_a_chip_and_a_bus_are_enough(controller):
    chip = simulator.SSD1306()
    panel = Panel(controller, simulator.I2CBus({0x3C: chip}))
    panel.show(noise(1))
    np.testing.assert_array_equal(chip.pixels, noise(1))
    panel.clear()
    assert not chip.pixels.any()


def test_what_is_no_controller_or_no_transport_says_what_to_write():
    bus = simulator.I2CBus({0x3C: simulator.SSD1306()})
    with pytest.raises(ValueError, match=r"not 'ssd1360'; did you mean ssd1362\?"):
        Panel("ssd1360", bus)
    with pytest.raises(TypeError, match=r"controller must be a Controller, such as SSD1306\(128, 64\)"):
        Panel(bus, SSD1306())
    with pytest.raises(TypeError, match=r"transport must be a transport, such as I2CTransport\(bus=1\)"):
        Panel(SSD1306(), None)
    with pytest.raises(ValueError, match=r"write open_panel\('i2c://1'\)"):
        Panel(SSD1306(), "i2c://1")


@pytest.mark.parametrize(
    ("url", "kind", "complaint"),
    [
        ("i2c://1?chip=ssd1360", ValueError, "chip must be one of"),
        ("i2c://1/0x99", ValueError, "address must be 0x08 to 0x77"),
        ("i2c://777", PanelNotFoundError, "there is no bus /dev/i2c-777: "),
        ("serial:///dev/ttyNONE", PanelNotFoundError, "there is no port /dev/ttyNONE: "),
        ("sim://ssd1306?contrast=999", ValueError, "contrast must be 0 to 255"),
    ],
)
def test_the_environment_is_named_as_the_source(monkeypatch, url, kind, complaint):
    monkeypatch.setenv("PANELDRAW_PANEL", url)
    source = "the environment variable PANELDRAW_PANEL is "
    with pytest.raises(kind, match=re.escape(f"{source}{url!r}: {complaint}")):
        open_panel()
    with pytest.raises(kind, match=re.escape(complaint)) as caught:
        open_panel(url)
    assert source not in str(caught.value)


def test_a_pictures_file(tmp_path):
    panel, chip = simulated()
    path = tmp_path / "picture.png"
    Image.fromarray(noise(3) * 255).save(path)
    for name in (path, str(path)):
        panel.clear()
        panel.show(name)
        np.testing.assert_array_equal(chip.pixels, noise(3))
    with pytest.raises(FileNotFoundError, match=r"none.png"):
        panel.show("none.png")
