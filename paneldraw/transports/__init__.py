"""What carries command and data bytes to a panel."""
