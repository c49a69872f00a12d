"""Section 6.2 of the paper to the letter, point by point, with the offset read as a vector."""

from __future__ import annotations


def transferred(
    chunks: list[tuple[bool, list[tuple[float, float]]]],
) -> list[list[tuple[float, float]]]:
    """Return the points of each chunk on the character's trajectory.

    A chunk is whether it travels, and the doodle's points over the ground; the last point of one
    chunk is the first of the next.
    """
    offset = (0.0, 0.0)
    moved = []
    for travels, points in chunks:
        applied = [(x + offset[0], z + offset[1]) for x, z in points]
        if not travels:
            (x0, z0), (xn, zn) = applied[0], applied[-1]
            offset = (offset[0] + x0 - xn, offset[1] + z0 - zn)
            applied = [applied[0]] * len(applied)
        moved.append(applied)
    return moved
