"""Text and pictures in a framebuffer, as pictures to look at."""

from __future__ import annotations

import numpy as np

from paneldraw.testing import assert_pattern


def test_text(package):
    fb = package.Framebuffer(24, 9)
    fb.text("21°C", 0, 1)
    assert_pattern(
        fb,
        """
        ........................
        .###....#....##....###..
        #...#..##...#..#..#...#.
        ....#...#...#..#..#.....
        ..##....#....##...#.....
        .#......#.........#.....
        #.......#.........#...#.
        #####..###.........###..
        ........................
        """,
    )


def test_text_by_its_anchor(package):
    fb = package.Framebuffer(25, 17)
    fb.text("Hi\nthere", 24, 16, anchor="rb")
    assert_pattern(
        fb,
        """
        .........................
        ..............#...#...#..
        ..............#...#......
        ..............#...#..##..
        ..............#####...#..
        ..............#...#...#..
        ..............#...#...#..
        ..............#...#..###.
        .........................
        ..#......................
        ..#......................
        ..####...###..#.##...###.
        ..#...#.#...#.##..#.#...#
        ..#...#.#####.#.....#####
        #.#...#.#.....#.....#....
        ..#...#..###..#......###.
        .........................
        """,
    )


def test_text_cut_off(package):
    fb = package.Framebuffer(12, 6)
    fb.text("Wide", -3, -2)
    assert_pattern(
        fb,
        """
        .#..##....##
        .#...#...#..
        .#...#...#..
        ##...#...#..
        .#..###...##
        ............
        """,
    )


def test_text_in_the_dark(package):
    fb = package.Framebuffer(13, 8)
    fb.fill(1)
    fb.text("No", 1, 0, 0)
    assert_pattern(
        fb,
        """
        #.###.#######
        #..##.#######
        #..##.##...##
        #.#.#.#.###.#
        #.##..#.###.#
        #.##..#.###.#
        #.###.##...##
        #############
        """,
    )


def test_a_picture(package):
    fb = package.Framebuffer(9, 4, depth=4)
    fb.image(np.arange(0, 256, 17, np.uint8).reshape(2, 8), 0, 1)
    assert_pattern(
        fb,
        """
        .........
        .1234567.
        89abcdef.
        .........
        """,
    )


def test_a_picture_of_true_and_false(package):
    fb = package.Framebuffer(7, 5)
    fb.image(np.eye(5, dtype=bool), 1, 0)
    assert_pattern(
        fb,
        """
        .#.....
        ..#....
        ...#...
        ....#..
        .....#.
        """,
    )


def test_pictures_cut_off(package):
    fb = package.Framebuffer(7, 4, depth=2)
    fb.image(np.full((3, 3), 85, np.uint8), -1, -1)
    fb.image(np.full((3, 3), 170, np.uint8), 5, 2)
    fb.image(np.full((99, 1), 255, np.uint8), 3, -40)
    assert_pattern(
        fb,
        """
        11.3...
        11.3...
        ...3.22
        ...3.22
        """,
    )


def test_an_ordered_dither(package):
    fb = package.Framebuffer(16, 8)
    fb.image(np.tile(np.arange(0, 256, 17, np.uint8), (8, 1)), 0, 0, dither="bayer")
    assert_pattern(
        fb,
        """
        .......#.#.#.###
        ..#.#.#.#.######
        .....#.#.#.#####
        ....#.#.########
        .......#.#.#.###
        ..#.#.#.#.######
        .....#.#.#.#####
        ..#.#.#.########
        """,
    )


def test_an_error_diffused(package):
    fb = package.Framebuffer(16, 8)
    fb.image(np.tile(np.arange(0, 256, 17, np.uint8), (8, 1)), 0, 0, dither="floyd-steinberg")
    assert_pattern(
        fb,
        """
        .....#.#.#######
        ....#..#.#.#.###
        .....#.#.##.####
        ...#...#.#.#####
        .....#.#.#######
        ...#..#.#.#.#.##
        ....#..#.#######
        .....#.#.#.#.###
        """,
    )
