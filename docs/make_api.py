"""Write docs/api.md from the code: ``python docs/make_api.py``, from the root of a checkout."""

from __future__ import annotations

import ast
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from importlib import import_module
from inspect import cleandoc
from pathlib import Path

ROOT = Path(__file__).parents[1]
PAGE = ROOT / "docs" / "api.md"

INTRODUCTION = """# Names for programmers

One line each, from the first line of its docstring: `help(smd.parse)` tells the rest.
[Examples](../examples/README.md) show them at work. What is not on this page may change without
notice. The page is written by `python docs/make_api.py`; a test compares it with the code.
"""


@dataclass(frozen=True)
class Section:
    """Names for one purpose; ``names`` maps the module they are imported from to them."""

    title: str
    says: str
    names: dict[str, Sequence[str]]


def sections() -> list[Section]:
    """Return what the page holds; the names of faces are taken from their ``__all__``."""
    smd, laban = import_module("smd"), import_module("laban")
    importers = import_module("actions_library.importers")
    return [
        Section(
            "`smd`",
            "From a recording to a Score, and from there to an animation.",
            {"smd": smd.__all__},
        ),
        Section(
            "`laban`",
            "Effort of any rigid body's movement; it needs nothing of `smd`.",
            {"laban": laban.__all__},
        ),
        Section(
            "Libraries",
            "What can be performed: read, checked, written, extended.",
            {
                "actions_library.library": ["Credit", "Library"],
                "actions_library.folder": ["write_library"],
                "actions_library.checking": ["Findings", "check_library"],
                "actions_library.extension": [
                    "add_action",
                    "new_library",
                    "put_clip",
                    "put_examples",
                    "rehearsed_library",
                ],
                "actions_library.importers": importers.__all__,
                "actions_library.adoption.library": ["import_clip", "library_from"],
            },
        ),
        Section(
            "Scores, phrase by phrase",
            "What `smd.parse` returns and `smd.animate` takes, made or changed in a program.",
            {"smd.score": ["Alternative", "Part", "Suggestion"]},
        ),
        Section(
            "Recognition",
            "Gestures taught, and found in a whole doodle or while it is drawn.",
            {
                "smd.recognition": import_module("smd.recognition").__all__,
                "smd.recognition.action": ["Action"],
                "smd.recognition.bank": ["compile_library"],
                "smd.recognition.streaming": ["RecognitionStream"],
                "smd.recognition.token_spotter": ["TokenSpotter"],
            },
        ),
        Section(
            "Tracked devices",
            "Recorded, or recognised as they move.",
            {
                "smd.capture.opening": ["open_source"],
                "smd.capture.replay": ["ReplaySource"],
                "smd.capture.selection": ["chosen_devices"],
                "smd.capture.recorder": ["Recorder"],
                "smd.capture.take": ["record", "rows_of"],
                "smd.capture.live": ["LiveRecognition"],
            },
        ),
        Section(
            "Acting",
            "Whoever brings moves or poses of their own gets actors, and a `Performance` of them.",
            {
                "smd.acting.act": ["Frames", "act", "grounded_actor"],
                "smd.acting.move": ["Footwork", "Move", "Playable"],
                "smd.acting.legs": ["feet_of", "legs_of"],
                "smd.transfer.repertoire": ["Piece", "piece_of"],
                "smd.acting.performance": ["Actor"],
                "smd.acting.terrain": ["Terrain"],
            },
        ),
        Section(
            "Characters",
            "What is posed.",
            {
                "smd.character.character": ["Character", "Mesh"],
                "smd.character.blend_shape": ["BlendShape"],
                "smd.character.skeleton": ["Skeleton"],
                "smd.character.clip": ["Clip"],
                "smd.character.poses": ["Poses"],
                "smd.character.tracks": ["Tracks"],
                "smd.character.kinematics": ["forward_kinematics"],
            },
        ),
        Section(
            "Files",
            "A new format of files fulfils one of these contracts; "
            "[CONTRIBUTING](../CONTRIBUTING.md) walks through it.",
            {
                "exporters": ["FORMATS", "ExportFormat", "StageWriter", "Writer"],
                "smd.formats.format": ["RecordingFormat"],
                "actions_library.importers.format": ["ImportFormat", "Importer"],
                "laban.faults": ["Fault", "naming"],
                "smd.files": ["replacing"],
            },
        ),
        Section(
            "Simulated people",
            "Doodles with known answers, for tests.",
            {
                "smd.synthetic.person": ["simulated_person"],
                "smd.synthetic.takes": ["Take"],
            },
        ),
    ]


def page() -> str:
    """Return the page as the code would have it."""
    return "\n".join([INTRODUCTION, *(_section(each) for each in sections())])


def _section(section: Section) -> str:
    rows = [
        f"| `{module}.{name}` | {first_line(module, name)} |"
        for module, names in section.names.items()
        for name in sorted(names, key=str.casefold)
    ]
    head = [f"## {section.title}", "", section.says, "", "| name | is or does |", "| --- | --- |"]
    return "\n".join([*head, *rows, ""])


def first_line(module: str, name: str) -> str:
    """Return the first line of the docstring that a name has where it is defined.

    Raises
    ------
    LookupError
        If it has none.
    """
    for home in _homes(module, name):
        text = Path(str(import_module(home).__file__)).read_text(encoding="utf-8")
        said = docstring(text, name)
        if said:
            return cleandoc(said).splitlines()[0].replace("``", "`").replace("|", "\\|")
    raise LookupError(f"{module}.{name}: expected a docstring where it is defined, found none")


def _homes(module: str, name: str) -> Iterator[str]:
    """Yield where a name may be defined: its own word for it, its face's table, that module."""
    value = getattr(import_module(module), name)
    yield getattr(value, "__module__", None) or module
    home = getattr(import_module(module), "_HOME", {}).get(name)
    if home:
        yield home
    yield module


def docstring(text: str, name: str) -> str | None:
    """Return the docstring of a class, a function or a constant of a module's text."""
    body = ast.parse(text).body
    for node, following in zip(body, [*body[1:], None], strict=True):
        if isinstance(node, ast.ClassDef | ast.FunctionDef) and node.name == name:
            return ast.get_docstring(node)
        targets = node.targets if isinstance(node, ast.Assign) else [getattr(node, "target", None)]
        if any(isinstance(target, ast.Name) and target.id == name for target in targets):
            said = following.value if isinstance(following, ast.Expr) else None
            return str(said.value) if isinstance(said, ast.Constant) else None
    return None


if __name__ == "__main__":
    sys.path.insert(0, str(ROOT))
    PAGE.write_text(page(), encoding="utf-8", newline="\n")
    print(f"wrote {PAGE.relative_to(ROOT)}")
