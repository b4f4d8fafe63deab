"""What other programs record of a wire ends in the picture that the wire carried, and odd files in a line that says so.

Samples are made from messages of real wires; smaller files are written here as the programs write them.
"""

from __future__ import annotations

import gzip
import io
import itertools
import re
import zipfile
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from paneldraw import simulator
from paneldraw.simulator import edges, log
from paneldraw.simulator.log import Call, Message, Select

from . import waves
from .helpers import init, pack, random_picture

CAPTURES = Path(__file__).parent / "captures"
PICTURE = random_picture(128, 64, 5)


def captured(name: str, first: int, last: int) -> list[log.Event]:
    """Some messages of a real wire."""
    with gzip.open(CAPTURES / f"{name}.txt.gz", "rt") as file:
        events = list(log.read(enumerate(map(str.rstrip, file), 1)))
    return events[first:last]


def calls() -> list[Call]:
    """An SSD1306 on I2C: nobody at an address, then an init, a picture, and a read joined to a write."""
    runs = [pack(PICTURE).tobytes()[start : start + 128] for start in range(0, 1024, 128)]
    sent = [b"\x00" + init(128, 64), bytes.fromhex("00 21 00 7F 22 00 07"), *(b"\x40" + run for run in runs)]
    found = [Call(0.001, (Message(0x3D, b"", acknowledged=False),))]
    found += [Call(0.002 + 0.004 * number, (Message(0x3C, payload),)) for number, payload in enumerate(sent)]
    return [*found, Call(0.09, (Message(0x3C, b"\x00\xe3"), Message(0x3C, b"\x03", read=True)))]


def test_a_session_of_i2c_shows_what_the_wire_carried(tmp_path: Path) -> None:
    (tmp_path / "i2c.sr").write_bytes(waves.session(waves.i2c(calls()), ["SCL", "SDA"]))
    chip = simulator.SSD1306()
    told = simulator.replay(tmp_path / "i2c.sr", chip, rate=1e6)  # the file knows better
    assert told == ("a sigrok session", 12, 0x3C, [])
    assert np.array_equal(chip.pixels, PICTURE)
    assert chip.frames[-1].seconds == pytest.approx(0.05, abs=0.02)
    assert chip.violations == []


@pytest.mark.parametrize("unitsize", range(1, 9))
def test_samples_of_every_size(tmp_path: Path, unitsize: int) -> None:
    """Up to 64 channels, of which the last two are looked at."""
    names = [*(f"D{number}" for number in range(8 * unitsize - 2)), "SCL", "SDA"]
    samples = [word << 8 * unitsize - 2 for word in waves.i2c(calls()[:3])]
    (tmp_path / "i2c.sr").write_bytes(waves.session(samples, names, unitsize=unitsize))
    assert simulator.replay(tmp_path / "i2c.sr", simulator.SSD1306()).events == 3


@pytest.mark.parametrize("seed", [1, pytest.param(2, marks=pytest.mark.thorough)])
def test_the_edges_of_real_messages_are_those_messages(seed: int) -> None:
    events = captured("ssd1306-i2c", 100, 400)
    assert list(_decoded(waves.i2c(events, seed), ["SCL", "SDA"])) == [event._replace(seconds=0.0) for event in events]
    selects = captured("ssd1306-spi", 0, 60)
    samples = waves.spi(selects, seed)
    assert list(_decoded(samples, ["CLK", "MOSI", "CS", "D/C"])) == [event._replace(seconds=0.0) for event in selects]


def _decoded(samples: list[int], names: list[str], said: list[str] | None = None, **lines: str) -> list[log.Event]:
    """Events of samples, without their times."""
    at, words = map(np.array, zip(*waves.changes(samples), strict=True))
    levels = (words[:, None] >> np.arange(len(names)) & 1).astype(bool)
    notes = [] if said is None else said
    found = edges.decode(edges.Samples(names, at / waves.RATE, levels), lines, notes.append)
    return [event._replace(seconds=0.0) for event in found]


MESSAGES = st.builds(
    lambda address, payload, read, acknowledged: Message(address, payload if acknowledged else b"", read, acknowledged),
    st.integers(0, 0x7F),
    st.binary(max_size=6),
    st.booleans(),
    st.booleans(),
)


