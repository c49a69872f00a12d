"""Draw which foot is down when: ``PYTHONPATH=. python docs/gallery/footfalls.py``.

A panel for each gait of a dog, a horse and two foxes, over one cycle from the left hind foot's
landing on; where nothing is down, the animal flies. Animals whose files are absent are left out.
"""

from __future__ import annotations

from pathlib import Path

from PIL import Image, ImageDraw, ImageFont

from benchmarks.footfalls import ANIMALS, FEET, FRAMES, Footfalls, found_falls
from smd.geometry.runs import runs_of_true

HERE = Path(__file__).parent

PANEL_PX, BAR_PX, GAP_PX = (300, 118), 15, 5
LEFT_PX, TOP_PX = 150, 34
COLOURS = ("#1f6f8b", "#c8762b", "#5fa8bf", "#e3ab72")
"""Of `FEET`: hind feet are blue, fore feet orange, those of the right side pale."""

FLIGHT, INK, LINE = "#eef1f4", "#23262a", "#b9bec4"


def main() -> None:
    """Draw all panels, a column a gait and a row an animal."""
    found = list(found_falls())
    gaits = list(dict.fromkeys(one.gait for one in found))
    animals = [one.name for one in ANIMALS if one.name in {fall.animal for fall in found}]
    size = LEFT_PX + len(gaits) * PANEL_PX[0], TOP_PX + len(animals) * PANEL_PX[1]
    sheet = Image.new("RGB", size, "white")
    draw, font = ImageDraw.Draw(sheet), ImageFont.load_default(14)
    for column, gait in enumerate(gaits):
        draw.text((LEFT_PX + column * PANEL_PX[0] + 76, 8), gait, INK, font)
    for row, animal in enumerate(animals):
        draw.text((8, TOP_PX + row * PANEL_PX[1] + 36), animal, INK, font)
    for one in found:
        x = LEFT_PX + gaits.index(one.gait) * PANEL_PX[0]
        panel(draw, one, x, TOP_PX + animals.index(one.animal) * PANEL_PX[1])
    sheet.quantize(64, Image.Quantize.MAXCOVERAGE).save(HERE / "footfalls.png", optimize=True)
    print("footfalls.png")


def panel(draw: ImageDraw.ImageDraw, one: Footfalls, x: int, y: int) -> None:
    """Draw when the feet of one gait are down."""
    font = ImageFont.load_default(11)
    left, width = x + 76, PANEL_PX[0] - 92

    def across(frame: int) -> float:
        return left + width * frame / FRAMES

    bottom = y + len(FEET) * (BAR_PX + GAP_PX)
    for start, end in runs_of_true(~one.down.any(axis=1)):
        draw.rectangle((across(start), y, across(end), bottom - GAP_PX), FLIGHT)
    for foot, name in enumerate(FEET):
        top = y + foot * (BAR_PX + GAP_PX)
        draw.text((x + 8, top + 1), name, INK, font)
        draw.line((left, top + BAR_PX, left + width, top + BAR_PX), LINE)
        for start, end in runs_of_true(one.down[:, foot]):
            draw.rectangle((across(start), top, across(end), top + BAR_PX - 1), COLOURS[foot])
    draw.text((left, bottom + 1), f"{one.period_s:.2f} s   {one.order}", INK, font)


if __name__ == "__main__":
    main()
