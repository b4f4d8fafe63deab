"""What an operation does where two shapes meet, as pictures to look at."""

from __future__ import annotations

from paneldraw.testing import assert_pattern


def test_operation_over(package):
    fb = package.Framebuffer(10, 4, depth=4)
    fb.rect(0, 0, 6, 3, 9, fill=True)
    fb.rect(3, 1, 6, 3, 12, fill=True, op="over")
    assert_pattern(
        fb,
        """
        999999....
        999cccccc.
        999cccccc.
        ...cccccc.
        """,
    )


def test_operation_xor(package):
    fb = package.Framebuffer(10, 4, depth=4)
    fb.rect(0, 0, 6, 3, 9, fill=True)
    fb.rect(3, 1, 6, 3, 12, fill=True, op="xor")
    assert_pattern(
        fb,
        """
        999999....
        999555ccc.
        999555ccc.
        ...cccccc.
        """,
    )


def test_operation_add(package):
    fb = package.Framebuffer(10, 4, depth=4)
    fb.rect(0, 0, 6, 3, 9, fill=True)
    fb.rect(3, 1, 6, 3, 12, fill=True, op="add")
    assert_pattern(
        fb,
        """
        999999....
        999fffccc.
        999fffccc.
        ...cccccc.
        """,
    )


def test_operation_max(package):
    fb = package.Framebuffer(10, 4, depth=4)
    fb.rect(0, 0, 6, 3, 9, fill=True)
    fb.rect(3, 1, 6, 3, 12, fill=True, op="max")
    assert_pattern(
        fb,
        """
        999999....
        999cccccc.
        999cccccc.
        ...cccccc.
        """,
    )


def test_operation_clear(package):
    fb = package.Framebuffer(10, 4, depth=4)
    fb.rect(0, 0, 6, 3, 9, fill=True)
    fb.rect(3, 1, 6, 3, 12, fill=True, op="clear")
    assert_pattern(
        fb,
        """
        999999....
        999.......
        999.......
        ..........
        """,
    )


def test_operation_over_anti_aliased(package):
    fb = package.Framebuffer(12, 5, depth=4)
    fb.rect(0, 0, 7, 5, 9, fill=True)
    fb.line(1, 1, 10, 3, 12, antialias=package.Supersample(4), op="over")
    assert_pattern(
        fb,
        """
        9999999.....
        9cbba99.....
        99aabcc853..
        9999999479c.
        9999999.....
        """,
    )


def test_operation_xor_anti_aliased(package):
    fb = package.Framebuffer(12, 5, depth=4)
    fb.rect(0, 0, 7, 5, 9, fill=True)
    fb.line(1, 1, 10, 3, 12, antialias=package.Supersample(4), op="xor")
    assert_pattern(
        fb,
        """
        9999999.....
        95.edb9.....
        99ac122853..
        999999b479c.
        9999999.....
        """,
    )


def test_operation_add_anti_aliased(package):
    fb = package.Framebuffer(12, 5, depth=4)
    fb.rect(0, 0, 7, 5, 9, fill=True)
    fb.line(1, 1, 10, 3, 12, antialias=package.Supersample(4), op="add")
    assert_pattern(
        fb,
        """
        9999999.....
        9fffdb9.....
        99cefff853..
        999999b479c.
        9999999.....
        """,
    )


def test_operation_max_anti_aliased(package):
    fb = package.Framebuffer(12, 5, depth=4)
    fb.rect(0, 0, 7, 5, 9, fill=True)
    fb.line(1, 1, 10, 3, 12, antialias=package.Supersample(4), op="max")
    assert_pattern(
        fb,
        """
        9999999.....
        9c99999.....
        99999bb853..
        9999999479c.
        9999999.....
        """,
    )


def test_operation_clear_anti_aliased(package):
    fb = package.Framebuffer(12, 5, depth=4)
    fb.rect(0, 0, 7, 5, 9, fill=True)
    fb.line(1, 1, 10, 3, 12, antialias=package.Supersample(4), op="clear")
    assert_pattern(
        fb,
        """
        9999999.....
        9.24689.....
        9975311.....
        9999998.....
        9999999.....
        """,
    )