@given(
    st.lists(st.lists(MESSAGES, min_size=1, max_size=3).map(lambda m: Call(0.0, tuple(m))), max_size=5),
    st.integers(0, 99),
)
def test_any_i2c_messages_come_out_of_their_edges(events: list[Call], seed: int) -> None:
    said: list[str] = []
    assert _decoded(waves.i2c(events, seed), ["a", "b"], said, scl="0", sda="1") == events
    assert said == []


RUNS = st.lists(st.tuples(st.booleans(), st.binary(min_size=1, max_size=5)), min_size=1, max_size=4)


def _alternating(runs: list[tuple[bool, bytes]]) -> Select:
    """Runs next to each other that are alike are one."""
    joined = [
        (data, b"".join(run for _, run in group)) for data, group in itertools.groupby(runs, key=lambda run: run[0])
    ]
    return Select(0.0, tuple(joined))


@given(st.lists(RUNS.map(_alternating), max_size=5), st.integers(0, 99))
def test_any_chip_selects_come_out_of_their_edges(selects: list[Select], seed: int) -> None:
    said: list[str] = []
    assert _decoded(waves.spi(selects, seed), ["CLK", "DIN", "CS", "D/C#"], said) == selects
    assert said == []


def test_without_a_chip_select_pauses_part_the_bytes() -> None:
    selects = [Select(number / 1000, ((False, b"\xae\x81"), (True, bytes([number, 3])))) for number in range(5)]
    said: list[str] = []
    found = _decoded(waves.spi(selects), ["SCK", "SDA", "-", "A0"], said)
    assert found == [event._replace(seconds=0.0) for event in selects]
    assert said == ["no channel is CS: bytes are counted from pauses of the clock on"]


def test_a_reset_line_resets(tmp_path: Path) -> None:
    samples = waves.spi([Select(0.001, ((False, b"\x8d\x14\xa5\xaf"),)), Select(0.003, ((False, b"\x81\x20"),))])
    low = range(int(0.002 * waves.RATE), int(0.0025 * waves.RATE))
    samples = [word | (number not in low) << 4 for number, word in enumerate(samples)]
    (tmp_path / "spi.sr").write_bytes(waves.session(samples, ["D0", "D1", "CS", "DC", "RES"], parts=1, unitsize=2))
    chip = simulator.SSD1306()
    told = simulator.replay(tmp_path / "spi.sr", chip)
    assert [int(frame.pixels.sum()) for frame in chip.frames] == [8192, 0]
    assert (told.events, chip.contrast, chip.registers.on) == (3, 0x20, False)


# -- The same wire, exported by every program


def test_every_export_of_one_wire_is_the_same_picture(tmp_path: Path) -> None:
    samples = waves.i2c(calls())
    files = {
        "log.txt": "".join(f"{line}\n" for call in calls() for line in log.lines(call)),
        "digital.csv": waves.saleae_digital(samples, ["Channel 0", "Channel 1"]),
        "table.csv": waves.saleae_table(calls()),
        "trace.txt": waves.kernel_trace(calls()),
    }
    forms = ["a log", "digital channels of Saleae's Logic", "a table of Saleae's Logic", "a trace of the kernel's"]
    for (name, text), form in zip(files.items(), forms, strict=True):
        (tmp_path / name).write_bytes(gzip.compress(text.encode()) if name == "table.csv" else text.encode())
        chip = simulator.SSD1306()
        told = simulator.replay(tmp_path / name, chip)
        assert (told.form, told.address, told.events) == (form, 0x3C, 12)
        if name != "trace.txt":
            assert np.array_equal(chip.pixels, PICTURE), name
        assert chip.violations == []


def test_what_the_kernel_leaves_out_is_said(tmp_path: Path) -> None:
    (tmp_path / "trace").write_text(waves.kernel_trace(calls()))
    chip = simulator.SSD1306()
    told = simulator.replay(tmp_path / "trace", chip)
    assert told.remarks == [
        "a call failed with errno 121; its messages are left out, though the chip may have got some",
        "the kernel's text shows 64 bytes of a message at the most; zeros stand for the others (8 times)",
    ]
    assert np.array_equal(chip.pixels[:, :63], PICTURE[:, :63])
    assert not chip.pixels[:, 63:].any()


SIGROK = """\
; CSV generated by libsigrok 0.5.2
; from Session-emulating driver on Sun Nov 29 22:49:46 2026
; Channels (2/2): SCL, SDA
; Samplerate: 2 MHz
"""


