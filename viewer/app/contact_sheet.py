"""All pictures of a tour on one sheet, and two of them side by side."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from viewer.app.picture_file import save_png

__all__ = ["make_contact_sheet", "side_by_side"]

THUMBNAIL = (480, 270)
COLUMNS = 3
MARGIN = 16
CAPTION = 26
PAPER = (24, 28, 32)
INK = (225, 230, 235)


def make_contact_sheet(folder: Path, names: Sequence[str], title: str, target: Path) -> None:
    """Write the pictures `names` of `folder` as one captioned sheet to `target` (PNG)."""
    rows = -(-len(names) // COLUMNS)
    width = COLUMNS * (THUMBNAIL[0] + MARGIN) + MARGIN
    height = 2 * MARGIN + CAPTION + rows * (THUMBNAIL[1] + CAPTION + MARGIN)
    sheet = Image.new("RGB", (width, height), PAPER)
    draw = ImageDraw.Draw(sheet)
    draw.text((MARGIN, MARGIN), title, INK, ImageFont.load_default(20))
    font = ImageFont.load_default(14)
    for number, name in enumerate(names):
        row, column = divmod(number, COLUMNS)
        left = MARGIN + column * (THUMBNAIL[0] + MARGIN)
        top = 2 * MARGIN + CAPTION + row * (THUMBNAIL[1] + CAPTION + MARGIN)
        with Image.open(folder / name) as picture:
            sheet.paste(picture.resize(THUMBNAIL, Image.Resampling.LANCZOS), (left, top))
        draw.text((left, top + THUMBNAIL[1] + 4), Path(name).stem.replace("_", " "), INK, font)
    save_png(target, np.asarray(sheet))


def side_by_side(left: Path, right: Path, captions: tuple[str, str], target: Path) -> None:
    """Write two pictures of one size beside each other to `target` (PNG)."""
    with Image.open(left) as first, Image.open(right) as second:
        sheet = Image.new("RGB", (first.width + second.width + 4, first.height), PAPER)
        sheet.paste(first, (0, 0))
        sheet.paste(second, (first.width + 4, 0))
        draw = ImageDraw.Draw(sheet)
        font = ImageFont.load_default(28)
        for left_edge, caption in ((0, captions[0]), (first.width + 4, captions[1])):
            box = draw.textbbox((0, 0), caption, font)
            at = (left_edge + (first.width - box[2]) // 2, first.height - 52)
            draw.rectangle((at[0] - 12, at[1] - 6, at[0] + box[2] + 12, at[1] + box[3] + 8), PAPER)
            draw.text(at, caption, INK, font)
    save_png(target, np.asarray(sheet))
