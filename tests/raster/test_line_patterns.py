"""Lines as pictures to look at."""

from __future__ import annotations

from paneldraw.testing import assert_pattern

# -- Thin lines


def test_lines_in_all_octants(package):
    fb = package.Framebuffer(15, 15)
    for x, y in ((14, 10), (10, 14), (4, 14), (0, 10), (0, 4), (4, 0), (10, 0), (14, 4)):
        fb.line(7, 7, x, y)
    assert_pattern(
        fb,
        """
        ....#.....#....
        ....#.....#....
        .....#...#.....
        .....#...#.....
        ##....#.#....##
        ..##..#.#..##..
        ....##.#.##....
        ......###......
        ....##.#.##....
        ..##..#.#..##..
        ##....#.#....##
        .....#...#.....
        .....#...#.....
        ....#.....#....
        ....#.....#....
        """,
    )


def test_lines_along_the_axes_and_diagonals(package):
    fb = package.Framebuffer(9, 9)
    fb.line(0, 4, 8, 4)
    fb.line(4, 8, 4, 0)
    fb.line(0, 0, 8, 8)
    fb.line(8, 0, 0, 8)
    assert_pattern(
        fb,
        """
        #...#...#
        .#..#..#.
        ..#.#.#..
        ...###...
        #########
        ...###...
        ..#.#.#..
        .#..#..#.
        #...#...#
        """,
    )


def test_a_line_halfway_between_two_rows_takes_the_one_further_along(package):
    """From the left downward that is the lower one."""
    fb = package.Framebuffer(9, 5)
    fb.line(0, 0, 8, 4)
    assert_pattern(
        fb,
        """
        #........
        .##......
        ...##....
        .....##..
        .......##
        """,
    )


def test_and_upward_the_upper_one(package):
    fb = package.Framebuffer(9, 5)
    fb.line(0, 4, 8, 0)
    assert_pattern(
        fb,
        """
        .......##
        .....##..
        ...##....
        .##......
        #........
        """,
    )


def test_a_line_of_no_length_is_a_pixel(package):
    fb = package.Framebuffer(3, 3)
    fb.line(1, 1, 1, 1)
    assert_pattern(
        fb,
        """
        ...
        .#.
        ...
        """,
    )


def test_lines_from_outside(package):
    fb = package.Framebuffer(12, 5)
    fb.line(-10, -3, 21, 7)
    fb.line(5, 2**70, 5, 3)
    assert_pattern(
        fb,
        """
        #...........
        .###........
        ....####....
        .....#..###.
        .....#.....#
        """,
    )


def test_many_lines_in_one_call(package):
    fb = package.Framebuffer(9, 5)
    fb.lines([(0, 0, 4, 4), (4, 4, 8, 0), (2, 4, 6, 4)])
    assert_pattern(
        fb,
        """
        #.......#
        .#.....#.
        ..#...#..
        ...#.#...
        ..#####..
        """,
    )


def test_points(package):
    fb = package.Framebuffer(7, 3)
    fb.points([(0, 0), (2, 1), (4, 2), (6, 1), (7, 1)])
    assert_pattern(
        fb,
        """
        #......
        ..#...#
        ....#..
        """,
    )


# -- Thick lines


def test_a_line_3_pixels_wide_with_square_caps(package):
    fb = package.Framebuffer(13, 5)
    fb.line(3, 2, 9, 2, width=3, cap="square")
    assert_pattern(
        fb,
        """
        .............
        ..#########..
        ..#########..
        ..#########..
        .............
        """,
    )


def test_a_line_4_pixels_wide_with_square_caps(package):
    fb = package.Framebuffer(13, 5)
    fb.line(3, 2, 9, 2, width=4, cap="square")
    assert_pattern(
        fb,
        """
        .##########..
        .##########..
        .##########..
        .##########..
        .............
        """,
    )


