"""Programs that find simulated panels where they look for devices, and what they showed there."""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import IO, Final

from paneldraw.simulator.rig import Rig, RigPanel

Command = str | os.PathLike[str] | Sequence[str | os.PathLike[str]]

_POLL: Final = 0.005
_PATIENCE: Final = 5.0
"""Seconds that a program has to end after SIGTERM."""
_TAIL: Final = 2000
"""Characters of what a program wrote that an error shows."""


class Program:
    """A program that runs, or ran, with simulated panels; a context manager that stops it.

    Attributes
    ----------
    panels : list of paneldraw.simulator.rig.RigPanel
        The simulated panels, each with its ``chip`` and ``bus``.
    process : subprocess.Popen
    """

    def __init__(self, command: Command, run: SimRun, cwd: Path | str | None, env: Mapping[str, str] | None) -> None:
        self.panels = run.panels
        self.command = _arguments(command)
        self._swept = False
        self._files: list[IO[bytes]] = [tempfile.TemporaryFile() for _ in range(2)]  # noqa: SIM115 - closed by `close`
        first = {"PANELDRAW_PANEL": self.panels[0].url} if self.panels else {}
        try:
            self.process: subprocess.Popen[bytes] = run._preload.popen(
                self.command,
                stdin=subprocess.DEVNULL,
                stdout=self._files[0],
                stderr=self._files[1],
                cwd=cwd,
                env={**os.environ, **first, **(env or {})},
                start_new_session=True,
            )
        except BaseException:
            self._shut()
            raise

    @property
    def panel(self) -> RigPanel:
        """The panel, where there is but one."""
        return _only(self.panels)

    @property
    def stdout(self) -> str:
        """What it wrote until now."""
        return self._written(0)

    @property
    def stderr(self) -> str:
        """What it wrote to standard error until now."""
        return self._written(1)

    @property
    def returncode(self) -> int | None:
        """The exit code; negative, the signal that ended it; None while it runs."""
        return self.process.poll()

    def wait(self, timeout: float = 60) -> int:
        """Wait for its end and return the exit code; after so many seconds it is killed, and TimeoutError raised."""
        try:
            return self.process.wait(timeout)
        except subprocess.TimeoutExpired:
            self.kill()
            raise TimeoutError(self._told(f"did not end within {timeout:g} s")) from None

    def wait_until(self, condition: Callable[[], object], timeout: float = 10) -> None:
        """Wait until something is true, such as ``lambda: len(frames_of(program)) > 3``.

        Raises
        ------
        TimeoutError
            It is still false after so many seconds.
        RuntimeError
            The program has ended, and it is still false.
        """
        until = time.monotonic() + timeout
        while True:
            ended = self.returncode is not None
            if condition():
                return
            if ended:
                raise RuntimeError(self._told(f"ended with exit code {self.returncode} before what was waited for"))
            if time.monotonic() > until:
                raise TimeoutError(self._told(f"did not do what was waited for within {timeout:g} s"))
            time.sleep(_POLL)

    def stop(self) -> int:
        """End it by SIGTERM, or else kill it, with all that it started; return the exit code."""
        if self.process.poll() is None:
            self._signal(signal.SIGTERM)
            with contextlib.suppress(subprocess.TimeoutExpired):
                self.process.wait(_PATIENCE)
        return self.kill()

    def kill(self) -> int:
        """Kill it, with all that it started; return the exit code."""
        if not self._swept:
            self._signal(signal.SIGKILL)
            self._swept = True  # its number may be another's now
        return self.process.wait()

    def close(self) -> None:
        """Stop it, and forget what it wrote."""
        self.stop()
        self._shut()

    def __enter__(self) -> Program:
        return self

    def __exit__(self, *exception: object) -> None:
        self.stop()

    def __repr__(self) -> str:
        return f"<Program {' '.join(self.command)}, exit code {self.returncode}>"

    # inside

    def _signal(self, number: int) -> None:
        with contextlib.suppress(ProcessLookupError, PermissionError):  # its session is its own
            os.killpg(self.process.pid, number)

    def _shut(self) -> None:
        for file in self._files:
            file.close()

    def _written(self, which: int) -> str:
        handle = self._files[which].fileno()  # not moved: the program writes where the file stands
        return os.pread(handle, os.fstat(handle).st_size, 0).decode(errors="replace")

    def _told(self, what: str) -> str:
        wrote = (self.stdout + self.stderr)[-_TAIL:].strip() or "nothing"
        return f"{' '.join(self.command)} {what}; it wrote:\n{wrote}"


class SimRun:
    """Runs programs that find simulated panels in place of ``/dev/i2c-1`` and the like; what the fixture hands out.

    Calling it runs a program to its end. A path that ends in ``.py`` is a script for this Python. Where panels are,
    ``PANELDRAW_PANEL`` names the first.

    Parameters
    ----------
    where : str or iterable of str
        What `open_panel` takes for each panel: ``i2c://1/0x3c?chip=ssd1306``, say.

    Attributes
    ----------
    panels : list of paneldraw.simulator.rig.RigPanel
        The simulated panels, each with its ``chip`` and ``bus``. They live on from program to program.
    """

    def __init__(self, where: str | Iterable[str] = "i2c://1/0x3c?chip=ssd1306") -> None:
        with contextlib.ExitStack() as unless_done:
            rig = unless_done.enter_context(Rig([where] if isinstance(where, str) else where))
            self._preload = unless_done.enter_context(rig.preload())
            self._open = unless_done.pop_all()
        self.panels = rig.panels

    @property
    def panel(self) -> RigPanel:
        """The panel, where there is but one."""
        return _only(self.panels)

    def __call__(
        self,
        command: Command,
        *,
        timeout: float = 60,
        cwd: Path | str | None = None,
        env: Mapping[str, str] | None = None,
    ) -> Program:
        """Run a program to its end.

        Parameters
        ----------
        command : path or sequence of str
            A script, or a program and its arguments.
        timeout : float
            Seconds after which it is killed and TimeoutError raised. Default: 60.
        cwd : path, optional
            Where it runs.
        env : mapping, optional
            What its environment has beside that of the test.
        """
        program = self.start(command, cwd=cwd, env=env)
        program.wait(timeout)
        return program

    def start(
        self, command: Command, *, cwd: Path | str | None = None, env: Mapping[str, str] | None = None
    ) -> Program:
        """Start a program and go on; it is stopped at the end of the test, or of its own ``with`` block."""
        program = Program(command, self, cwd, env)
        self._open.callback(program.close)
        return program

    def close(self) -> None:
        """End all programs and unplug all panels."""
        self._open.close()

    def __enter__(self) -> SimRun:
        return self

    def __exit__(self, *exception: object) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"<SimRun of {', '.join(panel.url for panel in self.panels) or 'no panels'}>"


def _arguments(command: Command) -> list[str]:
    parts = [command] if isinstance(command, (str, os.PathLike)) else list(command)
    texts = [os.fspath(part) for part in parts]
    return [sys.executable, *texts] if texts and texts[0].endswith(".py") else texts


def _only(panels: list[RigPanel]) -> RigPanel:
    if len(panels) != 1:
        raise ValueError(f"there are {len(panels)} panels: take one of .panels")
    return panels[0]
