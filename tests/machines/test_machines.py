"""The shapes that machines are compared by: the same each time, at both speeds; and what is told of differences."""

from __future__ import annotations

import re

import c_warnings
import compare
import pytest
import random_shapes


def values(kind):
    """The arguments that make an anti-aliasing anew."""
    names = ("n", "reference") if hasattr(kind, "reference") else ("radius", "filter", "resolution")
    return [getattr(kind, name) for name in names]


@pytest.fixture
def groups(package, monkeypatch):
    """Some of the groups, drawn with the package at one of its speeds."""
    smooth = [getattr(package, type(kind).__name__)(*values(kind)) for kind in random_shapes.SMOOTH]
    monkeypatch.setattr(random_shapes, "SMOOTH", smooth)
    monkeypatch.setattr(random_shapes, "Framebuffer", package.Framebuffer)
    return list(random_shapes.groups())[::41]


#: Hashes by name of the group, of the speed that came first.
SEEN: dict[str, str] = {}


def test_both_speeds_draw_the_same(groups):
    found = {str(group): group.hash(count) for group, count in groups}
    assert len(found) > 50
    SEEN.update(SEEN or found)
    assert found == SEEN


def test_every_group_has_a_name_of_its_own():
    names = [str(group) for group, _ in random_shapes.groups()]
    assert len(set(names)) == len(names)
    assert sum(count for _, count in random_shapes.groups()) > 5000


def test_a_difference_is_named():
    ours = "aa circle, depth 1, aliased\nbb line, depth 2, aliased\n"
    theirs = "aa circle, depth 1, aliased\ncc line, depth 2, aliased\ndd arc, depth 4, aliased\n"
    assert compare.differences(ours, ours) == []
    assert sorted(compare.differences(ours, theirs)) == ["arc, depth 4, aliased", "line, depth 2, aliased"]


CODE = """
/* "paneldraw/raster/line.py":12
 * shifted = 1 << by
 */
long shifted(void) {
  return 1;
}
int f(int wide);
int f(int wide) {

  /* "paneldraw/raster/line.py":34
 * ...
 */
  wide = wide << 40;

  /* "paneldraw/raster/line.py":56
 * ...
 */
  long long far = wide * 2LL;
  wide = far;

  /* "paneldraw/raster/line.py":78
 * ...
 */
  if (wide < 12U) wide = -1;
  return wide;
}
int g(long long far);
int g(long long far) {
  return far;
}
typedef int Py_ssize_t;
Py_ssize_t h(long long far);
Py_ssize_t h(long long far) {

  /* "paneldraw/raster/line.py":90
 * ...
 */
  Py_ssize_t place = far;

  /* "paneldraw/raster/disc.py":91
 * ...
 */
  place += far;

  /* "paneldraw/raster/line.py":92
 * ...
 */
  place += (Py_ssize_t)far;
  return place;
}
"""


def test_warnings_name_the_line_of_python(tmp_path):
    file = tmp_path / "line.c"
    file.write_text(CODE, encoding="utf-8")
    told = {}
    for text in c_warnings.warnings("gcc", [], file):
        source, said = re.fullmatch(r"(paneldraw/raster/line\.py:\d+): (.*)", text).groups()
        told.setdefault(source[-2:], []).append(said)
    assert told.keys() == {"34", "56", "78", "90"}
    for line, kind in (("34", "shift"), ("56", "conversion"), ("78", "sign"), ("90", "conversion")):
        assert kind in told[line][0]
