"""Byte-level panels, buses and recorders: the whole path with no hardware."""
