"""LED matrices and seven-segment displays."""
