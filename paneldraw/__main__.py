"""``python -m paneldraw`` is the command ``paneldraw``."""

import sys

from paneldraw.cli import main

sys.exit(main())