@pytest.mark.parametrize("labels", ["", "logic,logic", "SCL,SDA", "nanoseconds,logic,logic", "Time,SCL,SDA"])
def test_every_kind_of_sigroks_csv(tmp_path: Path, labels: str) -> None:
    """As sigrok-cli 0.7.2 writes them with -O csv and its options label, time and dedup."""
    samples, timed = waves.i2c(calls()[:3]), labels.count(",") == 2
    pairs = waves.changes(samples) if timed else enumerate(samples)
    rows = [f"{500 * (at + 1)},{word & 1},{word >> 1}" if timed else f"{word & 1},{word >> 1}" for at, word in pairs]
    (tmp_path / "a.csv").write_text(SIGROK + "\n".join([labels, *rows] if labels else rows))
    chip = simulator.SSD1306()
    told = simulator.replay(tmp_path / "a.csv", chip)
    assert (told.form, told.events, told.remarks) == ("sigrok's CSV", 3, [])
    assert chip.registers.on
    assert chip.frames[0].seconds == pytest.approx(0.003, abs=0.002)


LOGIC_2 = """\
name,type,start_time,duration,"ack","address","read","data"
"I2C","start",0.892847542,4.16666667e-08,,,,
"I2C","address",0.892855167,8.67916667e-05,true,0x3C,false,
"I2C","data",0.892949792,8.67916667e-05,true,,,0x00
"I2C","data",0.893049792,8.67916667e-05,true,,,0x8D
"I2C","data",0.893149792,8.67916667e-05,true,,,0x14
"I2C","data",0.893249792,8.67916667e-05,true,,,0xA5
"I2C","data",0.893349792,8.67916667e-05,true,,,0xAF
"I2C","stop",0.893449792,4.16666667e-08,,,,
"""
LOGIC_1 = """\
Time [s],Packet ID,Address,Data,Read/Write,ACK/NAK
0.448499000000000,0,0x78,0x00,Write,ACK
0.448728500000000,0,0x78,0x8D,Write,ACK
0.448958500000000,0,0x78,0x14,Write,ACK
0.449248000000000,0,0x78,0xA5,Write,ACK
0.449478000000000,0,0x78,0xAF,Write,ACK
0.449707500000000,1,0x79,0x03,Read,NAK
"""
TRACE = """\
# tracer: nop
#
# entries-in-buffer/entries-written: 4/4   #P:4
#
#                                _-----=> irqs-off/BH-disabled
#                               / _----=> need-resched
#           TASK-PID     CPU#  |||||  TIMESTAMP  FUNCTION
#              | |         |   |||||     |         |
          python3-1187    [002] .....   210.487215: i2c_write: i2c-1 #0 a=03c f=0000 l=5 [00-8d-14-a5-af]
          python3-1187    [002] .....   210.487822: i2c_result: i2c-1 n=1 ret=1
          python3-1187    [002] .....   210.490113: i2c_read: i2c-1 #0 a=03c f=0001 l=1
          python3-1187    [002] .....   210.490345: i2c_reply: i2c-1 #0 a=03c f=0001 l=1 [03]
          python3-1187    [002] .....   210.490346: i2c_result: i2c-1 n=1 ret=1
"""
PERF = """\
         python3  1187 [002]   210.487215: i2c:i2c_write: i2c-1 #0 a=03c f=0000 l=5 [00-8d-14-a5-af]
         python3  1187 [002]   210.487822: i2c:i2c_result: i2c-1 n=1 ret=1
"""
PULSEVIEW = """\
20-20 I²C: Address/data: Start
26-68 I²C: Address/data: Address write: 3C
68-74 I²C: Address/data: Write
74-80 I²C: Address/data: ACK
80-130 I²C: Address/data: Data write: 00
130-136 I²C: Address/data: ACK
136-186 I²C: Address/data: Data write: 8D
186-192 I²C: Address/data: ACK
192-240 I²C: Address/data: Data write: 14
240-246 I²C: Address/data: ACK
246-300 I²C: Address/data: Data write: A5
300-306 I²C: Address/data: ACK
306-360 I²C: Address/data: Data write: AF
360-366 I²C: Address/data: ACK
1000-1000 I²C: Address/data: Stop
"""
SIGROK_CLI = re.sub(r"^\S+ I²C: Address/data", "i2c-1", PULSEVIEW, flags=re.M)
NOT_TIMED = "the annotations do not tell the samplerate, so times are not true; say it with --rate"


