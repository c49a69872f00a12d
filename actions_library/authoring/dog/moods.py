"""Moods: how a happy and a sad dog go, from how a dog goes.

A happy dog carries head, ears and tail high, bounces, steps high and wags; a sad one goes low and
slowly, with short flat steps, the head and the tail down and the ears laid back [1]_.

References
----------
.. [1] C. Darwin, "The Expression of the Emotions in Man and Animals", 1872, chapters 2 and 5.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from actions_library.authoring.gait import GaitDiagram, Step
from actions_library.authoring.keys import Place, Turn
from actions_library.authoring.posing import RATE_HZ
from actions_library.authoring.rig_keys import Part, RigKey, mirrored_key
from actions_library.authoring.waves import Wave


@dataclass(frozen=True, slots=True)
class Mood:
    """What a mood changes of a gait.

    Attributes
    ----------
    name : after the gait's; empty for none.
    period, stride, duty, lift : shares of the gait's own.
    up : of the body (m).
    bounce : share of the gait's own rise and fall.
    head, tail : lean more (°).
    left_ear : turns more; the right one is its mirror image.
    wag : of the tail's tip, to each side of each joint (°).
    wags_hz : about so often; a whole number of them in a cycle.
    """

    name: str = ""
    period: float = 1.0
    stride: float = 1.0
    duty: float = 1.0
    lift: float = 1.0
    up: float = 0.0
    bounce: float = 1.0
    head: float = 0.0
    tail: float = 0.0
    left_ear: Turn = field(default_factory=Turn)
    wag: float = 0.0
    wags_hz: float = 4.0

    def named(self, gait: str) -> str:
        """Return what a gait is called in this mood."""
        return f"{gait}_{self.name}" if self.name else gait

    def gait(self, plain: GaitDiagram) -> GaitDiagram:
        """Return when and where feet land; the period is whole frames."""
        frames = round(self.period * plain.period_s * RATE_HZ)
        return GaitDiagram(
            frames / RATE_HZ,
            self.stride * plain.stride_m,
            plain.phase,
            self._step(plain.step),
            {leg: self._step(step) for leg, step in plain.own.items()},
        )

    def keys(self, plain: Sequence[RigKey]) -> tuple[RigKey, ...]:
        """Return how the body is carried."""
        ups = [part.up for one in plain for part in one.parts.values() if isinstance(part, Place)]
        middle = sum(ups) / len(ups)
        return tuple(
            replace(one, parts={n: self._part(n, part, middle) for n, part in one.parts.items()})
            for one in plain
        )

    def waves(self, period_s: float) -> Sequence[Wave]:
        """Return how the tail wags."""
        if self.wag == 0.0:
            return ()
        times = max(round(self.wags_hz * period_s), 1)
        wave = Wave("tail", "yaw", 0.4 * self.wag, tip=self.wag, wavelength=2.0, per_cycle=times)
        return (wave,)

    def _step(self, step: Step) -> Step:
        return replace(step, duty=self.duty * step.duty, lift=self.lift * step.lift)

    def _part(self, name: str, part: Part, middle: float) -> Part:
        if isinstance(part, Place):
            return replace(part, up=middle + self.bounce * (part.up - middle) + self.up)
        more = {"head": Turn(lean=self.head), "tail": Turn(lean=self.tail)}
        more["left_ear"] = self.left_ear
        more.update(mirrored_key(RigKey(0.0, {"left_ear": self.left_ear})).parts)  # type: ignore[arg-type]
        if name not in more or not isinstance(part, Turn):
            return part
        add = more[name]
        return Turn(part.yaw + add.yaw, part.lean + add.lean, part.tilt + add.tilt)


PLAIN = Mood()
HAPPY = Mood(
    "happy",
    period=0.88,
    stride=0.94,
    duty=0.94,
    lift=1.35,
    up=-0.004,
    bounce=1.5,
    head=-20.0,
    tail=40.0,
    left_ear=Turn(lean=-6.0, tilt=16.0),
    wag=11.0,
)
SAD = Mood(
    "sad",
    period=1.35,
    stride=0.72,
    duty=1.05,
    lift=0.6,
    up=-0.022,
    bounce=0.6,
    head=55.0,
    tail=-125.0,
    left_ear=Turn(lean=24.0, tilt=-6.0),
)
