# cython: nonecheck=True
"""How text, pictures and the levels of other surfaces are painted, and how those of a surface are moved."""

from __future__ import annotations

import cython
import numpy as np
from cython.cimports.paneldraw.framebuffer.arguments import (
    BEYOND,
    extent,
    is_word,
    level,
    level_named,
    near_pixel,
    top_left,
    uint8s,
)
from cython.cimports.paneldraw.raster.blit import Picture, blit, block, mix, paint_grays, scroll
from cython.cimports.paneldraw.raster.glyphs import Glyphs, one_line, stamp, write
from cython.cimports.paneldraw.raster.surface import ADD, OVER, XOR, Surface

from paneldraw.framebuffer import pictures
from paneldraw.framebuffer.arguments import choice, size
from paneldraw.framebuffer.scaling import seen
from paneldraw.raster.surface import OPS

# The module of text, from the first text on: a script that writes none does without it.
_layout = cython.declare(object, None)


def write_text(coverage, s, x, y, font, anchor):
    """Write text."""
    global _layout
    if _layout is None:
        import paneldraw.text as _layout
    left: cython.longlong = top_left("x", x)
    top: cython.longlong = top_left("y", y)
    font = _layout.font_on(font, coverage.surface.max_level)
    glyphs: Glyphs = font._glyphs
    simple: cython.bint = glyphs is not None and type(s) is str and one_line(s)
    if simple:
        if not s.isascii():
            s = _layout.composed(s)
        if coverage.surface.op == XOR or coverage.surface.op == ADD:
            # Where letters overlap, a pixel is painted once all the same.
            glyphs.advance(s)
            simple = not glyphs.overlapping
    if not simple:
        shares, dx, dy = _layout.render(s, font, anchor)
        _stamp(coverage, shares, left + dx, top + dy, False)
        return
    # More is as much: one pixel of the font, beside it or not, is all there is to see.
    factor: cython.longlong = min(font._factor, 1 << 31)
    if not is_word(anchor, "la"):
        lit = glyphs.bounds(s) if not font._cells else (0, 0, 0, 0)
        scale = font._factor
        dx, dy = _layout.offset(anchor, font, glyphs.measure(s) * scale, lit[1] * scale, lit[3] * scale)
        left += max(dx, -BEYOND)
        top += max(dy, -BEYOND)
    write(coverage.surface, glyphs, s, left, top, factor)


def set_text(coverage, s, x, y, font, anchor, line_spacing, direction, inverse):
    """Write text that is not set as most is."""
    import paneldraw.text

    left: cython.longlong = top_left("x", x)
    top: cython.longlong = top_left("y", y)
    font = paneldraw.text.font_on(font, coverage.surface.max_level)
    shares, dx, dy = paneldraw.text.render(
        s, font, anchor, line_spacing=line_spacing, direction=direction, inverse=inverse
    )
    _stamp(coverage, shares, left + dx, top + dy, inverse)


def write_box(coverage, s, x, y, w, h, font, style, inverse):
    """Write text in a box; return the rest of it."""
    import paneldraw.text

    surface: Surface = coverage.surface
    left: cython.longlong = near_pixel("x", x)
    top: cython.longlong = near_pixel("y", y)
    width: cython.longlong = min(extent("w", w, 1), 1 << 30)
    height: cython.longlong = min(extent("h", h, 1), 1 << 30)
    font = paneldraw.text.font_on(font, surface.max_level)
    picture, rest = paneldraw.text.boxed(s, width, height, font, paneldraw.text.BoxStyle(*style))
    if not inverse:
        _stamp(coverage, picture.ink, left + picture.left, top + picture.top, False)
        return rest
    # The part of the box that is seen, less the characters in it.
    across: cython.longlong = max(left, surface.left)
    down: cython.longlong = max(top, surface.top)
    size = (max(min(top + height, surface.bottom) - down, 0), max(min(left + width, surface.right) - across, 0))
    picture = picture._replace(left=picture.left + left - across, top=picture.top + top - down)
    part = paneldraw.text.within(picture, size)
    shares = np.full(size, 255, np.uint8)
    shares[part.top : part.top + part.ink.shape[0], part.left : part.left + part.ink.shape[1]] -= part.ink
    _stamp(coverage, shares, across, down, True)
    return rest


