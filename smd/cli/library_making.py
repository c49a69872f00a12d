"""``smd library new`` and ``smd library import``: one's own character and clips."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from smd.cli.option_groups import unfolded

if TYPE_CHECKING:
    from actions_library.adoption.clip import Adopted
    from actions_library.importers import Imported
    from actions_library.library import Credit

SHOWN_NAMES = 40

Folder = Annotated[Path, typer.Argument(metavar="DIR", help="The library's folder.")]
Gestures = Annotated[
    str | None,
    typer.Option(
        metavar="LIBRARY",
        help="Draw its actions as those of the same name in this library: a folder, or a shipped "
        "library's name, such as humanoid.",
    ),
]


@dataclass(frozen=True, slots=True)
class ImportingOptions:
    """How the user said that a file is to be imported, and whose it is."""

    front: Annotated[
        str | None,
        typer.Option(
            help="Where the figure faces in the file: x, -x, z or -z, where the guess fails."
        ),
    ] = None
    up: Annotated[str | None, typer.Option(help="The file's up axis: x, y, z, -x, -y or -z.")] = (
        None
    )
    unit_m: Annotated[
        float | None, typer.Option("--unit", help="Metres per unit of the file, e.g. 0.01.")
    ] = None
    author: Annotated[str, typer.Option(help="Who made it; kept in library.json.")] = ""
    licence: Annotated[str, typer.Option(help="Under which licence; kept in library.json.")] = ""

    def imported(self, file: Path) -> Imported:
        """Read a file."""
        from actions_library.importers import import_file

        return import_file(file, up=self.up, unit_m=self.unit_m)

    def direction(self) -> tuple[float, float, float] | None:
        """Return where the figure faces; LibraryError if that is no direction."""
        from smd.errors import LibraryError

        directions = {
            "x": (1.0, 0.0, 0.0),
            "-x": (-1.0, 0.0, 0.0),
            "z": (0.0, 0.0, 1.0),
            "-z": (0.0, 0.0, -1.0),
        }
        if self.front is None:
            return None
        if self.front not in directions:
            raise LibraryError(
                f"front: expected one of {', '.join(directions)}, got {self.front!r}"
            )
        return directions[self.front]

    def credit(self) -> Credit:
        """Return whose it is."""
        from actions_library.library import Credit

        return Credit(self.author, self.licence)


@dataclass(frozen=True, slots=True)
class ClipOptions:
    """Which part of a file the user said that a clip is, and what it is to be."""

    clip: Annotated[
        str | None, typer.Option(help="Which of the file's animations; default: the only one.")
    ] = None
    travels: Annotated[
        bool | None,
        typer.Option("--travels/--in-place", help="Whether it moves along the doodle's path."),
    ] = None
    cyclic: Annotated[bool | None, typer.Option("--cyclic/--once", help="Whether it repeats.")] = (
        None
    )
    start_s: Annotated[
        float | None, typer.Option("--start", help="Begin here, in seconds.", min=0.0)
    ] = None
    end_s: Annotated[float | None, typer.Option("--end", help="End here, in seconds.", min=0.0)] = (
        None
    )
    description: Annotated[str, typer.Option(help="What the gesture of the prop will be.")] = ""


@unfolded
def new(
    folder: Folder,
    *,
    character: Annotated[
        Path,
        typer.Option(metavar="FILE", help="A glTF, GLB or USD file with a skinned character."),
    ],
    importing: ImportingOptions,
    gestures: Gestures = None,
) -> None:
    """Make a library of a character of one's own.

    It idles with the file's animation of that name, or stands; `smd library import` adds clips.
    With --gestures, the file's animations that are called as an action of that library are
    imported, and drawn as there.
    """
    import smd
    from actions_library.adoption.character import plan_of
    from actions_library.adoption.library import library_from
    from smd.cast import IDLE

    lender = None if gestures is None else smd.load_library(gestures)
    imported = importing.imported(character)
    library, played = library_from(
        folder,
        imported,
        front=importing.direction(),
        credit=importing.credit(),
        lender=lender,
    )
    idling = played.pop(IDLE, None)
    figure = library.character
    shapes = f", {len(figure.shapes)} shapes" if figure.shapes else ""
    typer.echo(
        f"{library.folder}: {figure.height_m:.2f} m tall, {len(figure.skeleton)} joints, "
        f"{len(figure.meshes)} meshes{shapes}"
    )
    typer.echo("\n".join(_plan_lines(imported, plan_of(imported, front=importing.direction()))))
    typer.echo(f"  idles with: {idling or 'its rest pose, since no animation is called idle'}")
    if lender is not None:
        drawn = [f"{action} ({animation})" for action, animation in played.items()]
        typer.echo(f"  drawn as in {lender.name}: {_some(drawn) or 'none is called as an action'}")
    names = [a.name for a in imported.animations]
    typer.echo(f"  animations in the file: {_some(names) or 'none'}")
    for note in imported.notes:
        typer.echo(f"  note: {note}")


@unfolded
def import_(
    folder: Folder,
    *,
    file: Annotated[
        Path, typer.Argument(metavar="FILE", help="A BVH, glTF, GLB or USD file with the clip.")
    ],
    action: Annotated[str, typer.Option(help="The action that the clip shows.")],
    clip: ClipOptions,
    importing: ImportingOptions,
    replace: Annotated[
        bool, typer.Option("--replace", help="Take the place of the action's present clip.")
    ] = False,
    gestures: Gestures = None,
) -> None:
    """Import a clip as an action.

    A clip of another skeleton of the same kind is carried over. What is found out about it is
    printed, and can be overruled. `smd learn ACTION` then teaches its gesture, unless --gestures
    says where it is from.
    """
    import smd
    from actions_library.adoption.library import import_clip
    from smd.cast import IDLE
    from smd.errors import LibraryError

    library = smd.load_library(folder)
    there = {known.name for known in library.actions}
    if action in there and not replace and action != IDLE:
        raise LibraryError(
            f"{folder}: action {action!r} is there already: expected another name, or --replace"
        )
    imported = importing.imported(file)
    part = imported.part(imported.animation(clip.clip), clip.start_s, clip.end_s)
    library, adopted = import_clip(
        library,
        imported,
        part,
        action,
        travels=clip.travels,
        cyclic=clip.cyclic,
        front=importing.direction(),
        description=clip.description,
        credit=importing.credit(),
        lender=None if gestures is None else smd.load_library(gestures),
    )
    typer.echo("\n".join(_clip_lines(adopted, part.name)))
    for note in imported.notes:
        typer.echo(f"  note: {note}")
    if action != IDLE and library.action(action).pattern is None:
        typer.echo(f"  no gesture yet: smd learn {action} RECORDING… --library {folder}")


def _plan_lines(imported: Imported, plan: object) -> list[str]:
    """Return what the joints were taken for."""
    from smd.character.roles import BodyPlan

    assert isinstance(plan, BodyPlan)
    names = imported.skeleton.joints
    head = "none" if plan.head is None else names[plan.head]
    lines = [f"  pelvis {names[plan.pelvis]}, chest {names[plan.chest]}, head {head}"]
    lines += [
        f"  {limb.side} {limb.kind}: {names[limb.upper]}, {names[limb.middle]}, {names[limb.end]}"
        for limb in plan.limbs
    ]
    x, _, z = plan.front
    lines.append(f"  faces ({x:.2f}, 0, {z:.2f}) in the file")
    return lines


def _clip_lines(adopted: Adopted, name: str) -> list[str]:
    """Return what was found out about a clip."""
    from smd.character.clip import STAGES
    from smd.character.kinematics import forward_kinematics
    from smd.character.quality import mean_slide_m_s

    clip, ground = adopted.clip, adopted.ground
    manner = "travels" if ground.travels else "in place"
    way = f", {clip.travel_m:.2f} m" if ground.travels else ""
    belt = ", from feet that slid as on a treadmill" if ground.treadmill else ""
    kept = "the character's own skeleton" if adopted.same_skeleton else "carried over by roles"
    lines = [
        f"{clip.name}: {name}, {len(clip)} frames at {clip.rate_hz:g} Hz, {clip.duration_s:.2f} s",
        f"  {manner}{', cyclic' if clip.cyclic else ''}{way}{belt}; {kept}",
    ]
    _, place = forward_kinematics(clip.skeleton, clip.rotation_xyzw, clip.translation_m)
    touching = ", ".join(
        f"{joint} {100 * share:.0f} %"
        for joint, share in zip(clip.contact_joints, clip.contacts.mean(axis=0), strict=True)
    )
    slide = f", sliding {mean_slide_m_s(clip, place):.2f} m/s on average" if touching else ""
    lines.append(f"  touches the ground: {touching or 'never'}{slide}")
    if clip.tracks.names:
        lines.append(f"  {len(clip.tracks.names)} tracks: {_some(clip.tracks.names)}")
    if adopted.left_out:
        lines.append(
            f"  note: the character lacks {len(adopted.left_out)} shapes that the file moves, "
            f"left out: {_some(adopted.left_out)}"
        )
    if not clip.cyclic:
        ends = zip(STAGES, clip.stage_end_frames / clip.rate_hz, strict=True)
        lines.append("  stages end at " + ", ".join(f"{stage} {t:.2f} s" for stage, t in ends))
    return lines


def _some(names: Sequence[str]) -> str:
    """Return names in a line, the first of them where there are many."""
    from laban.faults import printable

    more = f" and {len(names) - SHOWN_NAMES} more" if len(names) > SHOWN_NAMES else ""
    return printable(", ".join(names[:SHOWN_NAMES])) + more
