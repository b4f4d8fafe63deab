"""Shapes as pictures to look at."""

from __future__ import annotations

from paneldraw.testing import assert_pattern

# -- Circles


def test_circle_of_radius_0(package):
    fb = package.Framebuffer(3, 3)
    fb.circle(1, 1, 0)
    assert_pattern(
        fb,
        """
        ...
        .#.
        ...
        """,
    )


def test_circle_of_radius_1(package):
    fb = package.Framebuffer(5, 5)
    fb.circle(2, 2, 1)
    assert_pattern(
        fb,
        """
        .....
        ..#..
        .#.#.
        ..#..
        .....
        """,
    )


def test_disc_of_radius_1(package):
    fb = package.Framebuffer(5, 5)
    fb.circle(2, 2, 1, fill=True)
    assert_pattern(
        fb,
        """
        .....
        ..#..
        .###.
        ..#..
        .....
        """,
    )


def test_circle_of_radius_2(package):
    fb = package.Framebuffer(7, 7)
    fb.circle(3, 3, 2)
    assert_pattern(
        fb,
        """
        .......
        ..###..
        .#...#.
        .#...#.
        .#...#.
        ..###..
        .......
        """,
    )


def test_disc_of_radius_2(package):
    fb = package.Framebuffer(7, 7)
    fb.circle(3, 3, 2, fill=True)
    assert_pattern(
        fb,
        """
        .......
        ..###..
        .#####.
        .#####.
        .#####.
        ..###..
        .......
        """,
    )


def test_circle_of_radius_3(package):
    fb = package.Framebuffer(9, 9)
    fb.circle(4, 4, 3)
    assert_pattern(
        fb,
        """
        .........
        ...###...
        ..#...#..
        .#.....#.
        .#.....#.
        .#.....#.
        ..#...#..
        ...###...
        .........
        """,
    )


def test_disc_of_radius_3(package):
    fb = package.Framebuffer(9, 9)
    fb.circle(4, 4, 3, fill=True)
    assert_pattern(
        fb,
        """
        .........
        ...###...
        ..#####..
        .#######.
        .#######.
        .#######.
        ..#####..
        ...###...
        .........
        """,
    )


def test_circle_of_radius_4(package):
    fb = package.Framebuffer(11, 11)
    fb.circle(5, 5, 4)
    assert_pattern(
        fb,
        """
        ...........
        ....###....
        ..##...##..
        ..#.....#..
        .#.......#.
        .#.......#.
        .#.......#.
        ..#.....#..
        ..##...##..
        ....###....
        ...........
        """,
    )


def test_disc_of_radius_4(package):
    fb = package.Framebuffer(11, 11)
    fb.circle(5, 5, 4, fill=True)
    assert_pattern(
        fb,
        """
        ...........
        ....###....
        ..#######..
        ..#######..
        .#########.
        .#########.
        .#########.
        ..#######..
        ..#######..
        ....###....
        ...........
        """,
    )


def test_circle_of_radius_5(package):
    fb = package.Framebuffer(13, 13)
    fb.circle(6, 6, 5)
    assert_pattern(
        fb,
        """
        .............
        ....#####....
        ...#.....#...
        ..#.......#..
        .#.........#.
        .#.........#.
        .#.........#.
        .#.........#.
        .#.........#.
        ..#.......#..
        ...#.....#...
        ....#####....
        .............
        """,
    )


def test_disc_of_radius_5(package):
    fb = package.Framebuffer(13, 13)
    fb.circle(6, 6, 5, fill=True)
    assert_pattern(
        fb,
        """
        .............
        ....#####....
        ...#######...
        ..#########..
        .###########.
        .###########.
        .###########.
        .###########.
        .###########.
        ..#########..
        ...#######...
        ....#####....
        .............
        """,
    )


def test_circle_of_radius_6(package):
    fb = package.Framebuffer(15, 15)
    fb.circle(7, 7, 6)
    assert_pattern(
        fb,
        """
        ...............
        .....#####.....
        ....#.....#....
        ...#.......#...
        ..#.........#..
        .#...........#.
        .#...........#.
        .#...........#.
        .#...........#.
        .#...........#.
        ..#.........#..
        ...#.......#...
        ....#.....#....
        .....#####.....
        ...............
        """,
    )


def test_disc_of_radius_6(package):
    fb = package.Framebuffer(15, 15)
    fb.circle(7, 7, 6, fill=True)
    assert_pattern(
        fb,
        """
        ...............
        .....#####.....
        ....#######....
        ...#########...
        ..###########..
        .#############.
        .#############.
        .#############.
        .#############.
        .#############.
        ..###########..
        ...#########...
        ....#######....
        .....#####.....
        ...............
        """,
    )


def test_circles_cut_off(package):
    fb = package.Framebuffer(13, 6)
    fb.circle(0, 5, 4)
    fb.circle(12, 0, 3, fill=True)
    assert_pattern(
        fb,
        """
        .........####
        ##.......####
        ..##......###
        ...#.......##
        ....#........
        ....#........
        """,
    )


# -- Rectangles


def test_rect(package):
    fb = package.Framebuffer(11, 6)
    fb.rect(1, 1, 9, 4)
    assert_pattern(
        fb,
        """
        ...........
        .#########.
        .#.......#.
        .#.......#.
        .#########.
        ...........
        """,
    )


def test_filled_rect(package):
    fb = package.Framebuffer(11, 6)
    fb.rect(1, 1, 9, 4, fill=True)
    assert_pattern(
        fb,
        """
        ...........
        .#########.
        .#########.
        .#########.
        .#########.
        ...........
        """,
    )


def test_narrow_rects(package):
    fb = package.Framebuffer(15, 5)
    fb.rect(0, 1, 1, 1)
    fb.rect(2, 1, 2, 2)
    fb.rect(5, 1, 1, 3)
    fb.rect(7, 1, 3, 1)
    fb.rect(11, 1, 3, 3)
    assert_pattern(
        fb,
        """
        ...............
        #.##.#.###.###.
        ..##.#.....#.#.
        .....#.....###.
        ...............
        """,
    )


def test_rects_without_width_or_height(package):
    fb = package.Framebuffer(5, 2)
    fb.rect(1, 0, 0, 2)
    fb.rect(1, 0, 3, 0)
    fb.rect(0, 0, 0, 0, fill=True)
    fb.hline(0, 0, 0)
    fb.vline(0, 0, 0)
    assert_pattern(
        fb,
        """
        .....
        .....
        """,
    )


def test_rects_cut_off(package):
    fb = package.Framebuffer(13, 6)
    fb.rect(-2, -2, 6, 5)
    fb.rect(8, 2, 2**70, 2**70)
    fb.rect(-(2**70), 4, 2**71, 1)
    assert_pattern(
        fb,
        """
        ...#.........
        ...#.........
        ####....#####
        ........#....
        #############
        ........#....
        """,
    )


def test_hline_and_vline(package):
    fb = package.Framebuffer(9, 5)
    fb.hline(1, 1, 7)
    fb.vline(4, 0, 9)
    fb.hline(-3, 3, 5)
    assert_pattern(
        fb,
        """
        ....#....
        .#######.
        ....#....
        ##..#....
        ....#....
        """,
    )


def test_fill_and_clear(package):
    fb = package.Framebuffer(5, 3, depth=2)
    fb.fill(2)
    fb.rect(1, 1, 3, 1, 0)
    assert_pattern(
        fb,
        """
        22222
        2...2
        22222
        """,
    )
