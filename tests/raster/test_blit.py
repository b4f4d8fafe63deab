"""Blocks, copies of pictures, texts and scrolling, pixel by pixel against what they are defined to be."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from paneldraw.text import Font, render

WIDTH, HEIGHT = 13, 9
TOP = {1: 1, 2: 3, 4: 15, 8: 255}

near = st.integers(-6, 13)
far = st.sampled_from([-(2**70), -(2**31), -(2**29), 2**29, 2**31, 2**70])
places = st.one_of(near, near, near, near, near, far)
lengths = st.one_of(st.integers(0, 20), st.integers(1, 9), st.sampled_from([2**29, 2**31, 2**71]))
depths = st.sampled_from([1, 2, 4, 8])
ops = st.sampled_from(["over", "xor", "add", "max", "clear"])
# A window: none, or a clip that may reach beyond the framebuffer.
windows = st.one_of(
    st.none(), st.tuples(st.integers(-2, 7), st.integers(-2, 5), st.integers(0, 14), st.integers(0, 10))
)


def noise(package, depth=4, seed=0, width=WIDTH, height=HEIGHT):
    fb = package.Framebuffer(width, height, depth)
    fb.pixels[...] = np.random.default_rng(seed).integers(0, fb.max_level + 1, (height, width))
    return fb


def inside(window):
    """Which pixels a window allows."""
    x, y, w, h = window or (0, 0, WIDTH, HEIGHT)
    return [
        (row, column) for row in range(HEIGHT) for column in range(WIDTH) if x <= column < x + w and y <= row < y + h
    ]


def within(fb, window, call):
    """Make a call, in a clip if there is a window."""
    if window is None:
        call(fb)
    else:
        with fb.clip(*window):
            call(fb)


def met(old, level, op, top):
    return {"over": level, "xor": old ^ level, "add": min(old + level, top), "max": max(old, level), "clear": 0}[op]


def check(package, depth, window, call, become):
    """A call changes the pixels of the window as `become` says of (row, column, old level), None for not at all.

    Once on a framebuffer, and once on a view of a larger one, of which the rest stays as it was.
    """
    fb = noise(package, depth)
    expected = fb.pixels.astype(int)
    for row, column in inside(window):
        level = become(row, column, int(fb.pixels[row, column]))
        if level is not None:
            expected[row, column] = level
    around = noise(package, depth, 1, WIDTH + 5, HEIGHT + 4)
    part = around.view(3, 2, WIDTH, HEIGHT)
    part.pixels[...] = fb.pixels
    rest = around.pixels.copy()
    within(fb, window, call)
    within(part, window, call)
    assert fb.pixels.tolist() == expected.tolist()
    rest[2 : 2 + HEIGHT, 3 : 3 + WIDTH] = expected
    assert around.pixels.tolist() == rest.tolist()


@pytest.mark.parametrize("down", [False, True])
@given(depths, windows, places, st.integers(0, 8), lengths, ops, st.data())
@example(4, None, -(2**70), 3, 2**71, "over", None)
@example(4, None, -(2**70), 3, 2**70, "over", None)
@example(4, (3, 3, 5, 4), 1, 4, 8, "over", None)
@example(4, (3, 3, 5, 4), 4, 1, 8, "over", None)
def test_lines_across_and_down(package, down, depth, window, start, line, length, op, data):
    level = data.draw(st.integers(0, TOP[depth])) if data else TOP[depth]

    def become(row, column, old):
        along, across = (row, column) if down else (column, row)
        return met(old, level, op, TOP[depth]) if across == line and start <= along < start + length else None

    def call(fb):
        if down:
            fb.vline(line, start, length, level, op=op)
        else:
            fb.hline(start, line, length, level, op=op)

    check(package, depth, window, call, become)
    fb = noise(package, depth)
    before = fb.pixels.copy()
    for beside in (-1, 13, 2**31, -(2**70)):
        if down:
            fb.vline(beside, start, length, level, op=op)
        else:
            fb.hline(start, beside, length, level, op=op)
    assert (fb.pixels == before).all()


@given(depths, windows, st.data())
def test_fill(package, depth, window, data):
    level = data.draw(st.integers(0, TOP[depth]))
    check(package, depth, window, lambda fb: fb.fill(level), lambda *_: level)


@given(depths, windows, places, places, ops, st.data())
def test_pixel(package, depth, window, x, y, op, data):
    level = data.draw(st.integers(0, TOP[depth]))

    def become(row, column, old):
        return met(old, level, op, TOP[depth]) if (column, row) == (x, y) else None

    check(package, depth, window, lambda fb: fb.pixel(x, y, level, op=op), become)
    fb = noise(package, depth)
    with fb.clip(0, 0, 1, 1):  # which is no bar to looking
        assert fb.pixel(x, y) == (fb.pixels[y, x] if 0 <= x < WIDTH and 0 <= y < HEIGHT else 0)


@given(windows, places, places, st.one_of(st.none(), st.integers(0, 15)))
def test_scroll(package, window, dx, dy, level):
    before = noise(package).pixels.tolist()
    allowed = set(inside(window))

    def become(row, column, _):
        source = (row - dy, column - dx)
        return before[source[0]][source[1]] if source in allowed else level

    check(package, 4, window, lambda fb: fb.scroll(dx, dy, level), become)


def strided(levels, form):
    """The same levels in memory of another order."""
    height, width = levels.shape
    if form == "fortran":
        return np.asfortranarray(levels)
    if form == "reversed":
        return np.ascontiguousarray(levels[::-1, ::-1])[::-1, ::-1]
    if form == "sparse":
        sparse = np.full((2 * height, 3 * width), 77, levels.dtype)
        sparse[::2, ::3] = levels
        return sparse[::2, ::3]
    if form == "part":
        part = np.full((height + 2, width + 3), 77, levels.dtype)
        part[1:-1, 2:-1] = levels
        return part[1:-1, 2:-1]
    return levels


forms = st.sampled_from(["plain", "fortran", "reversed", "sparse", "part"])
sizes = st.tuples(st.integers(0, 12), st.sampled_from([0, 1, 5, WIDTH, 20]))


@given(depths, windows, sizes, places, places, forms, st.integers(-1, 17), st.data())
@example(4, None, (HEIGHT, WIDTH), 0, 0, "plain", -1, None)
@example(4, None, (HEIGHT, WIDTH), 0, 2, "plain", 3, None)
def test_blit(package, depth, window, size, x, y, form, key, data):
    """From arrays in any order and from framebuffers of any depth, with and without palette and key."""
    kind = data.draw(st.sampled_from(["array", "palette", "framebuffer"])) if data else "array"
    top = TOP[depth]
    random = np.random.default_rng(2)
    options = {"key": key}
    if kind == "framebuffer" and min(size) > 0:
        source = noise(package, data.draw(depths), 2, size[1], size[0])
        levels = source.pixels
        of = source.max_level
        stands = [min((2 * level * top + of) // (2 * of), top) for level in range(256)]
    elif kind == "palette":
        stands = data.draw(st.lists(st.integers(0, top), min_size=1, max_size=20))
        levels = random.integers(0, len(stands), size).astype(np.uint8)
        source = strided(levels, form)
        options["palette"] = stands
    else:
        levels = random.integers(0, top + 1, size).astype(np.uint8)
        source = strided(levels, form)
        stands = range(256)

    def become(row, column, _):
        if not (0 <= row - y < size[0] and 0 <= column - x < size[1]):
            return None
        level = stands[levels[row - y, column - x]]
        return None if level == key else level

    check(package, depth, window, lambda fb: fb.blit(source, x, y, **options), become)


@given(windows, near, near, st.integers(-1, 15), st.integers(0, 4), st.integers(0, 3), st.sampled_from([-2, -1, 1, 2]))
def test_blit_of_its_own_pixels_reads_before_it_writes(package, window, x, y, key, left, top, step):
    """A framebuffer, a view of it, or its array in another order."""
    for form in ("itself", "view", "array"):
        fb = noise(package)
        source = {"itself": fb, "view": fb.view(left, top, 8, 5), "array": fb.pixels[top::step, ::step]}[form]
        levels = np.asarray(source).copy()
        expected = fb.pixels.tolist()
        for row, column in inside(window):
            if 0 <= row - y < levels.shape[0] and 0 <= column - x < levels.shape[1]:
                level = int(levels[row - y, column - x])
                expected[row][column] = expected[row][column] if level == key else level
        within(fb, window, lambda fb, source=source: fb.blit(source, x, y, key))
        assert fb.pixels.tolist() == expected


@pytest.mark.parametrize("copies", [lambda fb, part: fb.image(part), lambda fb, part: fb.blit(part, 0, 0)])
def test_a_picture_may_be_the_framebuffer_upside_down(package, copies):
    fb = noise(package, 8)
    expected = fb.pixels[::-1].tolist()
    copies(fb, fb.pixels[::-1])
    assert fb.pixels.tolist() == expected


@given(depths, windows, sizes, near, near, forms)
def test_images_of_grays(package, depth, window, size, x, y, form):
    top = TOP[depth]
    grays = np.random.default_rng(3).integers(0, 256, size).astype(np.uint8)

    def become(row, column, _):
        if not (0 <= row - y < size[0] and 0 <= column - x < size[1]):
            return None
        return (2 * int(grays[row - y, column - x]) * top + 255) // 510

    check(package, depth, window, lambda fb: fb.image(strided(grays, form), x, y), become)


@given(depths, windows, sizes, near, near, forms)
def test_images_of_truths(package, depth, window, size, x, y, form):
    """Any byte but 0 is true."""
    truths = np.random.default_rng(4).integers(0, 4, size).astype(np.uint8)

    def become(row, column, _):
        if not (0 <= row - y < size[0] and 0 <= column - x < size[1]):
            return None
        return TOP[depth] if truths[row - y, column - x] else 0

    check(package, depth, window, lambda fb: fb.image(strided(truths.view(bool), form), x, y), become)


@given(depths, windows, near, near, st.sampled_from([None, "bayer"]))
def test_images_let_shine_through(package, depth, window, x, y, dither):
    picture = np.random.default_rng(5).integers(0, 256, (7, 10, 4)).astype(np.uint8)
    picture[:, :, 1] = picture[:, :, 2] = picture[:, :, 0]  # grays
    picture[0, :5, 3] = 255
    picture[1, :5, 3] = 0
    opaque = package.Framebuffer(10, 7, depth)
    opaque.image(picture[:, :, 0], dither=dither)
    levels = opaque.pixels.astype(int)

    def become(row, column, old):
        if not (0 <= row - y < 7 and 0 <= column - x < 10):
            return None
        share = int(picture[row - y, column - x, 3])
        return (old * (255 - share) + int(levels[row - y, column - x]) * share + 127) // 255

    check(package, depth, window, lambda fb: fb.image(picture, x, y, dither=dither), become)


texts = st.text(st.sampled_from("Hg.|→µ°\0\U0001f600é\r\n\t "), max_size=6)
anchors = st.tuples(st.sampled_from("lmr"), st.sampled_from("atmsbd")).map("".join)


@given(depths, windows, texts, near, near, anchors, st.integers(1, 3), ops, st.data())
@example(1, None, "A" * 50, -(2**29), 0, "lt", 1, "over", None)
@example(1, None, "Ag", 2**70, -(2**70), "lt", 2, "over", None)
def test_a_text_is_what_it_covers(package, depth, window, text, x, y, anchor, factor, op, data):
    level = data.draw(st.integers(0, TOP[depth])) if data else 1
    font = package.Font.builtin().scaled(factor)
    coverage, dx, dy = render(text, Font.builtin().scaled(factor), anchor)

    def become(row, column, old):
        row, column = row - y - dy, column - x - dx
        if not (0 <= row < coverage.shape[0] and 0 <= column < coverage.shape[1] and coverage[row, column]):
            return None
        return met(old, level, op, TOP[depth])

    check(
        package,
        depth,
        window,
        lambda fb: fb.text(text, x, y, level, font=font, anchor=anchor, op=op),
        become,
    )


def test_texts_of_any_size(package):
    """A stroke ten million times as large covers everything; what is larger still neither hangs nor wraps around."""
    bar = package.Font.builtin()
    fb = package.Framebuffer(WIDTH, HEIGHT)
    fb.text("|", -2 * 10**7 - 3, -5, font=bar.scaled(10**7))
    assert fb.pixels.all()
    fb.clear()
    for factor in (10**8, 10**9, 10**20):
        for x, y, anchor in ((0, 0, "lt"), (WIDTH, HEIGHT, "rb"), (2**70, 2**70, "ms"), (-(2**70), 0, "lt")):
            fb.text("..", x, y, font=bar.scaled(factor), anchor=anchor)
    assert not fb.pixels.any()


def test_texts_and_pictures_reach_from_far_away_into_the_window(package):
    far, near = package.Framebuffer(WIDTH, HEIGHT), package.Framebuffer(WIDTH, HEIGHT)
    begin = 6 * 30000
    far.text("." * 30000 + "Ag", 1 - begin, 0)
    near.text("Ag", 1, 0)
    assert far == near
    stripe = np.zeros((2, begin), np.uint8)
    for draw, level in ((far.image, 255), (far.blit, 1)):
        stripe[:, -3:] = level
        far.clear()
        draw(stripe, 5 - begin, 1)
        assert np.argwhere(far.pixels).tolist() == [[row, column] for row in (1, 2) for column in (2, 3, 4)]


def test_gray_texts_are_blended(package):
    """A font that has shades goes through a mask."""
    pytest.importorskip("PIL", minversion="10.1")  # the first whose own font comes in sizes
    from PIL import ImageFont

    font = package.Font.from_pillow(ImageFont.load_default(14), antialias=True)
    coverage, dx, dy = render("Qg", Font.from_pillow(ImageFont.load_default(14), antialias=True))
    fb = package.Framebuffer(coverage.shape[1], coverage.shape[0], 8)
    fb.text("Qg", -dx, -dy, 200, font=font)
    assert set(np.unique(coverage)) - {0, 255}
    assert fb.pixels.tolist() == ((2 * 200 * coverage.astype(int) + 255) // 510).tolist()
