"""Fonts that packages and systems install, by name."""

from __future__ import annotations

import difflib
import os
import re
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from paneldraw.text.font import Font
from paneldraw.text.loading import check_size, load

_ENDINGS = (
    *(".ttf", ".otf", ".ttc", ".otb", ".pcf", ".pcf.gz", ".bdf", ".bdf.gz"),
    *(".psf", ".psf.gz", ".psfu.gz", ".hex", ".hex.gz", ".pil"),
)

_STYLES = r"(?:regular|normal|medium|book|roman|bold|oblique|italic|semi|demi|extra|ultra|light|thin|black|heavy)"
_STYLE_AT_END = re.compile(rf"[-_ ]?({_STYLES}+)$")
_CONSOLE = re.compile(r"^([A-Z][A-Za-z0-9]*?)-([A-Z][A-Za-z]+?)(\d+)(?:x(\d+))?$")
_PREFERRED = ("iso10646", "uni2", "uni3", "uni1", "iso8859-1", "lat15", "lat1", "lat7")


@dataclass(frozen=True)
class Installed:
    """A font file, and what its name and X11's list say of it; `size` is 0 where they say none."""

    path: Path
    family: str
    style: str
    size: int
    charset: str

    @property
    def bold(self) -> bool:
        """Whether it is heavier than text."""
        return any(word in self.style for word in ("bold", "black", "heavy"))

    @property
    def italic(self) -> bool:
        """Whether it leans."""
        return any(word in self.style for word in ("italic", "oblique"))

    @property
    def plain(self) -> bool:
        """Whether it is of the common weight, or of the one that is called bold."""
        return not any(word in self.style for word in ("light", "thin", "black", "heavy", "semi", "demi", "extra"))


def find(name: str, size: float | None, bold: bool, italic: bool, antialias: bool | None) -> Font:
    """Find and read an installed font; see `Font.find`."""
    if not isinstance(name, str):
        raise TypeError(f"name must be a string, not {type(name).__name__}")
    if size is not None:
        check_size(size)
    fonts = list(installed())
    query = _plain(name)
    ranked = sorted(
        (_rank(font, query), bool(size and font.size and font.size != size), *_likeness(font, bold, italic), number)
        for number, font in enumerate(fonts)
        if query and _rank(font, query) < 4
    )
    if not ranked:
        raise FileNotFoundError(_nothing(name, fonts))
    problems: list[Exception] = []
    for *_, number in ranked[:64]:
        try:
            return load(fonts[number].path, size, antialias, None)
        except (OSError, ValueError) as error:
            problems.append(error)
    wrong = [problem for problem in problems if isinstance(problem, ValueError)]
    if wrong and size is not None:
        best = ranked[0][0]
        sizes = {fonts[number].size for rank, *_, number in ranked if rank == best} - {0}
        also = f"; installed under that name: {', '.join(map(str, sorted(sizes)))}" if sizes else ""
        raise ValueError(f"{wrong[0]}{also}") from wrong[0]
    raise (wrong or problems)[0]


def installed() -> Iterator[Installed]:
    """Yield the fonts that are there."""
    for folder in folders():
        for place, _, files in os.walk(folder):
            listed = _listed(Path(place)) if "fonts.dir" in files else {}
            for file in sorted(files):
                if file.lower().endswith(_ENDINGS):
                    yield listed.get(file) or _by_name(Path(place, file))


