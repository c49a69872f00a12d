"""Figures that the documentation quotes; each runs alone: ``python -m benchmarks.<name>``."""