def _stamp(coverage, shares, left, top, inverse):
    """Paint what is covered; of an inverse box, what is not is dark."""
    surface: Surface = coverage.surface
    color: cython.int = surface.level
    height, width = shares.shape
    if inverse and surface.op == OVER:
        block(surface, left, top, left + width, top + height, 0, OVER)
        surface.paint_with(color, OVER)
    mask = bytearray(shares.tobytes())
    stamp(coverage, uint8s(mask), width, height, left, top)


def paint_picture(surface, picture, x, y, dither, op):
    """Paint a picture of grays in its own size, as they are."""
    left: cython.longlong = top_left("x", x)
    top: cython.longlong = top_left("y", y)
    code: cython.int = operation(op)
    levels: Picture = Picture.__new__(Picture)
    if dither is None and (levels.read(picture) or levels.read_arrow(pictures.arrow(picture))):
        paint_grays(surface, levels, left, top, code)
        return True
    return False


def paint_seen(surface, before, picture, place, fill, options, tones):
    """Paint what is seen of a picture: `options` say of which size, `tones` which level a gray becomes.

    `before` are the levels of the surface.
    """
    x, y, op = place
    left: cython.longlong = top_left("x", x)
    top: cython.longlong = top_left("y", y)
    code: cython.int = operation(op)
    size = options["size"]
    around: cython.int = -1 if fill is None else level_named("fill", surface, fill)
    dither = tones["dither"]
    pictures.check_dither(dither)
    window = (surface.left, surface.top, surface.right, surface.bottom)
    part = seen(picture, (left, top), window, diffused=dither == "floyd-steinberg", **options)
    if part is not None:
        height, width = part.grays.shape
        if dither == "stable":
            tones["before"] = before[part.top : part.top + height, part.left : part.left + width]
        shades = pictures.quantize(part.grays, surface.max_level, place=part.first, **tones)
    if around >= 0 and size is not None:
        block(surface, left, top, left + size[0], top + size[1], around, OVER)
    if part is None:
        return
    if around >= 0 and size is None:
        block(surface, part.left, part.top, part.left + width, part.top + height, around, OVER)
    levels: Picture = Picture.__new__(Picture)
    levels.read(shades)
    if part.alpha is None:
        blit(surface, levels, part.left, part.top, -1, code)
    else:
        opacity: Picture = Picture.__new__(Picture)
        opacity.read(part.alpha)
        mix(surface, levels, opacity, part.left, part.top, -1, code)


def operation(op):
    """The number by which the raster modules know an operation."""
    return OVER if is_word(op, "over") else choice("op", op, OPS)


def copy_levels(surface, source, cover, x, y, key, palette, op):
    """Copy the levels of a surface or of an array, as opaque as `cover` says, if that is not None."""
    left: cython.longlong = top_left("x", x)
    top: cython.longlong = top_left("y", y)
    without: cython.int = min(max(size("key", key), -1), 256)
    code: cython.int = operation(op)
    levels: Picture = _levels_of(surface, source, palette)
    if cover is None:
        blit(surface, levels, left, top, without, code)
    else:
        opacity: Picture = Picture.__new__(Picture)
        opacity.read(cover)
        mix(surface, levels, opacity, left, top, without, code)


def _levels_of(surface, source, palette):
    """A surface or an array of levels as a picture of levels of this surface."""
    levels: Picture = Picture.__new__(Picture)
    max_level: cython.int = surface.max_level
    of: cython.int = max_level
    if isinstance(source, Surface):
        of = source.max_level
        levels.read_surface(source)
    elif not levels.read(source) or levels.truths:
        raise TypeError(
            f"source must be a Framebuffer or a uint8 array of shape (height, width), not {type(source).__name__}"
        )
    elif palette is None and max_level < 255 and levels.highest() > max_level:
        raise ValueError(f"source must hold levels from 0 to {max_level}, and holds {levels.highest()}")
    if palette is not None:
        table = pictures.palette_table(palette, max_level)
        if levels.highest() >= len(table):
            raise ValueError(f"palette must have a level for each of the source, and has none for {levels.highest()}")
        levels.look_up(table)
    elif of != max_level:
        levels.scale(of, max_level)
    return levels


def move_levels(surface, dx, dy, c):
    """Move what is in the window."""
    scroll(surface, near_pixel("dx", dx), near_pixel("dy", dy), -1 if c is None else level(surface, c))
