"""A driver as MicroPython's are: a FrameBuffer that shows itself, on I2C and on SPI. It imports MicroPython's names."""

import time

import framebuf
from micropython import const

_COLUMNS = const(0x21)
_PAGES = const(0x22)


class Panel(framebuf.FrameBuffer):
    def __init__(self, width, height):
        self.width = width
        self.height = height
        self.buffer = bytearray(width * height // 8)
        super().__init__(self.buffer, width, height, framebuf.MONO_VLSB)
        for command in (0xAE, 0x20, 0x00, 0x40, 0xA1, 0xA8, height - 1, 0xC8, 0xD3, 0x00, 0xDA, 0x12, 0x8D, 0x14, 0xAF):
            self.write_cmd(command)
        self.fill(0)
        self.show()

    def show(self):
        for command in (_COLUMNS, 0, self.width - 1, _PAGES, 0, self.height // 8 - 1):
            self.write_cmd(command)
        self.write_data(self.buffer)


class PanelI2C(Panel):
    def __init__(self, width, height, i2c, addr=0x3C):
        self.i2c = i2c
        self.addr = addr
        self.two = bytearray(2)
        super().__init__(width, height)

    def write_cmd(self, cmd):
        self.two[0], self.two[1] = 0x80, cmd
        self.i2c.writeto(self.addr, self.two)

    def write_data(self, buf):
        self.i2c.writevto(self.addr, [b"\x40", buf])


class PanelSPI(Panel):
    def __init__(self, width, height, spi, dc, res, cs):
        dc.init(dc.OUT, value=0)
        res.init(res.OUT, value=1)
        cs.init(cs.OUT, value=1)
        self.spi, self.dc, self.cs = spi, dc, cs
        res(0)
        time.sleep_ms(1)
        res(1)
        super().__init__(width, height)

    def write(self, data, buf):
        self.spi.init(baudrate=4_000_000, polarity=0, phase=0)
        self.dc(data)
        self.cs(0)
        self.spi.write(buf)
        self.cs(1)

    def write_cmd(self, cmd):
        self.write(0, bytearray([cmd]))

    def write_data(self, buf):
        self.write(1, buf)
