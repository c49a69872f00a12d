"""Skeleton, clips, meshes and how they move."""
