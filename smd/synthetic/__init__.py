"""Doodles with known answers: simple curves, gestures of simulated people, stories."""
