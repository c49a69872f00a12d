"""Rotations, rigid transforms, frames and resampling: arrays in, arrays out, no project types."""
