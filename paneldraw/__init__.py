"""Draw on serial OLED, LCD and LED panels; only what changed travels."""
