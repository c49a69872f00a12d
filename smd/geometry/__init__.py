"""Rotations, rigid transforms, resampling and easing: arrays in, arrays out, no project types."""
