"""LCD panels."""
