"""Draw the pictures of this folder: ``python docs/gallery/make.py``."""

from __future__ import annotations

import tempfile
from pathlib import Path

from PIL import Image

import smd
from exporters.filmstrip import write_filmstrip
from exporters.timeline import write_timeline

HERE = Path(__file__).parent
RECORDINGS = HERE.parents[1] / "recordings"


def main() -> None:
    """Draw each shipped story's filmstrip and timeline."""
    library = smd.load_library()
    for take in sorted(RECORDINGS.glob("*.csv")):
        recording = smd.read_recording(take)
        score = smd.parse(recording, library)
        with tempfile.TemporaryDirectory() as folder:
            stage = Path(folder, f"{take.stem}.usdc")
            smd.write(smd.animate(score, recording, library), stage)
            write_filmstrip(stage, HERE / f"{take.stem}.filmstrip.png")
        write_timeline(recording, score, HERE / f"{take.stem}.timeline.png")
        print(take.stem)
    for picture in HERE.glob("*.png"):  # 256 colours: a third of the size
        # Maximum coverage keeps the small patches that tell phrases apart; median cut drops them.
        few = Image.open(picture).convert("RGB").quantize(256, Image.Quantize.MAXCOVERAGE)
        few.save(picture, optimize=True)


if __name__ == "__main__":
    main()
