"""What was recognised in a recording, drawn below its trajectory.

For each device, on one time axis: where the prop went and how fast, the tokens of its movement,
the phrases of the Score, and their Effort; where tracking was lost is hatched. What the Score
suggests, and no phrase explains, is hollow; phrases that are implied are pale. Where it was acted
out by a character with shapes, their weights are below.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from exporters.palette import IDLE_RGB, RGB, action_colors, effort_color
from laban import AXES, EffortCurve, RigidMotion, effort_over_time, load_effort_model
from smd.errors import DoodleError
from smd.files import replacing
from smd.recognition.alphabet import Direction
from smd.recognition.tokenizer import tokenize
from smd.recognition.tokens import Token, TokenRun
from smd.smoothing import smooth

if TYPE_CHECKING:
    from smd.acting.performance import Performance
    from smd.character.tracks import Tracks
    from smd.doodle import Doodle, Dropout, Recording
    from smd.score import Part, Score

DPI = 110
_INCHES_PER_S, _LEAST_INCHES, _MOST_INCHES = 0.75, 13.0, 80.0
_LANES = {"trajectory": 2.0, "moves": 0.42, "turns": 0.42, "phrase": 0.55, "effort": 0.9}
"""Height of each lane in inches, from top to bottom."""

_TRACKS, _TRACKS_INCHES, _NAMED_TRACKS = "tracks", 0.9, 7
"""The lane of an actor's tracks, where it has some, and how many of them have their name beside."""

_SIDES_INCHES, _HEAD_INCHES, _FOOT_INCHES, _BETWEEN_INCHES = (0.95, 0.75), 0.62, 0.2, 0.6
_LETTER_INCHES = 0.066  # at 8 points, of most names
_AXIS_COLORS = {"x": "#d6455d", "y": "#37a562", "z": "#3b6fd4"}
_HALVES = {"": (0.08, 0.84), "upper": (0.53, 0.41), "lower": (0.06, 0.41)}
"""Bottom and height of a block, as shares of its lane."""

_INK, _FAINT, _RULE = "#23262a", "#60666e", "#d5d8dc"


@dataclass(frozen=True, slots=True)
class Block:
    """A span of time in a lane; the first of its texts that fits is written in it.

    A hollow one is an outline in its colour; it has the height of the lane, or of a half.
    """

    start_s: float
    end_s: float
    texts: tuple[str, ...]
    color: RGB
    hollow: bool = False
    half: Literal["", "upper", "lower"] = ""


def write_timeline(
    recording: Recording,
    score: Score,
    png_path: Path | str,
    performance: Performance | None = None,
) -> None:
    """Draw a recording's trajectories, tokens, phrases and Effort on one time axis.

    Parameters
    ----------
    recording
        What was played.
    score
        What was understood of it.
    png_path
        The picture: 0.75 inches a second at 110 dots an inch, 13 to 80 inches wide.
    performance
        What was made of it, if its actors' tracks are to be drawn.

    Raises
    ------
    ExportError
        If the picture cannot be written.
    """
    parts = [part for part in score.performers if part.device in recording.devices]
    first_s = min(doodle.time_s[0] for doodle in recording.doodles)
    last_s = max(doodle.time_s[-1] for doodle in recording.doodles)
    model = load_effort_model()
    colors = action_colors(phrase.action for part in score.performers for phrase in part.phrases)
    tracks = _tracks_of(performance)
    tracked = [part.device in tracks for part in parts]
    figure, lanes = _sheet(tracked, float(first_s), float(last_s))
    for part, axes in zip(parts, lanes, strict=True):
        motions = list(_motions(recording.of(part.device)))
        strings = [
            tokenize(
                motion,
                figure_height_m=score.figure_height_m,
                drawing=doodle.drawing_at(motion.time_s),
            )
            for doodle, motion in motions
        ]
        _draw_trajectory(axes["trajectory"], [motion for _, motion in motions], part.device)
        _draw_blocks(axes["moves"], _token_blocks(strings, lambda token: token.translation, "T"))
        _draw_blocks(axes["turns"], _token_blocks(strings, lambda token: token.rotation, "R"))
        _draw_blocks(axes["phrase"], _phrase_blocks(part, colors) + _suggestion_blocks(part))
        curves = [effort_over_time(motion, model) for _, motion in motions]
        _draw_effort(axes["effort"], part, curves)
        if performance is not None and part.device in tracks:
            _draw_tracks(axes[_TRACKS], tracks[part.device], performance)
        _mark_dropouts(axes, [d for d in recording.dropouts if d.device == part.device])
    figure.suptitle(
        f"{Path(score.recording or recording.source).name}    {first_s:.2f} to {last_s:.2f} s",
        x=_SIDES_INCHES[0] / figure.get_figwidth(),
        y=1.0 - 0.12 / figure.get_figheight(),
        ha="left",
        va="top",
        fontsize=12,
        color=_INK,
    )
    with replacing(Path(png_path)) as temporary:
        # Without the program's version and date, the same input gives the same picture.
        figure.savefig(temporary, format="png", dpi=DPI, metadata={"Software": None})


