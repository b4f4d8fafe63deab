"""luma's face: its scripts run after ``luma`` in their imports became ``paneldraw.compat.luma``.

The modules have luma's names: `core.render`, `core.virtual`, `core.interface.serial`, `core.sprite_system`,
`core.cmdline`, `core.legacy`, `oled.device`, `lcd.device`, `led_matrix.device`. A device shows by `paneldraw.Panel`, so
only what changed travels.
"""

from __future__ import annotations

from paneldraw.compat.luma import core

__all__ = ["core"]
