"""Runs a command on a real kernel: user-mode Linux, a program of Debian's, on this machine's own files, read-only.

Its I2C bus 1 is played by whoever opens /dev/simulated-adapter: adapter.c.
"""

from __future__ import annotations

import ctypes
import os
import shutil
import subprocess
import sys
from pathlib import Path

KERNEL = "linux.uml"
MODULES = Path("/usr/lib/uml/modules")
DRIVERS = "kernel/drivers"
ADAPTER = "/dev/simulated-adapter"
MAJOR = 240
POWER_OFF = 0x4321FEDC
COMPILE = (
    *("gcc", "-c", "-O2", "-w", "-ffreestanding", "-fno-pic", "-mcmodel=large", "-mno-red-zone", "-mgeneral-regs-only"),
    *("-fno-stack-protector", "-fcf-protection=none", "-fno-asynchronous-unwind-tables"),
)


def missing():
    """What is not there that this needs; nothing if all is."""
    needed = [tool for tool in (KERNEL, "gcc", "objcopy", "ld") if shutil.which(tool) is None]
    return f"no {', no '.join(needed)}" if needed else ""


def run(command, folder, **environment):
    """Run a command there; return its exit status, None where that kernel did not start, and what was printed."""
    (modules,) = MODULES.iterdir()
    _build(modules / DRIVERS / "i2c/i2c-stub.ko", folder)
    init = folder / "init"
    words = [sys.executable, __file__, str(folder), str(modules), *command]
    settings = "".join(f"export {name}='{value}'\n" for name, value in environment.items())
    init.write_text(f"#!/bin/sh\ncd '{os.getcwd()}'\n{settings}exec '" + "' '".join(words) + "'\n")
    init.chmod(0o755)
    machine = [KERNEL, "mem=768M", "root=/dev/root", "rootfstype=hostfs", "rootflags=/", "ro", f"init={init}"]
    console = subprocess.run(
        [*machine, "con=null", "con0=null,fd:1", f"uml_dir={folder}/"],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        env=os.environ | {"TMPDIR": str(folder), "HOME": str(folder)},
        timeout=280,
    )
    output, status = folder / "output", folder / "status"
    if not output.exists():
        return None, console.stdout.decode(errors="replace")
    return int(status.read_text()) if status.exists() else -1, output.read_text(errors="replace")


def _build(stub, folder):
    """Make the adapter's module."""
    source = Path(__file__).with_name("adapter.c")
    subprocess.run([*COMPILE, "-o", "adapter.o", source], cwd=folder, check=True)
    change = ["--strip-debug", "--globalize-symbol=stub_adapter"]
    change += ["--weaken-symbol=init_module", "--weaken-symbol=cleanup_module"]
    subprocess.run(["objcopy", *change, stub, "stub.o"], cwd=folder, check=True)
    subprocess.run(["ld", "-r", "-o", "adapter.ko", "adapter.o", "stub.o"], cwd=folder, check=True)


def _inside(folder, modules, command):
    """What runs there as the first process."""
    libc = ctypes.CDLL(None, use_errno=True)
    try:
        _mount(libc, "proc", "/proc")
        _mount(libc, "sysfs", "/sys")
        _mount(libc, "tmpfs", "/run")
        _mount(libc, "hostfs", folder, folder)
        with open(f"{folder}/output", "wb", buffering=0) as output:
            try:
                _load(libc, modules, folder)
                settings = {"PYTHONDONTWRITEBYTECODE": "1", "TMPDIR": "/run"}
                done = subprocess.run(command, stdout=output, stderr=output, env=os.environ | settings)
                Path(folder, "status").write_text(str(done.returncode))
            except OSError as error:
                output.write(f"{error}\n".encode())
    finally:
        os.sync()
        libc.reboot(POWER_OFF)


def _load(libc, modules, folder):
    drivers = Path(modules, DRIVERS)
    for module in ("i2c/i2c-core.ko", "i2c/i2c-dev.ko", f"{folder}/adapter.ko", "misc/ds1682.ko"):
        with open(drivers / module, "rb") as file:
            _check(libc.syscall(313, file.fileno(), b"", 0), module)  # finit_module
    os.mknod(ADAPTER, 0o20600, os.makedev(MAJOR, 0))
    Path("/sys/bus/i2c/devices/i2c-0/new_device").write_text("ds1682 0x6b")
    os.rename("/dev/i2c-0", "/dev/i2c-1")


def _mount(libc, kind, place, options=""):
    _check(libc.mount(kind.encode(), place.encode(), kind.encode(), 0, options.encode()), place)


def _check(result, what):
    if result:
        code = ctypes.get_errno()
        raise OSError(code, f"{what}: {os.strerror(code)}")


if __name__ == "__main__":
    _inside(*sys.argv[1:3], sys.argv[3:])
