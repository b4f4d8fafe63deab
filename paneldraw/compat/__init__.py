"""Faces for scripts that were written for others: they move over by changing their imports."""
