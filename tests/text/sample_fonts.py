"""The letter A and a few others in every format of bitmap fonts, written here; and fonts of Debian's packages."""

from __future__ import annotations

import os
import struct

import numpy as np
import pytest

A = np.array([[int(char == "#") for char in row] for row in (".##.", "#..#", "####", "#..#", "#..#")], np.uint8)
"""Stands on the baseline of a line of 6 rows, 1 of them below, 5 columns from pen to pen."""

DOT = np.ones((1, 1), np.uint8)


def installed(path):
    """A font of a package in .ci/apt-packages: CI has it, others may go without."""
    if not path.exists():
        (pytest.fail if os.environ.get("CI") else pytest.skip)(f"{path} is not installed")
    return path


CHARACTERS = ((65, A, 0, 0, 5), (32, np.zeros((0, 0), np.uint8), 0, 0, 5), (46, DOT, 1, 0, 3))


def bdf(
    characters=CHARACTERS,
    *,
    charset=("ISO10646", "1"),
    header="STARTFONT 2.1\nFONT -x-sample-medium-r-normal--6-60-75-75-p-50-iso10646-1\nSIZE 6 75 75\n"
    "FONTBOUNDINGBOX 4 6 0 -1\n",
    end="ENDFONT\n",
):
    """A BDF of (code, ink, left, bottom, advance) each."""
    properties = f'FONT_ASCENT 5\nFONT_DESCENT 1\nFAMILY_NAME "Sample"\nCHARSET_REGISTRY "{charset[0]}"\n'
    properties += f'CHARSET_ENCODING "{charset[1]}"\nPIXEL_SIZE 6\n'
    lines = [header, f"STARTPROPERTIES 6\n{properties}ENDPROPERTIES\nCHARS {len(characters)}\n"]
    for code, ink, left, bottom, advance in characters:
        height, width = ink.shape
        lines.append(f"STARTCHAR c{code}\nENCODING {code}\nSWIDTH 500 0\nDWIDTH {advance} 0\n")
        lines.append(f"BBX {width} {height} {left} {bottom}\nBITMAP\n")
        lines += [np.packbits(row).tobytes().hex().upper() + "\n" for row in ink]
        lines.append("ENDCHAR\n")
    return ("".join(lines) + end).encode("latin-1")


def pcf(order="<", bits="little", pad=2, unit=0, compressed=True):
    """A PCF with A alone, in any order of bytes and bits."""
    form = pad | (4 if order == ">" else 0) | (8 if bits == "big" else 0) | unit << 4
    strings = b"FAMILY_NAME\0Sample\0CHARSET_REGISTRY\0ISO10646\0CHARSET_ENCODING\x001\0"
    pairs = [(0, 12), (19, 36), (45, 62)]
    properties = struct.pack(order + "I", 3) + b"".join(struct.pack(order + "IBi", k, 1, v) for k, v in pairs)
    properties += b"\0" * (-3 & 3) + struct.pack(order + "I", len(strings)) + strings
    accelerators = b"\0" * 8 + struct.pack(order + "iii", 5, 1, 0)
    numbers = (0, 4, 5, 5, 0)
    if compressed:
        metrics = struct.pack(order + "H", 1) + bytes(number + 0x80 for number in numbers)
    else:
        metrics = struct.pack(order + "I5hH", 1, *numbers, 0)
    rows = np.zeros((5, 8 << pad), np.uint8)
    rows[:, :4] = A
    packed = np.packbits(rows, axis=1, bitorder=bits)
    if (order == ">") != (bits == "big"):
        packed = packed.reshape(-1, 1 << unit)[:, ::-1]
    data = packed.tobytes()
    bitmaps = struct.pack(order + "II4I", 1, 0, *(len(data),) * 4) + data
    encodings = struct.pack(order + "5HH", 65, 65, 0, 0, 65, 0)
    tables = [
        (1, form, properties),
        (2, form, accelerators),
        (4, form | (0x100 if compressed else 0), metrics),
        (8, form, bitmaps),
        (32, form, encodings),
    ]
    at = 8 + 16 * len(tables)
    directory, body = b"", b""
    for kind, its_form, table in tables:
        content = struct.pack("<I", its_form) + table
        directory += struct.pack("<4I", kind, its_form, len(content), at + len(body))
        body += content + b"\0" * (-len(content) & 3)
    return b"\x01fcp" + struct.pack("<I", len(tables)) + directory + body