def _motions(doodles: Iterable[Doodle]) -> Iterable[tuple[Doodle, RigidMotion]]:
    """Yield each doodle that is long enough to have a speed, smoothed."""
    for doodle in doodles:
        try:
            yield doodle, smooth(doodle)
        except DoodleError:
            continue


def _tracks_of(performance: Performance | None) -> dict[str, Tracks]:
    """Return the tracks of each actor that has some, by its name."""
    actors = () if performance is None else performance.actors
    return {actor.name: actor.tracks for actor in actors if actor.tracks.names}


def _sheet(
    tracked: Sequence[bool], first_s: float, last_s: float
) -> tuple[Figure, list[dict[str, Any]]]:
    """Return an empty figure with the lanes of each device, all on one time axis."""
    last_s = max(last_s, first_s + 0.1)
    width = float(np.clip(_INCHES_PER_S * (last_s - first_s), _LEAST_INCHES, _MOST_INCHES))
    block = sum(_LANES.values()) + _BETWEEN_INCHES
    height = _HEAD_INCHES + max(len(tracked), 1) * block + _FOOT_INCHES
    height += sum(tracked) * _TRACKS_INCHES
    figure = Figure(figsize=(width, height), facecolor="white")
    FigureCanvasAgg(figure)
    left, right = _SIDES_INCHES
    lanes, top = [], height - _HEAD_INCHES
    for has_tracks in tracked:
        axes = {}
        inches_of = _LANES | ({_TRACKS: _TRACKS_INCHES} if has_tracks else {})
        for name, inches in inches_of.items():
            top -= inches
            box = (left / width, top / height, (width - left - right) / width, inches / height)
            axes[name] = _lane(figure.add_axes(box), name, first_s, last_s)
        axes[name].tick_params(bottom=True, labelbottom=True)
        top -= _BETWEEN_INCHES
        lanes.append(axes)
    if lanes:
        lowest = list(lanes[-1].values())[-1]
        lowest.set_xlabel("seconds on the recording's clock", color=_FAINT, fontsize=9)
    return figure, lanes


def _lane(axes: Any, name: str, first_s: float, last_s: float) -> Any:
    axes.set_xlim(first_s, last_s)
    axes.tick_params(
        bottom=False, labelbottom=False, left=False, labelsize=8, colors=_FAINT, length=3
    )
    for spine in axes.spines.values():
        spine.set_color(_RULE)
    axes.annotate(
        "" if name == "trajectory" else name,
        (0.0, 0.5),
        (-30 if name in ("effort", _TRACKS) else -8, 0),
        xycoords="axes fraction",
        textcoords="offset points",
        ha="right",
        va="center",
        fontsize=9,
        color=_INK,
    )
    if name not in ("trajectory", "effort", _TRACKS):
        axes.set_ylim(0.0, 1.0)
        axes.set_yticks([])
    return axes


