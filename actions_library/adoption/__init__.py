"""Adoption: what was imported becomes a library's character and clips."""