def _cell(width=8, rows=6, below=1):
    """A in a cell of bytes, so many rows below its feet."""
    cell = np.zeros((rows, (width + 7) // 8 * 8), np.uint8)
    cell[rows - below - 5 : rows - below, :4] = A
    return np.packbits(cell, axis=1).tobytes()


def psf1():
    """256 characters of 8 x 6, with a table: the first is A, and A with a ring too, as one code and as a sequence."""
    glyphs = _cell() + b"\0" * 6 * 255
    table = struct.pack("<7H", 65, 0xC5, 0xFFFE, 65, 0x30A, 0xFFFF, 66) + b"\xff\xff" * 255
    return b"\x36\x04\x06\x06" + glyphs + table


def psf2(table=True):
    """Two characters of 9 x 6: A, and nothing; the sequence of A and an acute accent is A too."""
    header = struct.pack("<4s7I", b"\x72\xb5\x4a\x86", 0, 32, int(table), 2, 12, 6, 9)
    return header + _cell(9) + b"\0" * 12 + ("Aß".encode() + b"\xfeA\xcc\x81\xff \xff" if table else b"")


def hexadecimal():
    """Two lines as Unifont's."""
    return (
        b"# a comment\n0041:" + _cell(8, 16, 2).hex().encode() + b"\n1F600:" + _cell(16, 16, 2).hex().encode() + b"\n"
    )


class _Writer:
    def __init__(self):
        self.bits = []

    def put(self, number, count):
        self.bits += [number >> k & 1 for k in range(count)]

    def bytes(self):
        return np.packbits(np.array(self.bits, np.uint8), bitorder="little").tobytes()


def u8g2_glyph(ink, left, bottom, advance, zeros=3, ones=3):
    """The runs of a glyph; sizes in 5 bits each."""
    out = _Writer()
    height, width = ink.shape
    out.put(width, 5)
    out.put(height, 5)
    for signed in (left, bottom, advance):
        out.put(signed + 16, 5)
    pixels, at = [*ink.ravel().tolist()], 0
    while at < len(pixels):
        off = min(next((k for k, p in enumerate(pixels[at:]) if p), len(pixels) - at), (1 << zeros) - 1)
        at += off
        on = min(next((k for k, p in enumerate(pixels[at:]) if not p), len(pixels) - at), (1 << ones) - 1)
        at += on
        out.put(off, zeros)
        out.put(on, ones)
        out.put(0, 1)
    return out.bytes()


def u8g2(name="u8g2_font_sample_tr", braces=False):
    """A C source with A, a dot, and A again as U+0100."""
    glyphs = b""
    for code, ink, advance in ((46, DOT, 3), (65, A, 5)):
        glyph = u8g2_glyph(ink, 0, 0, advance)
        glyphs += bytes((code, len(glyph) + 2)) + glyph
    glyphs += b"\0\0"
    wide = u8g2_glyph(A, 0, 0, 5)
    table = struct.pack(">HH", 4, 0xFFFF) + struct.pack(">HB", 0x100, len(wide) + 3) + wide + b"\0\0"
    header = bytes((2, 0, 3, 3, 5, 5, 5, 5, 5, 4, 6, 0, 255, 5, 255, 5, 255)) + struct.pack(">HHH", 0, 0, len(glyphs))
    data = header + glyphs + table
    if braces:
        text = "{" + ",".join(f"0x{byte:02x}" for byte in data) + "}"
    else:
        text = (
            '"' + "".join(f"\\{byte:o}" if chr(byte) not in "!#$%&()" else chr(byte) for byte in data[:20]) + '"\n  "'
        )
        text += "".join(f"\\{byte:03o}" for byte in data[20:]) + '"'
    return f'/* sample */\nconst uint8_t {name}[{len(data)}] U8G2_FONT_SECTION("{name}") = \n  {text};\n'.encode()
