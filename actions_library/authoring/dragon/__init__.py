"""A small dragon: four legs, two wings, a tail, a face; made by code alone."""
