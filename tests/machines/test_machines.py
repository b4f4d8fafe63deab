"""The shapes that machines are compared by: the same each time, at both speeds; and what is told of differences."""

from __future__ import annotations

import io
import re
import sys
from urllib.error import HTTPError, URLError

import c_warnings
import compare
import instructions
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
    for name in ("Framebuffer", "Gradient", "Pattern"):
        monkeypatch.setattr(random_shapes, name, getattr(package, name))
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


COUNTED = """call nothing
call line
call show
counted 9999
counted 2000
counted 7
counted 42000
counted 7
counted 4002000
"""


def test_instructions_are_told_less_what_counting_takes_and_strays_are_named():
    rows = instructions.table(COUNTED)
    assert rows.splitlines()[2:] == ["| `line` | 2,000 | 0.002 ms |", "| `show` | 200,000 | 0.200 ms |"]
    assert instructions.strays(rows, rows) == []
    assert instructions.strays(rows.replace("2,000 |", "2,150 |"), rows) == []
    assert instructions.strays(rows.replace("| 2,000 |", "| 1,800 |"), rows) == ["line"]
    assert instructions.strays("", rows) == ["line", "show"]


def test_the_page_tells_all_that_is_counted():
    names = [name for name, call in instructions.calls() if call() is not NotImplemented][1:]
    told = re.findall(r"^\| `(.*)` \|", compare.PAGE.read_text(encoding="utf-8"), re.M)
    assert told == names


MIRROR = "http://debian.example"


@pytest.fixture
def release(monkeypatch):
    """What the mirror says of its suite, or how it fails; and no pauses."""
    answers = []

    def urlopen(url, timeout):
        assert url == f"{MIRROR}/dists/bookworm/Release"
        answer = answers[0] if len(answers) == 1 else answers.pop(0)
        if isinstance(answer, Exception):
            raise answer
        return io.BytesIO(answer)

    monkeypatch.setattr(compare.urllib.request, "urlopen", urlopen)
    monkeypatch.setattr(compare.time, "sleep", lambda seconds: None)
    monkeypatch.setenv("CI", "true")
    return answers


def test_packages_that_a_mirror_does_not_have_are_named(release):
    release.append(b"Suite: oldstable\nArchitectures: amd64 armhf\n")
    said = "E: Unable to locate package python3-hypothesis\nE: Unable to locate package python3-pil\n"
    with pytest.raises(compare.MissingError, match=rf"^python3-hypothesis, python3-pil: {MIRROR} .* for armhf$"):
        compare.look_for_packages("armhf", MIRROR, said)
    compare.look_for_packages("armhf", MIRROR, "E: some index files failed to download")


@pytest.mark.parametrize("answer", [b"Architectures: amd64 arm64\n", HTTPError(MIRROR, 404, "Not Found", {}, None)])
def test_a_mirror_without_the_machine_has_no_packages(release, answer):
    release.append(answer)
    with pytest.raises(compare.MissingError, match=r"^all packages: .* has none of bookworm for armhf$"):
        compare.look_for_packages("armhf", MIRROR, "")


@pytest.mark.parametrize(
    "error", [URLError("timed out"), TimeoutError("timed out"), HTTPError(MIRROR, 503, "timed out", {}, None)]
)
def test_a_mirror_that_does_not_answer_fails_in_ci(release, error, monkeypatch):
    release.append(error)
    with pytest.raises(compare.CommandError, match=r"^no answer from .*timed out"):
        compare.look_for_packages("armhf", MIRROR, "")
    monkeypatch.delenv("CI")
    with pytest.raises(compare.MissingError, match=r"^all packages: no answer from .*timed out"):
        compare.look_for_packages("armhf", MIRROR, "")
    release += [error, b"Architectures: armhf\n"]
    compare.look_for_packages("armhf", MIRROR, "")


@pytest.mark.parametrize(("error", "code"), [(compare.MissingError, 0), (compare.CommandError, 1), (OSError, None)])
def test_only_missing_packages_are_skipped(monkeypatch, capsys, error, code):
    def unpacked(debian, folder):
        raise error("the reason")

    monkeypatch.setattr(compare, "run", lambda *command, **names: "")
    monkeypatch.setattr(compare, "unpacked", unpacked)
    monkeypatch.setattr(sys, "argv", ["compare.py", "armv7l"])
    if code is None:
        with pytest.raises(error):
            compare.main()
        return
    assert compare.main() == code
    assert ("SKIPPED armv7l, for want of the reason\n" in capsys.readouterr().out) == (code == 0)


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
