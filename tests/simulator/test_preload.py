"""Other people's programs, unchanged, on simulated buses: i2c-tools, C, smbus2, spidev, luma.oled, Blinka, shells."""

from __future__ import annotations

import contextlib
import errno
import os
import random
import shutil
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from paneldraw import simulator
from paneldraw.simulator import preload as preloading
from paneldraw.simulator.preload import Preload, PreloadUnavailableError

try:
    preloading.library()
except PreloadUnavailableError as error:
    pytest.skip(str(error), allow_module_level=True)

TOOLS = os.environ | {"PATH": os.environ["PATH"] + ":/usr/sbin:/sbin"}
ALONE = {name: value for name, value in os.environ.items() if not name.startswith("PANELDRAW")}


class Echo:
    """A device that notes what is written and reads the last of it back."""

    def __init__(self) -> None:
        self.log: list[bytes] = []

    def write(self, payload: bytes) -> None:
        self.log.append(payload)

    def read(self, length: int) -> bytes:
        return (self.log[-1] if self.log else b"").ljust(length, b"\0")[:length]

    def settle(self, seconds: float, wire_bytes: int) -> None:
        pass


class Desk:
    """Buses, what sits on them, and a way to run programs."""

    def __init__(self) -> None:
        self.chip, self.spi_chip, self.echo = simulator.SSD1306(), simulator.SSD1306(), Echo()
        self.i2c = simulator.I2CBus({0x3C: self.chip, 0x3D: simulator.SH1106()})
        self.i2c.claimed.add(0x68)
        self.spi = simulator.SPIBus(self.spi_chip)
        self.preload = Preload({1: self.i2c}, {(0, 0): self.spi}, {"/dev/ttyACM0": os.devnull})

    def run(self, *command: str, **environment: str) -> str:
        done = self.preload.run(command, env=TOOLS | environment, capture_output=True, text=True, timeout=60)
        assert done.returncode == 0, done.stdout + done.stderr
        return str(done.stdout)

    def python(self, script: str, **environment: str) -> str:
        return self.run(sys.executable, "-c", script, **environment)


@pytest.fixture
def desk() -> Iterator[Desk]:
    desk = Desk()
    with desk.preload:
        yield desk


def needs(*tools: str) -> pytest.MarkDecorator:
    missing = [tool for tool in tools if shutil.which(tool, path=TOOLS["PATH"]) is None]
    return pytest.mark.skipif(bool(missing), reason=f"no {', no '.join(missing)}")


@pytest.fixture(scope="module")
def bus_user(tmp_path_factory: pytest.TempPathFactory) -> str:
    if shutil.which("gcc") is None:
        pytest.skip("no gcc")
    return compiled(tmp_path_factory.mktemp("bus_user"), "gcc", "-pthread")


def compiled(folder: Path, *command: str) -> str:
    program = folder / "bus_user"
    source = Path(__file__).with_name("bus_user.c")
    subprocess.run([*command, "-O2", "-Wall", "-Werror", "-o", program, source], check=True)
    return str(program)


# -- i2c-tools


@needs("i2cdetect")
def test_i2cdetect_sees_the_panels_and_what_a_driver_holds(desk: Desk) -> None:
    rows = desk.run("i2cdetect", "-y", "1").splitlines()
    assert rows[4] == "30: -- -- -- -- -- -- -- -- -- -- -- -- 3c 3d -- -- "
    assert rows[7] == "60: -- -- -- -- -- -- -- -- UU -- -- -- -- -- -- -- "
    assert sum(row.count("--") for row in rows) == 112 - 3
    assert desk.run("i2cdetect", "-l").split() == ["i2c-1", "i2c", "simulated", "bus", "1", "I2C", "adapter"]
    functions = desk.run("i2cdetect", "-F", "1")
    assert [line.split()[-1] for line in functions.splitlines() if "Quick" in line or "PEC" in line] == ["yes", "no"]


