"""Supersampled lines as pictures to look at."""

from __future__ import annotations

from paneldraw.testing import assert_pattern


def test_line_of_1_x_1_samples_center(package):
    fb = package.Framebuffer(12, 5, depth=4)
    fb.line(1, 1, 10, 3, antialias=package.Supersample(1, "center"))
    assert_pattern(
        fb,
        """
        ............
        .fff........
        ....ffff....
        ........fff.
        ............
        """,
    )


def test_line_of_1_x_1_samples_corner(package):
    fb = package.Framebuffer(12, 5, depth=4)
    fb.line(1, 1, 10, 3, antialias=package.Supersample(1, "corner"))
    assert_pattern(
        fb,
        """
        ............
        ............
        ..fffff.....
        ......fffff.
        ............
        """,
    )


def test_line_of_2_x_2_samples_center(package):
    fb = package.Framebuffer(12, 5, depth=4)
    fb.line(1, 1, 10, 3, antialias=package.Supersample(2, "center"))
    assert_pattern(
        fb,
        """
        ............
        .fb88.......
        ..488ff884..
        .......88bf.
        ............
        """,
    )


def test_line_of_2_x_2_samples_corner(package):
    fb = package.Framebuffer(12, 5, depth=4)
    fb.line(1, 1, 10, 3, antialias=package.Supersample(2, "corner"))
    assert_pattern(
        fb,
        """
        ............
        .b88........
        .488ffb84...
        ......88bff4
        ..........4.
        """,
    )


def test_line_of_3_x_3_samples_center(package):
    fb = package.Framebuffer(12, 5, depth=4)
    fb.line(1, 1, 10, 3, antialias=package.Supersample(3, "center"))
    assert_pattern(
        fb,
        """
        ............
        .fc852......
        ..37adda73..
        ......258cf.
        ............
        """,
    )


def test_line_of_3_x_3_samples_corner(package):
    fb = package.Framebuffer(12, 5, depth=4)
    fb.line(1, 1, 10, 3, antialias=package.Supersample(3, "corner"))
    assert_pattern(
        fb,
        """
        ............
        .aa73.......
        .25acfc852..
        ......57afd2
        ..........2.
        """,
    )


def test_line_of_4_x_4_samples_center(package):
    fb = package.Framebuffer(12, 5, depth=4)
    fb.line(1, 1, 10, 3, antialias=package.Supersample(4, "center"))
    assert_pattern(
        fb,
        """
        ............
        .fb852......
        ..47adda74..
        ......258bf.
        ............
        """,
    )


def test_line_of_4_x_4_samples_corner(package):
    fb = package.Framebuffer(12, 5, depth=4)
    fb.line(1, 1, 10, 3, antialias=package.Supersample(4, "corner"))
    assert_pattern(
        fb,
        """
        ............
        .ca84.......
        .258bfc862..
        ......47ade2
        ..........2.
        """,
    )


def test_line_of_16_x_16_samples_center(package):
    fb = package.Framebuffer(12, 5, depth=4)
    fb.line(1, 1, 10, 3, antialias=package.Supersample(16, "center"))
    assert_pattern(
        fb,
        """
        ............
        .ec952......
        .147aeea741.
        ......259ce.
        ............
        """,
    )


def test_line_of_16_x_16_samples_corner(package):
    fb = package.Framebuffer(12, 5, depth=4)
    fb.line(1, 1, 10, 3, antialias=package.Supersample(16, "corner"))
    assert_pattern(
        fb,
        """
        ............
        .eb851......
        .147beda63..
        ......269ce1
        ..........1.
        """,
    )


def test_with_two_levels_half_or_more_is_lit(package):
    fb = package.Framebuffer(12, 5)
    fb.line(1, 1, 10, 3, antialias=package.Supersample(4))
    assert_pattern(
        fb,
        """
        ............
        .###........
        ....####....
        ........###.
        ............
        """,
    )


def test_with_four_levels_the_nearest_is_taken(package):
    fb = package.Framebuffer(12, 5, depth=2)
    fb.line(1, 1, 10, 3, antialias=package.Supersample(4))
    assert_pattern(
        fb,
        """
        ............
        .3221.......
        ..11233211..
        .......1223.
        ............
        """,
    )


def test_fractions_of_a_pixel(package):
    fb = package.Framebuffer(12, 7, depth=4)
    fb.line(1.5, 2.25, 9.75, 4.5, width=2.5, cap="butt", antialias=package.Supersample(4))
    assert_pattern(
        fb,
        """
        ............
        ..52........
        ..efd951....
        .3ffffffc82.
        ..37bfffff6.
        ......58cf2.
        .........2..
        """,
    )


def test_whole_coordinates_are_pixel_centers_anti_aliased_too(package):
    fb = package.Framebuffer(12, 5, depth=4)
    fb.line(2, 3, 9, 3, antialias=package.Supersample(4))
    assert_pattern(
        fb,
        """
        ............
        ............
        ............
        ..ffffffff..
        ............
        """,
    )


def test_the_framebuffers_own_anti_aliasing(package):
    """A call may still do without."""
    fb = package.Framebuffer(12, 8, depth=4)
    fb.antialias = package.Supersample(2)
    fb.line(1, 1, 10, 3)
    fb.line(1, 4, 10, 6, antialias=None)
    assert_pattern(
        fb,
        """
        ............
        .fb88.......
        ..488ff884..
        .......88bf.
        .fff........
        ....ffff....
        ........fff.
        ............
        """,
    )
