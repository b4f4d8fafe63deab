"""``python -m paneldraw`` is the command ``paneldraw``."""

import sys

from .cli import main

sys.exit(main())
