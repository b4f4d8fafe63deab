"""Whether a choice is a certain word, the one that most calls make; compiled modules have it from _words.pxd."""

from __future__ import annotations

__all__ = ["is_word"]


def is_word(value: object, word: str) -> bool:
    return type(value) is str and value == word
