"""OLED panels."""