@needs("i2cdetect")
def test_i2ctransfer_i2cset_and_i2cget(desk: Desk) -> None:
    assert desk.run("i2ctransfer", "-y", "1", "w3@0x3c", "0x00", "0x81", "0x40", "r1") == "0x43\n"
    assert desk.chip.contrast == 0x40
    desk.run("i2cset", "-y", "1", "0x3c", "0x00", "0xaf")
    assert desk.chip.registers.on
    assert desk.run("i2cget", "-y", "1", "0x3c") == "0x03\n"
    for number, address, said in (("1", "0x3e", "Read failed"), ("1", "0x68", "busy"), ("7", "0x3c", "No such file")):
        failed = desk.preload.run(["i2cget", "-y", number, address], env=TOOLS, capture_output=True, text=True)
        assert failed.returncode != 0
        assert said in failed.stderr


@needs("gpiodetect", "gpioset", "gpiofind")
def test_gpiodetect_and_gpioset(desk: Desk) -> None:
    assert desk.run("gpiodetect") == "gpiochip0 [pinctrl-bcm2711] (58 lines)\n"
    assert desk.run("gpiofind", "GPIO24") == "gpiochip0 24\n"
    assert not desk.spi.pins.get(24)
    desk.run("gpioset", "gpiochip0", "24=1")
    assert desk.spi.pins.get(24)


# -- C


@pytest.mark.parametrize("way", ["threads", "forks"])
def test_threads_and_processes_that_share_a_descriptor(desk: Desk, bus_user: str, way: str) -> None:
    desk.i2c.devices[0x3C] = desk.echo
    desk.run(bus_user, way)
    assert sorted(desk.echo.log) == sorted(bytes((name, number)) for name in range(8) for number in range(100))