def test_a_thick_diagonal_with_square_caps(package):
    fb = package.Framebuffer(13, 11)
    fb.line(3, 2, 9, 8, width=3, cap="square")
    assert_pattern(
        fb,
        """
        ...#.........
        ..###........
        .#####.......
        ..#####......
        ...#####.....
        ....#####....
        .....#####...
        ......#####..
        .......#####.
        ........###..
        .........#...
        """,
    )


def test_a_thick_slope_with_square_caps(package):
    fb = package.Framebuffer(13, 9)
    fb.line(2, 2, 10, 6, width=4, cap="square")
    assert_pattern(
        fb,
        """
        .##..........
        .####........
        #######......
        #########....
        ..#########..
        ....#########
        ......#######
        ........####.
        ..........##.
        """,
    )


def test_a_thick_upright_with_square_caps(package):
    fb = package.Framebuffer(7, 9)
    fb.line(3, 6, 3, 2, width=3, cap="square")
    assert_pattern(
        fb,
        """
        .......
        ..###..
        ..###..
        ..###..
        ..###..
        ..###..
        ..###..
        ..###..
        .......
        """,
    )


def test_a_line_3_pixels_wide_with_butt_caps(package):
    fb = package.Framebuffer(13, 5)
    fb.line(3, 2, 9, 2, width=3, cap="butt")
    assert_pattern(
        fb,
        """
        .............
        ...######....
        ...######....
        ...######....
        .............
        """,
    )


def test_a_line_4_pixels_wide_with_butt_caps(package):
    fb = package.Framebuffer(13, 5)
    fb.line(3, 2, 9, 2, width=4, cap="butt")
    assert_pattern(
        fb,
        """
        ...######....
        ...######....
        ...######....
        ...######....
        .............
        """,
    )


def test_a_thick_diagonal_with_butt_caps(package):
    fb = package.Framebuffer(13, 11)
    fb.line(3, 2, 9, 8, width=3, cap="butt")
    assert_pattern(
        fb,
        """
        .............
        ....#........
        ...###.......
        ..#####......
        ...#####.....
        ....#####....
        .....#####...
        ......####...
        .......##....
        .............
        .............
        """,
    )


def test_a_thick_slope_with_butt_caps(package):
    fb = package.Framebuffer(13, 9)
    fb.line(2, 2, 10, 6, width=4, cap="butt")
    assert_pattern(
        fb,
        """
        .............
        ...##........
        ..#####......
        ..#######....
        ..#########..
        ....#######..
        ......####...
        ........##...
        .............
        """,
    )


def test_a_thick_upright_with_butt_caps(package):
    fb = package.Framebuffer(7, 9)
    fb.line(3, 6, 3, 2, width=3, cap="butt")
    assert_pattern(
        fb,
        """
        .......
        .......
        ..###..
        ..###..
        ..###..
        ..###..
        .......
        .......
        .......
        """,
    )


def test_a_thick_line_of_no_length_is_a_square(package):
    fb = package.Framebuffer(7, 5)
    fb.line(3, 2, 3, 2, width=3)
    assert_pattern(
        fb,
        """
        .......
        ..###..
        ..###..
        ..###..
        .......
        """,
    )


def test_without_caps_it_is_nothing(package):
    fb = package.Framebuffer(7, 3)
    fb.line(3, 1, 3, 1, width=3, cap="butt")
    assert_pattern(
        fb,
        """
        .......
        .......
        .......
        """,
    )


def test_neighbors_share_an_edge_and_no_pixel(package):
    fb = package.Framebuffer(13, 9, depth=2)
    fb.line(2, 1, 10, 5, 1, width=2, cap="butt", op="add")
    fb.line(2, 3, 10, 7, 2, width=2, cap="butt", op="add")
    assert_pattern(
        fb,
        """
        .............
        ..111........
        ..11111......
        ..2231111....
        ..222231111..
        ....222231...
        ......22222..
        ........22...
        .............
        """,
    )