def _draw_trajectory(axes: Any, motions: Sequence[RigidMotion], device: str) -> None:
    """Draw the position in metres, and the speed behind it."""
    axes.set_ylabel("metres", rotation=90, fontsize=8, color=_FAINT, labelpad=4)
    axes.tick_params(left=True, labelleft=True)
    axes.grid(axis="x", color=_RULE, linewidth=0.5)
    fast = axes.twinx()
    fast.tick_params(colors=_FAINT, labelsize=8, length=3)
    fast.set_ylabel("speed, m/s", fontsize=8, color=_FAINT)
    fast.spines[:].set_color(_RULE)
    fast.set_zorder(axes.get_zorder() - 1)
    axes.patch.set_visible(False)
    for index, motion in enumerate(motions):
        speed = np.linalg.norm(motion.velocity_m_s, axis=1)
        fast.fill_between(motion.time_s, speed, color="#c9ced6", linewidth=0, alpha=0.6)
        for k, (name, color) in enumerate(_AXIS_COLORS.items()):
            label = name if index == 0 else None
            axes.plot(motion.time_s, motion.position_m[:, k], color=color, lw=1.2, label=label)
    fast.set_ylim(bottom=0.0)
    axes.set_title(device, loc="left", fontsize=11, color=_INK, pad=3, fontweight="bold")
    if motions:
        axes.legend(loc="upper right", ncols=3, fontsize=8, frameon=False, borderaxespad=0.1)


def _token_blocks(
    strings: Iterable[Sequence[TokenRun]], part: Callable[[Token], Direction], letter: str
) -> list[Block]:
    """Return one block for each stretch in which one half of the token stays the same."""
    blocks = []
    for runs in strings:
        for direction, group in groupby(runs, key=lambda run: part(run.token)):
            members = list(group)
            if any(direction):
                token = Token(direction) if letter == "T" else Token(rotation=direction)
                span = members[0].start_s, members[-1].end_s
                blocks.append(Block(*span, (str(token),), _direction_color(direction)))
    return blocks


def _direction_color(direction: Direction) -> RGB:
    """Return a colour that mixes X as red, Y as green and Z as blue; opposites are complements."""
    unit = np.array(direction) / np.linalg.norm(direction)
    red, green, blue = (0.62 + 0.3 * unit).tolist()
    return red, green, blue


def _phrase_blocks(part: Part, colors: dict[str, RGB]) -> list[Block]:
    blocks = []
    for phrase in part.phrases:
        name = phrase.action
        span = phrase.start_s, phrase.end_s
        if phrase.implied:
            blocks.append(Block(*span, (name,), _paler(colors[name]), half="lower"))
        else:
            texts = f"{name} {round(100 * phrase.confidence)} %", name, name.replace("_", "\n")
            blocks.append(Block(*span, texts, colors[name]))
    return blocks


def _paler(color: RGB) -> RGB:
    """Return a colour two thirds of the way to white."""
    red, green, blue = ((2.0 + value) / 3.0 for value in color)
    return red, green, blue


def _suggestion_blocks(part: Part) -> list[Block]:
    """Return what no phrase explains, hollow: what it is most like, with a question mark.

    Above implied phrases, which may be where they are, they have the upper half.
    """
    shares = any(phrase.implied for phrase in part.phrases)
    blocks = []
    for suggestion in part.suggestions:
        name, span = suggestion.action, (suggestion.start_s, suggestion.end_s)
        if shares:
            blocks.append(Block(*span, (f"{name}?", "?"), IDLE_RGB, hollow=True, half="upper"))
        else:
            texts = f"{name}?", name.replace("_", "\n") + "?", "?"
            blocks.append(Block(*span, texts, IDLE_RGB, hollow=True))
    return blocks


def _draw_blocks(axes: Any, blocks: Sequence[Block]) -> None:
    """Draw a lane of coloured blocks, each with a text where one fits."""
    for half, extent in _HALVES.items():
        some = [block for block in blocks if block.half == half]
        axes.broken_barh(
            [(block.start_s, block.end_s - block.start_s) for block in some],
            extent,
            facecolors=["none" if block.hollow else block.color for block in some],
            edgecolors=[block.color if block.hollow else "white" for block in some],
            linewidths=[1.2 if block.hollow else 0.6 for block in some],
        )
    for block in blocks:
        bottom, height = _HALVES[block.half]
        text = _fitting(axes, block)
        if text:
            bright = block.hollow or np.dot(block.color, (0.3, 0.59, 0.11)) > 0.58
            axes.text(
                0.5 * (block.start_s + block.end_s),
                bottom + 0.47 * height,
                text,
                ha="center",
                va="center",
                fontsize=8,
                color=_INK if bright else "white",
                clip_on=True,
            )


