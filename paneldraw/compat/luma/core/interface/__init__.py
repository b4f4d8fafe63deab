"""What panels are on."""
