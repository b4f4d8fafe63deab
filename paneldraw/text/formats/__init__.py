"""Readers of the world's bitmap fonts."""
