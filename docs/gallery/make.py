"""Draw the pictures of this folder: ``python docs/gallery/make.py``."""

from __future__ import annotations

import shutil
import tempfile
from itertools import product
from pathlib import Path

from PIL import Image, ImageDraw, ImageFont

import smd
from actions_library.library import Library
from actions_library.storage import write_clip_file
from exporters.action_picture import write_action_picture
from exporters.filmstrip import write_filmstrip
from exporters.timeline import write_timeline
from laban import Effort
from smd.expression.body import body_of
from smd.expression.expressive import expressive
from smd.expression.study import study_of

HERE = Path(__file__).parent
RECORDINGS = HERE.parents[1] / "recordings"


ACTION_WIDTH_PX = 1400
"""Of an action's picture; it is drawn larger."""


def main() -> None:
    """Draw each shipped story's filmstrip and timeline, and each action."""
    library = smd.load_library()
    draw_stories(library)
    draw_actions(library)
    draw_efforts(library, "slash", ("time", "weight"), HERE / "efforts.png")
    draw_efforts(library, "throw", ("space", "flow"), HERE / "efforts-space-flow.png")
    for picture in [*HERE.glob("*.png"), *(HERE / "actions").glob("*.png")]:
        # 256 colours: a third of the size. Maximum coverage keeps the small patches that tell
        # phrases apart; median cut drops them.
        few = Image.open(picture).convert("RGB").quantize(256, Image.Quantize.MAXCOVERAGE)
        few.save(picture, optimize=True)


def draw_actions(library: Library) -> None:
    """Draw each action's gesture and clip."""
    (HERE / "actions").mkdir(exist_ok=True)
    for action in library.actions:
        path = HERE / "actions" / f"{action.name}.png"
        write_action_picture(library, action.name, path)
        image = Image.open(path).convert("RGB")
        height = round(image.height * ACTION_WIDTH_PX / image.width)
        image.resize((ACTION_WIDTH_PX, height), Image.Resampling.LANCZOS).save(path)
        print(action.name)


def draw_efforts(library: Library, action: str, axes: tuple[str, str], path: Path) -> None:
    """Draw an action's clip in its nine states of two axes of Effort."""
    study = study_of(library.clip(action), body_of(library.clip("idle")))
    rows = []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        shutil.copy(library.folder / library.character_file, folder)
        for values in product((-1.0, 0.0, 1.0), repeat=2):
            state = dict(zip(axes, values, strict=True))
            called = ", ".join(f"{axis} {value:+.0f}" for axis, value in state.items())
            travels = library.action(action).travels
            (played,) = expressive(study, [Effort(**state)], travels=travels)
            write_clip_file(folder / "clip.usdc", played, library.character, library.character_file)
            write_filmstrip(folder / "clip.usdc", folder / "strip.png", rows=1)
            row = Image.open(folder / "strip.png").convert("RGB")
            ImageDraw.Draw(row).rectangle((0, 0, 210, row.height), fill=(250, 250, 250))
            font = ImageFont.load_default(24)
            for line, text in enumerate(called.split(", ")):
                ImageDraw.Draw(row).text((12, 60 + 34 * line), text, (35, 38, 42), font)
            rows.append(row.crop((0, 40, row.width, row.height)))
    sheet = Image.new("RGB", (rows[0].width, sum(row.height for row in rows)), "white")
    for i, row in enumerate(rows):
        sheet.paste(row, (0, i * row.height))
    size = (ACTION_WIDTH_PX, round(sheet.height * ACTION_WIDTH_PX / sheet.width))
    sheet.resize(size, Image.Resampling.LANCZOS).save(path)


def draw_stories(library: Library) -> None:
    """Draw each shipped story's filmstrip and timeline."""
    for take in sorted(RECORDINGS.glob("*.csv")):
        recording = smd.read_recording(take)
        score = smd.parse(recording, library)
        with tempfile.TemporaryDirectory() as folder:
            stage = Path(folder, f"{take.stem}.usdc")
            smd.write(smd.animate(score, recording, library), stage)
            write_filmstrip(stage, HERE / f"{take.stem}.filmstrip.png")
        write_timeline(recording, score, HERE / f"{take.stem}.timeline.png")
        print(take.stem)


if __name__ == "__main__":
    main()