@pytest.mark.parametrize(
    ("machine", "emulator", "way"),
    [
        ("arm-linux-gnueabihf", "qemu-arm-static", "forks"),
        pytest.param("arm-linux-gnueabihf", "qemu-arm-static", "lines", marks=pytest.mark.thorough),
        pytest.param("aarch64-linux-gnu", "qemu-aarch64-static", "forks", marks=pytest.mark.thorough),
        pytest.param("aarch64-linux-gnu", "qemu-aarch64-static", "lines", marks=pytest.mark.thorough),
    ],
)
def test_on_machines_of_32_and_64_bits(desk: Desk, tmp_path: Path, machine: str, emulator: str, way: str) -> None:
    compiler = f"{machine}-gcc"
    if shutil.which(compiler) is None or shutil.which(emulator) is None:
        pytest.skip(f"no {compiler} or no {emulator}")
    desk.i2c.devices[0x3C] = desk.echo
    flags = ["-O2", "-fPIC", "-shared", "-fvisibility=hidden", "-Wall", "-Wextra", "-Wconversion", "-Werror"]
    source = Path(preloading.__file__).with_name("preload.c")
    library = tmp_path / "preload.so"
    subprocess.run([compiler, *flags, "-o", library, source, "-ldl", "-lpthread"], check=True)
    program = compiled(tmp_path, compiler, "-pthread")
    folder = desk.preload.environment()["PANELDRAW_PRELOAD"]
    inside = ["-L", f"/usr/{machine}", "-E", f"LD_PRELOAD={library}", "-E", f"PANELDRAW_PRELOAD={folder}"]
    done = subprocess.run([emulator, *inside, program, way], capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr
    assert done.stdout == ("1000000 4\n" if way == "lines" else "")
    assert len({bytes(message) for message in desk.echo.log}) == (800 if way == "forks" else 0)


def test_descriptors_that_are_duplicated_closed_and_inherited(desk: Desk, bus_user: str) -> None:
    desk.i2c.devices[0x3C] = desk.echo
    assert desk.run(bus_user, "duplicates") == "11 22 1\n"


def test_what_c_finds_in_a_folder(desk: Desk, bus_user: str) -> None:
    assert desk.run(bus_user, "looks").split() == ["gpiochip0", "i2c-1", "/dev/i2c-1"]


def test_spi_and_lines_from_c(desk: Desk, bus_user: str) -> None:
    desk.spi_chip.write(b"\x00\x8d\x14")
    assert desk.run(bus_user, "lines") == "1000000 4\n"
    assert desk.spi_chip.pixels.all()
    assert desk.spi_chip.violations == []
    assert desk.spi.messages == 2


# -- Python


def test_smbus2(desk: Desk) -> None:
    script = """if True:
        import smbus2
        with smbus2.SMBus(1) as bus:
            bus.write_i2c_block_data(0x3C, 0, [0x8D, 0x14, 0xA5, 0xAF])
            assert bus.read_byte(0x3C) & 0x40 == 0
            try:
                bus.write_quick(0x3E)
            except OSError as error:
                print(error.errno)
        """
    assert desk.python(script) == "121\n"
    assert desk.chip.pixels.all()


SPIDEV = """if True:
    import gpiod, spidev
    from gpiod.line import Direction, Value
    spi = spidev.SpiDev(0, 0)
    spi.max_speed_hz = 4_000_000
    with gpiod.Chip("/dev/gpiochip0") as chip:
        out = gpiod.LineSettings(direction=Direction.OUTPUT)
        lines = chip.request_lines({24: out, 25: out}, consumer="test")
        assert chip.get_line_info(24).consumer == "test"
    lines.set_values({25: Value.ACTIVE, 24: Value.INACTIVE})
    assert spi.xfer2([0x8D, 0x14, 0x20, 0x00, 0xAF]) == [0] * 5
    lines.set_value(24, Value.ACTIVE)
    spi.writebytes2(bytes([0x55]) * 1024)
    print(spi.mode, spi.max_speed_hz, spi.bits_per_word)
"""


def test_spidev_and_gpiod(desk: Desk) -> None:
    pytest.importorskip("spidev")
    assert desk.python(SPIDEV) == "0 4000000 8\n"
    assert np.array_equal(desk.spi_chip.pixels, np.tile([[0], [1]], (32, 128)))


LUMA = """if True:
    from luma.core.interface.serial import {wire}
    from luma.core.render import canvas
    from luma.oled.device import ssd1306
    {lines}
    device = ssd1306({made})
    device.cleanup = lambda: None
    with canvas(device) as draw:
        draw.rectangle((0, 0, 63, 31), fill="white")
"""
LINES = """
    import gpiod
    from gpiod.line import Direction, Value
    class GPIO:
        OUT = HIGH = 1
        LOW = 0
        lines = gpiod.request_lines("/dev/gpiochip0", config={(24, 25): gpiod.LineSettings(direction=Direction.OUTPUT)})
        def setup(self, *settings): pass
        def output(self, line, value): self.lines.set_value(line, Value.ACTIVE if value else Value.INACTIVE)
        def cleanup(self, *lines): pass
"""


@pytest.mark.parametrize("wire", ["i2c", "spi"])
def test_a_script_on_luma_oled(desk: Desk, wire: str) -> None:
    pytest.importorskip("luma.oled")
    if wire == "spi":
        pytest.importorskip("spidev")
    made, lines = {"i2c": ("i2c(port=1, address=0x3C)", ""), "spi": ("spi(gpio=GPIO())", LINES)}[wire]
    desk.python(LUMA.format(wire=wire, made=made, lines=lines))
    chip = desk.chip if wire == "i2c" else desk.spi_chip
    assert chip.pixels[:32, :64].all()
    assert chip.pixels.sum() == 64 * 32
    assert chip.violations == []


BLINKA = """if True:
    import adafruit_ssd1306, board, busio
    wire = busio.I2C(board.SCL, board.SDA)
    panel = adafruit_ssd1306.SSD1306_I2C(128, 64, wire)
    panel.fill_rect(0, 0, 10, 10, 1)
    panel.show()
    wire.try_lock()
    print(wire.scan())
"""


def test_a_script_on_adafruit_blinka(desk: Desk) -> None:
    pytest.importorskip("adafruit_ssd1306")
    board = {"BLINKA_FORCEBOARD": "RASPBERRY_PI_4B", "BLINKA_FORCECHIP": "BCM2XXX"}
    assert desk.python(BLINKA, **board) == "[60, 61]\n"
    assert desk.chip.pixels[:10, :10].all()
    assert desk.chip.pixels.sum() == 100


def test_our_own_command(desk: Desk) -> None:
    found = desk.run(sys.executable, "-m", "paneldraw", "detect")
    assert "bus 1 (simulated bus 1): 3c answers" in found
    assert "68 is in use by a driver of the kernel" in found
    assert "serial port /dev/ttyACM0" in found
    desk.run(sys.executable, "-m", "paneldraw", "text", "Hi", "--panel", "i2c://1/0x3c?chip=ssd1306&on_close=keep")
    assert desk.chip.pixels.any()
    assert desk.chip.violations == []


def test_our_own_spi_transport(desk: Desk) -> None:
    pytest.importorskip("spidev")
    pytest.importorskip("gpiod")
    url = "spi://0.0?chip=ssd1306&dc=24&reset=25&on_close=keep"
    desk.run(sys.executable, "-m", "paneldraw", "text", "Hi", "--panel", url)
    assert desk.spi_chip.pixels.any()
    assert desk.spi_chip.violations == []


# -- What programs look at


@needs("bash")
def test_a_shell_sets_lines_through_sysfs(desk: Desk) -> None:
    driven: list[bool] = []
    desk.preload.gpio.lines[4].wires.append(driven.append)
    script = """
        cd /sys/class/gpio || exit
        echo 4 > export && echo out > gpio4/direction && echo 1 > gpio4/value && cat gpio4/value gpio4/direction
        echo 0 > gpio4/value; read value < gpio4/value; echo $value
        echo 4 > unexport; ls -d gpio*
    """
    assert desk.run("bash", "-c", script).split() == ["1", "out", "0", "gpiochip0"]
    assert driven == [False, True, False]


def test_listings_have_the_simulated_devices_and_not_the_machines_own(desk: Desk) -> None:
    script = """if True:
        import glob, os, stat
        from pathlib import Path
        names = sorted(name for name in os.listdir("/dev") if name.startswith(("i2c-", "spidev", "gpiochip", "ttyACM")))
        about = os.stat("/dev/i2c-1")
        print(*names, *glob.glob("/dev/i2c-*"), stat.S_ISCHR(about.st_mode), os.major(about.st_rdev))
        print(Path("/sys/class/i2c-dev/i2c-1/name").read_text(), os.path.exists("/dev/i2c-0"), end="")
        print(os.path.realpath("/sys/dev/char/254:0/subsystem"), os.path.exists("/dev/null"))
        print(os.listdir("/sys/class/spidev"))
        """
    names, *rest = desk.python(script).splitlines()
    assert names == "gpiochip0 i2c-1 spidev0.0 ttyACM0 /dev/i2c-1 True 89"
    assert rest == ["simulated bus 1", " False/sys/bus/gpio True", "['spidev0.0']"]
    assert desk.run("sh", "-c", "cd /dev; ls -l i2c-1 | cut -c1; ls i2c*").split() == ["c", "i2c-1"]


def test_a_serial_port_is_a_pty() -> None:
    ours, theirs = os.openpty()
    try:
        with Preload(serial={"/dev/ttyACM0": os.ttyname(theirs)}) as preload:
            script = "import serial; serial.Serial('/dev/ttyACM0', 115200).write(b'hello')"
            preload.run([sys.executable, "-c", script], check=True, timeout=60)
            assert os.read(ours, 100) == b"hello"
    finally:
        os.close(ours)
        os.close(theirs)


# -- What cannot work


def test_what_no_library_can_be_loaded_into_says_so(desk: Desk, bus_user: str, tmp_path: Path) -> None:
    static = compiled(tmp_path, "gcc", "-static", "-pthread")
    with pytest.raises(PreloadUnavailableError, match=r"bus_user is linked statically.*LD_PRELOAD.*another build"):
        desk.preload.run([static, "threads"])
    script = tmp_path / "script"
    script.write_text(f"#!{static}\n")
    script.chmod(0o755)
    with pytest.raises(PreloadUnavailableError, match="statically"):
        desk.preload.popen([str(script)])
    special = tmp_path / "special"
    shutil.copy(bus_user, special)
    special.chmod(0o4755)
    with pytest.raises(PreloadUnavailableError, match="set-user-ID"):
        desk.preload.run([str(special)])
    with pytest.raises(FileNotFoundError):
        desk.preload.run(["no-such-program"])


@pytest.mark.parametrize(
    ("compiler", "complaint"),
    [
        ("musl-gcc", "musl"),
        ("aarch64-linux-gnu-gcc", "another kind of processor"),
        ("arm-linux-gnueabihf-gcc", "width"),
    ],
)
def test_programs_of_another_kind_say_so(desk: Desk, tmp_path: Path, compiler: str, complaint: str) -> None:
    if shutil.which(compiler) is None:
        pytest.skip(f"no {compiler}")
    source = tmp_path / "empty.c"
    source.write_text("int main(void) { return 0; }\n")
    subprocess.run([compiler, "-o", tmp_path / "empty", source], check=True)
    with pytest.raises(PreloadUnavailableError, match=complaint):
        desk.preload.run([str(tmp_path / "empty")])


def test_elsewhere_and_without_the_library_it_says_what_to_do(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    with monkeypatch.context() as patch:
        patch.setattr(sys, "platform", "darwin")
        with pytest.raises(PreloadUnavailableError, match=r"need Linux.*sim://"):
            Preload().__enter__()
    monkeypatch.setattr(preloading, "__file__", str(tmp_path / "preload.py"))
    with pytest.raises(PreloadUnavailableError, match="install a C compiler"):
        Preload().__enter__()


def test_a_folder_that_does_not_suit(tmp_path: Path) -> None:
    with pytest.raises(PreloadUnavailableError, match="without spaces"):
        Preload(folder=tmp_path / "a b").__enter__()
    assert not (tmp_path / "a b").exists()
    with pytest.raises(ValueError, match="not a path below /dev"):
        Preload(serial={"/tmp/port": "/dev/null"})
    with pytest.raises(RuntimeError, match="with block"):
        Preload().environment()


# -- What goes wrong


def descriptors() -> set[str]:
    return set(os.listdir("/proc/self/fd"))


def test_a_killed_child_leaves_nothing(bus_user: str) -> None:
    before, threads = descriptors(), threading.active_count()
    desk = Desk()
    desk.i2c.devices[0x3C] = desk.echo
    with desk.preload as preload:
        folder = preload.environment()["PANELDRAW_PRELOAD"]
        for _ in range(5):
            child = preload.popen([bus_user, "sleeps"], stdout=subprocess.PIPE)
            assert child.stdout is not None
            child.stdout.readline()
            child.kill()
            child.communicate()
        assert desk.python("import smbus2; print(smbus2.SMBus(1).read_byte(0x3D))")
    assert threading.active_count() == threads
    assert descriptors() == before
    assert not os.path.exists(folder)
    preload.close()


def test_the_end_of_the_server_is_an_adapter_that_is_gone(desk: Desk) -> None:
    script = "import smbus2; b = smbus2.SMBus(1); print(b.read_byte(0x3D), flush=True); input(); b.read_byte(0x3D)"
    child = desk.preload.popen(
        [sys.executable, "-c", script], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    assert child.stdout is not None
    child.stdout.readline()
    desk.preload.close()
    _, said = child.communicate("\n", timeout=60)
    assert f"[Errno {errno.ENODEV}]" in said


def test_nonsense_on_the_socket_ends_that_connection_alone(desk: Desk) -> None:
    path = desk.preload.environment()["PANELDRAW_PRELOAD"] + "/socket"
    chance = random.Random(1)
    for round_ in range(60):
        with socket.socket(socket.AF_UNIX) as nobody:
            nobody.settimeout(10)
            if round_ % 3:
                nobody.bind("")  # a name of the kernel's choice, as preload.c asks for
            nobody.connect(path)
            head = b"".join(chance.choice((0, 4, 12, 500, 1 << 31)).to_bytes(4, "little") for _ in range(3))
            with contextlib.suppress(BrokenPipeError):  # of one without a name the server has heard enough
                nobody.sendall(head[: chance.choice((3, 12))] + chance.randbytes(chance.choice((0, 4, 90))))
    assert desk.python("import smbus2; print(smbus2.SMBus(1).read_byte(0x3D))")
    deadline = time.monotonic() + 10
    while len(desk.preload._server._devices) and time.monotonic() < deadline:  # type: ignore[union-attr]
        time.sleep(0.01)
    assert desk.preload._server._devices == {}  # type: ignore[union-attr]


def test_faults_reach_the_program(desk: Desk) -> None:
    desk.i2c.fail(errno.ETIMEDOUT, after=1)
    script = """if True:
        import smbus2
        for _ in range(3):
            try:
                smbus2.SMBus(1).write_byte_data(0x3C, 0, 0xAF)
                print("done")
            except OSError as error:
                print(error.errno)
        """
    assert desk.python(script).split() == ["done", str(errno.ETIMEDOUT), "done"]
