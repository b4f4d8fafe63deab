"""A menu that somebody walks through, and a message when something is chosen."""

from __future__ import annotations

from .. import Framebuffer
from ..widgets import Menu, Toast

STEP = 0.4
"""Seconds from one press of a button to the next."""

KEYS = "dd+dd+uu-ddd+uuuuu "
"""What is pressed: d down, u up, + and - choose, a blank nothing."""


def draw(fb: Framebuffer, t: float) -> None:
    """Draw the menu as it is after all keys that were pressed until now."""
    fb.clear()
    pressed, since = divmod(t / STEP, 1)
    keys = (2 * KEYS)[: 1 + int(pressed) % len(KEYS)]
    settings = {"Brightness": "80", "Contrast": "50", "Wi-Fi": "off", "Bluetooth": "off", "Night mode": "off",
                "Language": "en", "Date and time": "", "About": ""}  # fmt: skip
    names = list(settings)
    chosen, message = 0, ""
    for key in keys:
        name = names[chosen]
        message = ""
        if key in "+-":
            settings[name] = {"off": "on", "on": "off"}.get(settings[name], settings[name])
            message = f"{name}: {settings[name]}"
        chosen = min(max(chosen + {"d": 1, "u": -1}.get(key, 0), 0), len(names) - 1)
    entries = [(name, value) if value else name for name, value in settings.items()]
    Menu(entries, chosen, "SETTINGS").draw(fb)
    if message:
        Toast(message, share=min(3 * since, 3 - 3 * since, 1)).draw(fb)
