"""Scan conversion: which pixels a shape covers, and by how much. Knows pixels and nothing else."""