def folders() -> list[Path]:
    """Where fonts are installed on this system."""
    home = Path.home()
    data = os.environ.get("XDG_DATA_DIRS") or "/usr/local/share:/usr/share"
    found = [home / ".fonts", Path(os.environ.get("XDG_DATA_HOME") or home / ".local/share") / "fonts"]
    found += _of_fontconfig(Path("/etc/fonts/fonts.conf"))
    found += [Path(part) / "fonts" for part in data.split(os.pathsep if sys.platform != "win32" else ";")]
    found += [Path("/usr/share", part) for part in ("consolefonts", "kbd/consolefonts", "unifont", "X11/fonts")]
    found += [Path("/usr/lib/kbd/consolefonts"), Path("/usr/share/fonts/X11")]
    found += [home / "Library/Fonts", *map(Path, ("/Library/Fonts", "/System/Library/Fonts", "/opt/X11/share/fonts"))]
    windows = [(os.environ.get("WINDIR"), "Fonts"), (os.environ.get("LOCALAPPDATA"), "Microsoft/Windows/Fonts")]
    found += [Path(root, part) for root, part in windows if root]
    kept: list[Path] = []
    for folder in dict.fromkeys(found):
        if folder.is_dir() and not any(other in folder.parents for other in kept):
            kept.append(folder)
    return kept


def _of_fontconfig(settings: Path) -> list[Path]:
    try:
        text = settings.read_text(encoding="utf-8", errors="replace")
    except OSError:
        return []
    named = re.findall(r"<dir(\s[^>]*)?>([^<]+)</dir>", text)
    return [Path(path.strip()).expanduser() for attributes, path in named if "prefix" not in attributes]


def _listed(folder: Path) -> dict[str, Installed]:
    """What X11's fonts.dir says: a file, and a name of fourteen parts."""
    found = {}
    try:
        text = (folder / "fonts.dir").read_text(encoding="latin-1")
    except OSError:
        return {}
    for line in text.splitlines():
        file, _, name = line.partition(" ")
        parts = name.split("-")
        if len(parts) == 15:
            style = parts[3] + (" italic" if parts[4] in "io" and parts[4] else "")
            kinds = [part for part in (parts[5], parts[6]) if part not in ("normal", "c", "")]
            size = int(parts[7]) if parts[7].isdigit() else 0
            family = " ".join([parts[2], *kinds])
            found[file] = Installed(folder / file, family, style, size, "-".join(parts[13:]))
    return found


def _by_name(path: Path) -> Installed:
    stem = path.name.split(".")[0]
    console = _CONSOLE.match(stem)
    if console:
        charset, family, first, second = console.groups()
        style = "bold" if family.endswith("Bold") else ""
        return Installed(path, family.removesuffix("Bold"), style, int(second or first), charset.lower())
    style, family = "", stem
    while found := _STYLE_AT_END.search(family.lower()):
        if not found.start():
            break
        style, family = found[1] + " " + style, family[: found.start()]
    return Installed(path, family, style, 0, "iso10646")


def _plain(name: str) -> str:
    return re.sub(r"[\W_]", "", name.lower())


def _rank(font: Installed, query: str) -> int:
    """How well a name fits: 0 the file's, 1 the family's, 2 its start, 3 a part of it, 4 not at all."""
    family = _plain(font.family)
    file = font.path.name
    if query == _plain(file) or query == _plain(file.split(".")[0]) != family:
        return 0
    return 1 if query == family else 2 if family.startswith(query) else 3 if query in family else 4


def _likeness(font: Installed, bold: bool, italic: bool) -> tuple[bool, bool, int, int]:
    charset = font.charset.lower()
    place = next((k for k, start in enumerate(_PREFERRED) if charset.startswith(start)), len(_PREFERRED))
    return font.bold != bold or font.italic != italic, not font.plain, len(font.family), place


def _nothing(name: str, fonts: list[Installed]) -> str:
    families = {_plain(font.family): font.family for font in reversed(fonts)}
    close = difflib.get_close_matches(_plain(name), families, 3, 0.6)
    meant = f"did you mean {' or '.join(families[key] for key in close)}? " if close else ""
    if not fonts:
        return f"no font {name!r} is installed, nor any other; Font.load(path, size) reads a file"
    some = ", ".join(sorted(families.values(), key=str.lower)[:40])
    more = f" and {len(families) - 40} more" if len(families) > 40 else ""
    return f"no font {name!r} is installed; {meant}there are {some}{more}; Font.load(path, size) reads a file"
