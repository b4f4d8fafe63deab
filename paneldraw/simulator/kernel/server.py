"""The other end of preload.c: a socket through which programs open simulated devices and make calls on them.

A request is three numbers, how many bytes follow, the device's handle, and what to do, and those bytes; a reply is how
many bytes follow, the call's result or the error's number below zero, and those bytes. All in the machine's own order.
"""

from __future__ import annotations

import contextlib
import errno
import selectors
import socket
import struct
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final, Protocol

from ..wire import os_error
from .gpio import CLAIMS, GPIOChip, SysfsFile

_OPEN, _OPEN_STREAM, _READ, _WRITE, _DO, _NAME = range(6)
"""What a program wants, in the order of preload.c's ``operation``."""
_REQUEST: Final = struct.Struct("=III")
_REPLY: Final = struct.Struct("=Ii")
_IOCTL: Final = struct.Struct("=IIQ")
_MOST: Final = (1 << 20) + (1 << 16)
"""Bytes that may follow: what preload.c lets through at most, and its heads."""
_ROOM: Final = 1 << 16
_PAUSE: Final = 0.01
_PATIENCE: Final = 5.0
"""Seconds that a call may go on for when the server is closed: a device that never ends it keeps nobody."""
_MOST_NAME: Final = 4096
_MOST_CONNECTIONS: Final = 1000


class File(Protocol):
    """An open file of a device."""

    def read(self, length: int) -> bytes:
        """Do what read does."""

    def write(self, payload: bytes) -> int:
        """Do what write does."""

    def ioctl(self, request: int, value: int, argument: bytes) -> tuple[int, bytes]:
        """Do what ioctl does; return its result, and what goes back."""

    def close(self) -> None:
        """Note that the last descriptor is closed."""


@dataclass
class _Device:
    """A connection that stands for an open device."""

    connection: socket.socket
    name: str = ""
    file: File | None = None


