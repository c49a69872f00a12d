"""Tracks: named numbers over time beside the joints: weights of shapes, and any other control."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from laban.frozen import Frozen
from smd.errors import CharacterError
from smd.geometry.arrays import FloatArray, frozen_array


@dataclass(frozen=True, slots=True, eq=False)
class Tracks(Frozen):
    """Named numbers, a value each frame.

    A track is 0 where nobody says otherwise: two sets of tracks may have different names.

    Attributes
    ----------
    names : unique.
    value : (n, k) float64, a column a name.
    """

    names: tuple[str, ...]
    value: FloatArray

    def __post_init__(self) -> None:
        names = tuple(self.names)
        if len(set(names)) != len(names):
            twice = next(name for name in names if names.count(name) > 1)
            raise CharacterError(f"tracks: {twice!r} appears twice")
        object.__setattr__(self, "names", names)
        value = frozen_array("tracks", self.value, (None, len(names)), CharacterError)
        object.__setattr__(self, "value", value)

    def __len__(self) -> int:
        return len(self.value)

    def over(self, count: int, error: type[Exception] = CharacterError) -> Tracks:
        """Return these tracks, if they have so many frames; without names they fit any number.

        Raises
        ------
        error
            If they have more or fewer frames.
        """
        if len(self) == count:
            return self
        if self.names:
            raise error(f"tracks: expected {count} frames, got {len(self)}")
        return Tracks((), np.zeros((count, 0)))

    def of(self, names: Iterable[str]) -> FloatArray:
        """Return the values of some names ``(n, k)``, 0 for those that have no track."""
        wanted = tuple(names)
        found = np.zeros((len(self), len(wanted)))
        column = {name: k for k, name in enumerate(self.names)}
        for k, name in enumerate(wanted):
            if name in column:
                found[:, k] = self.value[:, column[name]]
        return found

    def among(self, names: Iterable[str]) -> Tracks:
        """Return the tracks that have one of some names."""
        wanted = set(names)
        kept = [name for name in self.names if name in wanted]
        return Tracks(tuple(kept), self.of(kept))

    def without(self, names: Iterable[str]) -> Tracks:
        """Return the tracks that have none of some names."""
        return self.among(set(self.names) - set(names))

    def beside(self, other: Tracks) -> Tracks:
        """Return these tracks and others, of other names and as many frames."""
        if not other.names or not self.names:
            return self if self.names else other
        value = np.concatenate([self.value, other.over(len(self)).value], axis=-1)
        return Tracks(self.names + other.names, value)

    def at(self, frame: FloatArray) -> Tracks:
        """Return the tracks at fractional frames ``(m,)`` from 0 to n - 1, linear between two."""
        if not self.names:
            return self.over(len(frame))
        left = np.clip(frame.astype(np.int64), 0, max(len(self) - 2, 0))
        right = np.minimum(left + 1, len(self) - 1)
        share = (frame - left)[:, None]
        before = self.value[left]
        return Tracks(self.names, before + share * (self.value[right] - before))


NO_TRACKS = Tracks((), np.zeros((0, 0)))
"""They fit any number of frames."""