@pytest.mark.parametrize(
    ("text", "form", "seconds", "remarks"),
    [
        (LOGIC_2, "a table of Saleae's Logic", 0.893449792, []),
        (LOGIC_1, "an export of Saleae's analyzer", 0.449478, []),
        (TRACE, "a trace of the kernel's", 210.487822, []),
        (PERF, "a trace of the kernel's", 210.487822, []),
        (PULSEVIEW, "annotations of sigrok's", 0.0005, []),
        (SIGROK_CLI, "annotations of sigrok's", 0.001, [NOT_TIMED]),
    ],
    ids=["logic 2", "logic 1", "trace", "perf", "pulseview", "sigrok-cli"],
)
@pytest.mark.parametrize("newline", ["\n", "\r\n"])
def test_files_as_the_programs_write_them(
    tmp_path: Path, text: str, form: str, seconds: float, remarks: list[str], newline: str
) -> None:
    """After what people published of Logic 1 and 2, the kernel's documentation, and sigrok-cli's own output."""
    (tmp_path / "a.txt").write_bytes(text.replace("\n", newline).encode())
    chip = simulator.SSD1306()
    told = simulator.replay(tmp_path / "a.txt", chip, rate=2e6)
    assert (told.form, told.address, told.remarks) == (form, 0x3C, remarks)
    assert int(chip.pixels.sum()) == 8192
    assert chip.frames[0].seconds == pytest.approx(seconds)


def test_spi_tables_have_no_dc(tmp_path: Path) -> None:
    """Which a MAX7219 does without."""
    (tmp_path / "logic2.csv").write_text(
        'name,type,start_time,duration,"mosi","miso"\n'
        '"SPI","enable",0.1,0.000000004,,\n"SPI","result",0.1001,0.000000452,0x0F,0x00\n'
        '"SPI","result",0.1002,0.000000452,0x01,0x00\n"SPI","disable",0.1003,0.000000004,,\n'
    )
    (tmp_path / "logic1.csv").write_text("Time [s],Packet ID,MOSI,MISO\n0.1,0,0x0F,0x00\n0.2,0,0x01,0x00\n")
    for name in ("logic2.csv", "logic1.csv"):
        chip = simulator.MAX7219(8, 8)
        told = simulator.replay(tmp_path / name, chip)
        assert int(chip.pixels.sum()) == 64
        assert told.remarks == []


# -- Which chip, which channel


def test_the_address_is_found_or_asked_for(tmp_path: Path) -> None:
    path = tmp_path / "a.log"
    path.write_text("0.1 3d w ack 008d14a5af\n0.2 50 r ack 00\n0.3 3e w nak\n")
    assert simulator.replay(path, simulator.SSD1306(), usual=0x3C).address == 0x3D
    path.write_text("0.1 3d w ack 008d14a5af\n0.2 50 w ack 00\n")
    with pytest.raises(ValueError, match=r"say which is the panel's: 0x3d \(1 messages\), 0x50 \(1 messages\)"):
        simulator.replay(path, simulator.SSD1306(), usual=0x3C)
    assert simulator.replay(path, simulator.SSD1306(), usual=0x3D).address == 0x3D
    assert simulator.replay(path, simulator.SSD1306(), address=0x3D).address == 0x3D
    with pytest.raises(ValueError, match="nothing was written to a chip at 0x3c; chips answered at: 0x3d, 0x50"):
        simulator.replay(path, simulator.SSD1306(), address=0x3C)


def test_a_panel_behind_a_multiplexer(tmp_path: Path) -> None:
    path = tmp_path / "a.log"
    sent = ["70 w ack 01", "3c w ack 008120", "70 w ack 08", "3c w ack 008130", "70 w ack 00", "3c w ack 008140"]
    path.write_text("".join(f"0.{number} {line}\n" for number, line in enumerate(sent)))
    for channel, contrast in ((0, 0x20), (3, 0x30)):
        chip = simulator.SSD1306()
        simulator.replay(path, chip, address=0x3C, mux=(0x70, channel))
        assert chip.contrast == contrast


