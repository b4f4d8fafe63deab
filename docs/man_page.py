"""Writes the command's man page from its parser: `python docs/man_page.py`, with Python 3.11 and argparse-manpage."""

from __future__ import annotations

import os
import re
from pathlib import Path
from unittest.mock import patch

from argparse_manpage.manpage import Manpage

from paneldraw.cli import _parser

PAGE = Path(__file__).with_name("paneldraw.1")


def page() -> str:
    """Return the man page, which bears no date: it is as old as the parser."""
    with patch.dict(os.environ, COLUMNS="80"):
        text = str(Manpage(_parser()))
    text = re.sub(r"^\.TH .*$", r'.TH PANELDRAW "1" "" "paneldraw" "User Commands"', text, count=1, flags=re.M)
    return text.replace(".SH NAME\npaneldraw\n", ".SH NAME\npaneldraw \\- draw on OLED, LCD and LED panels\n", 1)


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