def _fitting(axes: Any, block: Block) -> str:
    """Return the first of the block's texts that is not wider than it, or nothing."""
    inches = axes.get_figure().get_figwidth() * axes.get_position().width
    low, high = axes.get_xlim()
    room = inches * (block.end_s - block.start_s) / (high - low)
    for text in block.texts:
        letters = max(len(line) for line in text.splitlines())
        if _LETTER_INCHES * letters + 0.04 < room:
            return text
    return ""


def _draw_effort(axes: Any, part: Part, curves: Sequence[EffortCurve]) -> None:
    """Draw Effort from the middle, up is sudden, strong, direct, bound: phrases as bars.

    Thin lines show it in a sliding window, as a stream would read it, phrase or not.
    """
    axes.set_ylim(-1.15, 1.15)
    axes.set_yticks([-1, 0, 1], ["−1", "0", "+1"])
    axes.tick_params(left=True, labelleft=True)
    axes.axhline(0.0, color=_RULE, linewidth=0.8)
    shown = [
        axis for axis in AXES if any(getattr(p.effort, axis) is not None for p in part.phrases)
    ]
    for index, axis in enumerate(shown):
        bars = [
            (p.start_s + (p.end_s - p.start_s) * (index + 0.1) / len(shown), p.end_s - p.start_s, v)
            for p in part.phrases
            if (v := getattr(p.effort, axis)) is not None
        ]
        axes.bar(
            [left for left, _, _ in bars],
            [value for _, _, value in bars],
            width=[0.8 * length / len(shown) for _, length, _ in bars],
            align="edge",
            color=effort_color(axis),
            label=axis,
        )
    for curve in curves:
        for axis in shown:
            values = curve.values[:, AXES.index(axis)]
            axes.plot(curve.time_s, values, color=effort_color(axis), linewidth=0.9, alpha=0.75)
    if shown:
        axes.legend(
            loc="center left",
            bbox_to_anchor=(1.0, 0.5),
            fontsize=8,
            frameon=False,
            handlelength=0.8,
            labelspacing=0.2,
            borderaxespad=0.3,
        )


def _draw_tracks(axes: Any, tracks: Tracks, performance: Performance) -> None:
    """Draw an actor's tracks, those that change most first, the names of a few beside."""
    time_s = performance.start_s + np.arange(len(performance)) / performance.rate_hz
    most_first = np.argsort(-np.ptp(tracks.value, axis=0), kind="stable")
    low, high = min(tracks.value.min(), 0.0), max(tracks.value.max(), 1.0)
    axes.set_ylim(low - 0.08, high + 0.08)
    axes.tick_params(left=True, labelleft=True)
    for rank, k in enumerate(most_first.tolist()):
        label = tracks.names[k] if rank < _NAMED_TRACKS else None
        axes.plot(time_s, tracks.value[:, k], color=f"C{rank % 10}", lw=1.0, label=label)
    axes.legend(
        loc="center left",
        bbox_to_anchor=(1.0, 0.5),
        fontsize=7,
        frameon=False,
        handlelength=0.8,
        labelspacing=0.1,
        borderaxespad=0.3,
    )


def _mark_dropouts(axes: dict[str, Any], dropouts: Sequence[Dropout]) -> None:
    """Hatch where tracking was lost: light where it was bridged, dark where the doodle splits."""
    for dropout in dropouts:
        for lane in axes.values():
            lane.axvspan(
                dropout.start_s,
                dropout.end_s,
                facecolor="#f6c9b4" if dropout.bridged else "#d98a6a",
                alpha=0.45,
                hatch="" if dropout.bridged else "////",
                edgecolor="#a0522d",
                linewidth=0,
            )