def test_a_real_session_of_a_max7219() -> None:
    """Whose driver, at its end, sends one byte and three bytes in a select on purpose."""
    chip = simulator.MAX7219(8, 8)
    told = simulator.replay(CAPTURES / "max7219.sr", chip)
    assert told == ("a sigrok session", 29, None, [])
    assert chip.violations == ["0F 0B: a select takes a register and a byte for each of 1 chips"]
    assert chip.remarks[-1:] == ["0D 0C: there is no such register; ignored"]
    assert chip.digits[0].tolist() == [5, 1, 15, 3, 2, 11, 0, 1]


def test_the_wrong_bus_for_a_chip(tmp_path: Path) -> None:
    (tmp_path / "a.log").write_text("0.1 3c w ack 00\n")
    with pytest.raises(ValueError, match="a recording of I2C, and MAX7219s sit on SPI"):
        simulator.replay(tmp_path / "a.log", simulator.MAX7219())


def test_channels_without_a_name_are_asked_for() -> None:
    samples = waves.spi([Select(0.0, ((False, b"\x0f\x01"),))])
    with pytest.raises(ValueError, match=r"which channel is CLK and which MOSI\? There are 0 a, 1 b, 2 c, 3 d; say so"):
        _decoded(samples, ["a", "b", "c", "d"])
    with pytest.raises(ValueError, match="--clk: there is no channel '7'; there are a, b, c, d"):
        _decoded(samples, ["a", "b", "c", "d"], clk="7")
    assert _decoded(samples, ["a", "b", "c", "d"], clk="A", mosi="1", cs="2") == [Select(0.0, ((False, b"\x0f\x01"),))]


def test_of_two_channels_the_busier_is_the_clock() -> None:
    events, said = calls()[1:3], list[str]()
    swapped = [word >> 1 | (word & 1) << 1 for word in waves.i2c(events)]
    assert _decoded(swapped, ["D0", "D1"], said) == [event._replace(seconds=0.0) for event in events]
    assert said == ["channel D1 is taken for SCL, as it has more edges"]


def test_what_is_cut_off_is_said() -> None:
    said: list[str] = []
    samples = waves.i2c([Call(0.0, (Message(0x3C, b"\x00\xaf"),))])
    _decoded(samples[:-60], ["SCL", "SDA"], said)
    assert said == ["a message breaks off within a byte", "the recording ends before the last STOP"]
    said = []
    samples = waves.spi([Select(0.0, ((True, b"\xff\xff"),))])
    _decoded([*samples[:-40], 0b1100, 0b1100], ["CLK", "MOSI", "CS", "DC"], said)
    assert said == ["a chip select ends within a byte"]


# -- Damaged files


def bomb() -> bytes:
    """A session of 5 GiB of nothing."""
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr(
            "metadata", "[device 1]\ncapturefile=logic-1\nsamplerate=1 MHz\nprobe1=SCL\nprobe2=SDA\nunitsize=1\n"
        )
        with archive.open("logic-1-1", "w", force_zip64=True) as samples:
            for _ in range(5 << 10 >> 4):
                samples.write(bytes(16 << 20))
    return file.getvalue()


def without(name: str, **changed: str) -> bytes:
    """A session with one file less, or with other metadata."""
    file = io.BytesIO()
    with (
        zipfile.ZipFile(io.BytesIO(waves.session([3, 2, 0] * 9, ["SCL", "SDA"]))) as old,
        zipfile.ZipFile(file, "w") as new,
    ):
        for entry in old.namelist():
            if entry != name:
                text = old.read(entry)
                for key, value in changed.items():
                    text = re.sub(rb"(?m)^%b=.*$" % key.encode(), f"{key}={value}".encode(), text)
                new.writestr(entry, text)
    return file.getvalue()


