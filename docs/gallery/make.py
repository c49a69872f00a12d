"""Draw the pictures of this folder: ``python docs/gallery/make.py``."""

from __future__ import annotations

import tempfile
from pathlib import Path

from PIL import Image

import smd
from actions_library.library import Library
from exporters.action_picture import write_action_picture
from exporters.filmstrip import write_filmstrip
from exporters.timeline import write_timeline

HERE = Path(__file__).parent
RECORDINGS = HERE.parents[1] / "recordings"


ACTION_WIDTH_PX = 1400
"""Of an action's picture; it is drawn larger."""


def main() -> None:
    """Draw each shipped story's filmstrip and timeline, and each action."""
    library = smd.load_library()
    draw_stories(library)
    draw_actions(library)
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