class Server:
    """A thread that takes connections, and one for each thread of a program that makes calls.

    Parameters
    ----------
    path : str
        Of the socket.
    open_file : callable
        Opens what has a name, or raises OSError.
    """

    def __init__(self, path: str, open_file: Callable[[str], File]) -> None:
        self._open_file = open_file
        self._devices: dict[int, _Device] = {}
        self._callers: dict[socket.socket, threading.Thread] = {}
        self._texts = 0
        """How many of the devices are files that take text."""
        self._lock = threading.RLock()
        self._listener = socket.socket(socket.AF_UNIX)
        self._listener.bind(path)
        self._listener.listen(128)
        self._wake, self._woken = socket.socketpair()
        self._selector = selectors.DefaultSelector()
        for end in (self._listener, self._woken):
            end.setblocking(False)
            self._selector.register(end, selectors.EVENT_READ, 0)
        self._thread = threading.Thread(target=self._run, name="paneldraw preload", daemon=True)
        self._thread.start()

    def close(self) -> None:
        """End all connections and threads."""
        self._wake.close()
        self._thread.join()
        with self._lock:
            callers = dict(self._callers)
        for connection, thread in callers.items():
            with contextlib.suppress(OSError):
                connection.shutdown(socket.SHUT_RDWR)
            thread.join(_PATIENCE)
        for handle in list(self._devices):
            self._forget(handle)
        self._selector.close()
        for end in (self._listener, self._woken):
            end.close()

    # connections

    def _run(self) -> None:
        while True:
            for key, _ in self._selector.select():
                if key.fileobj is self._woken:
                    return
                if key.fileobj is self._listener:
                    self._accept()
                elif device := self._devices.get(key.data):  # unless a caller's thread has found its end already
                    self._hear(key.data, device)

    def _accept(self) -> None:
        try:
            connection, name = self._listener.accept()
        except OSError:
            time.sleep(_PAUSE)  # no descriptor is free, perhaps
            return
        if isinstance(name, bytes) and len(name) == 6 and len(self._devices) < _MOST_CONNECTIONS:
            with contextlib.suppress(ValueError):
                handle = int(name[1:], 16) + 1
                connection.setblocking(False)
                self._devices[handle] = _Device(connection)
                self._selector.register(connection, selectors.EVENT_READ, handle)
                return
        connection.close()

    def _hear(self, handle: int, device: _Device) -> None:
        """Take the first request of a connection, or what comes later: the end, or text for a line."""
        if device.name:
            self._take_text(handle, device)
            return
        try:
            head = device.connection.recv(_REQUEST.size, socket.MSG_PEEK)
        except OSError:
            head = b""
        if len(head) < _REQUEST.size:
            self._forget(handle)
        elif _REQUEST.unpack(head)[2] in (_OPEN, _OPEN_STREAM):
            self._open(handle, device)
        else:
            self._devices.pop(handle)
            self._selector.unregister(device.connection)
            device.connection.setblocking(True)
            thread = threading.Thread(
                target=self._answer, args=(device.connection,), name="paneldraw preload caller", daemon=True
            )
            with self._lock:
                self._callers[device.connection] = thread
            thread.start()

    def _open(self, handle: int, device: _Device) -> None:
        self._take_texts()
        try:
            message = device.connection.recv(_REQUEST.size + _MOST_NAME)
            length, _, operation = _REQUEST.unpack_from(message)
            name = message[_REQUEST.size :].decode()
            if len(message) != _REQUEST.size + length:
                raise os_error(errno.ENAMETOOLONG)
            if name != "lines":  # which somebody's claim will follow for
                device.file = self._open_file(name)
                self._texts += isinstance(device.file, SysfsFile)
            device.name = name
            reply = _REPLY.pack(0, 0)
            if operation == _OPEN_STREAM and isinstance(device.file, SysfsFile):
                reply += device.file.read(_MOST_NAME)
            device.connection.sendall(reply)
            if operation == _OPEN_STREAM:
                device.connection.shutdown(socket.SHUT_WR)
        except UnicodeDecodeError:
            self._refuse(handle, device, errno.ENOENT)
        except OSError as error:
            self._refuse(handle, device, error.errno or errno.EIO)

    def _refuse(self, handle: int, device: _Device, code: int) -> None:
        with contextlib.suppress(OSError):
            device.connection.sendall(_REPLY.pack(0, -code))
        self._forget(handle)

    def _forget(self, handle: int) -> None:
        device = self._devices.pop(handle)
        self._selector.unregister(device.connection)
        device.connection.close()
        if device.file is not None:
            self._texts -= isinstance(device.file, SysfsFile)
            device.file.close()

    def _take_text(self, handle: int, device: _Device) -> None:
        """Take what a program wrote to a line's file without preload.c, as a shell's ``echo`` does, or its end."""
        with self._lock:
            if handle not in self._devices:
                return
            try:
                text = device.connection.recv(_MOST_NAME)
            except BlockingIOError:
                return
            except OSError:
                text = b""
            if not text:
                self._forget(handle)
            elif isinstance(device.file, SysfsFile):
                with contextlib.suppress(OSError):
                    device.file.write(text)

    def _take_texts(self) -> None:
        """Take all that was written before the present request."""
        if not self._texts:
            return
        with self._lock:
            for handle, device in list(self._devices.items()):
                if isinstance(device.file, SysfsFile):
                    self._take_text(handle, device)

    # calls

    def _answer(self, connection: socket.socket) -> None:
        try:
            with connection, contextlib.suppress(ConnectionError):
                buffer = memoryview(bytearray(_ROOM))
                while (request := _received(connection, buffer)) is not None:
                    connection.sendall(self._reply(*request))
        finally:
            with self._lock:
                self._callers.pop(connection, None)

    def _reply(self, handle: int, operation: int, payload: bytes) -> bytes:
        try:
            result, answer = self._do(handle, operation, payload)
        except OSError as error:
            result, answer = -(error.errno or errno.EIO), b""
        except (ValueError, IndexError, struct.error):  # what no program of ours would send
            result, answer = -errno.EINVAL, b""
        return _REPLY.pack(len(answer), result) + answer

    def _do(self, handle: int, operation: int, payload: bytes) -> tuple[int, bytes]:
        self._take_texts()
        device = self._devices.get(handle)
        if device is None or device.file is None:
            raise os_error(errno.ENODEV)
        file = device.file
        if operation == _DO:
            request, _, value = _IOCTL.unpack_from(payload)
            argument = payload[_IOCTL.size :]
            if request in CLAIMS and isinstance(file, GPIOChip):
                return self._claim(file, request, value, argument)
            return file.ioctl(request, value, argument)
        if operation == _WRITE:
            return file.write(payload), b""
        if operation == _READ:
            answer = file.read(*struct.unpack("=I", payload))
            return len(answer), answer
        if operation == _NAME:
            return len(device.name), device.name.encode()
        raise ValueError(f"operation {operation}")

    def _claim(self, chip: GPIOChip, request: int, handle: int, argument: bytes) -> tuple[int, bytes]:
        device = self._devices.get(handle)
        if device is None or device.file is not None:
            raise ValueError(f"handle {handle}")
        device.file = chip.claim(request, argument)
        return 0, b""


def _received(connection: socket.socket, buffer: memoryview) -> tuple[int, int, bytes] | None:
    """Receive one request: handle, operation, and what follows. None at the end, or where there is nonsense."""
    got = connection.recv_into(buffer)
    if got < _REQUEST.size:
        return None
    length, handle, operation = _REQUEST.unpack_from(buffer)
    payload = buffer[_REQUEST.size : got].tobytes()
    missing = length - len(payload)
    if length > _MOST or missing < 0:
        return None
    if missing:
        pieces = [payload]
        while missing:
            piece = connection.recv(min(missing, _ROOM))
            if not piece:
                return None
            pieces.append(piece)
            missing -= len(piece)
        payload = b"".join(pieces)
    return handle, operation, payload