WHOLE = waves.session([3, 2, 0] * 9, ["SCL", "SDA"])
DAMAGED = {
    "an empty file": (b"", "none of what can be read"),
    "a picture": (b"\x89PNG\r\n\x1a\n" + bytes(range(256)), "none of what can be read"),
    "half a zip": (WHOLE[: len(WHOLE) // 2], "the file is damaged, or no sigrok session"),
    "bits turned over": (WHOLE.replace(b"logic-1-2", b"logic-1-9", 1), "damaged|no message"),
    "another zip": (without("metadata"), "the zip has no file metadata"),
    "no unitsize": (without("", unitsize="9"), "does not say its unitsize and probes"),
    "no rate": (without("", samplerate="often"), "does not tell its samplerate; say it with --rate"),
    "metadata of noise": (without("", capturefile="[\n="), "damaged|lacks"),
    "no samples": (without("", capturefile="logic-2"), "the session lacks its samples, logic-2"),
    "no edges": (waves.session([3] * 99, ["SCL", "SDA"]), "there is no message in it"),
    "half a gzip": (gzip.compress(b"0.1 3c w ack 00\n" * 999)[:60], "ended before|damaged"),
    "a long line": (b"0.1 3c w ack 00\n0.2 3c w ack " + b"0" * (2 << 20), "line 2 is too long"),
    "a broken log": (b"0.1 3c w ack 00\n0.2 3c w ack 0\n", "line 2 is none of a log"),
    "a broken table": (LOGIC_2.replace("0xAF", "0xAF0").encode(), "line 8: '0xAF0' is no byte"),
    "a table of clock times": (LOGIC_2.replace("0.8", "2026-11-29T0").encode(), "line 2: .* is no time in seconds"),
    "a table with a row too short": ((LOGIC_2 + '"I2C","data"\n').encode(), "line 10 is none of Saleae's table"),
    "a table of a UART": (b'name,type,start_time,duration,"data","error"\n"UART","data",0,0,0x41,\n', "neither an I2C"),
    "a broken digital export": (b"Time [s],SCL,SDA\n0.0,1,1\n0.1,1\n", "line 3 is none of Saleae's CSV"),
    "a sigrok CSV without its rate": (
        (SIGROK.replace("Samplerate", "-") + "1,1\n").encode(),
        "does not say its channels",
    ),
    "a broken sigrok CSV": ((SIGROK + "logic,logic\n1,1\n1\n").encode(), "line 7 is none of sigrok's CSV"),
    "a trace cut off": (
        (TRACE + "  x-1 [000] ..... 211.000000: i2c_write: i2c-1 #0 a=03c f=00").encode(),
        "line 14 is cut off",
    ),
    "a trace of two buses": (
        (TRACE + PERF.replace("i2c-1", "i2c-20")).encode(),
        "the trace is of buses 1, 20; say which",
    ),
    "nobody answers": (b"0.1 3c w nak\n", "no chip acknowledged anything that was written"),
}


@pytest.mark.parametrize("name", DAMAGED)
def test_a_damaged_file_is_one_line(tmp_path: Path, name: str) -> None:
    content, words = DAMAGED[name]
    (tmp_path / "file").write_bytes(content)
    with pytest.raises(ValueError, match=words) as caught:
        simulator.replay(tmp_path / "file", simulator.SSD1306())
    assert str(caught.value).startswith(f"{tmp_path / 'file'}: ")
    assert "\n" not in str(caught.value)


@pytest.mark.thorough
def test_a_zip_bomb_is_let_be(tmp_path: Path) -> None:
    (tmp_path / "bomb.sr").write_bytes(bomb())
    with pytest.raises(ValueError, match="more than 4 GiB of samples"):
        simulator.replay(tmp_path / "bomb.sr", simulator.SSD1306())


@given(st.data())
def test_bytes_turned_over_never_end_in_another_error(tmp_path: Path, data: st.DataObject) -> None:
    whole = data.draw(
        st.sampled_from([WHOLE, *(text.encode() for text in (LOGIC_2, LOGIC_1, TRACE, PULSEVIEW, SIGROK))])
    )
    content = bytearray(whole)
    for at, value in data.draw(st.lists(st.tuples(st.integers(0, len(whole) - 1), st.integers(0, 255)), max_size=5)):
        content[at] = value
    (tmp_path / "file").write_bytes(content[: data.draw(st.integers(0, len(whole)))])
    said = str(tmp_path)
    try:
        simulator.replay(tmp_path / "file", simulator.SSD1306())
    except ValueError as error:
        said = str(error)
    assert said.startswith(str(tmp_path))


def test_a_bus_of_a_trace_can_be_chosen(tmp_path: Path) -> None:
    (tmp_path / "trace").write_text(TRACE + PERF.replace("i2c-1", "i2c-20").replace("-a5-", "-a4-"))
    for bus, lit in ((1, True), (20, False)):
        chip = simulator.SSD1306()
        simulator.replay(tmp_path / "trace", chip, bus=bus)
        assert (int(chip.pixels.sum()) == 8192) == lit
