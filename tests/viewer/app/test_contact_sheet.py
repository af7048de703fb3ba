from pathlib import Path

import numpy as np
from PIL import Image

from viewer.app.contact_sheet import make_contact_sheet, side_by_side


def picture(path: Path, colour: tuple[int, int, int]) -> Path:
    Image.new("RGB", (320, 180), colour).save(path)
    return path


def test_every_picture_is_on_the_sheet(tmp_path: Path) -> None:
    colours = [(200, 0, 0), (0, 200, 0), (0, 0, 200), (200, 200, 0)]
    names = [f"{number:02d}_picture.png" for number in range(4)]
    for name, colour in zip(names, colours, strict=True):
        picture(tmp_path / name, colour)
    make_contact_sheet(tmp_path, names, "Title", tmp_path / "sheet.png")
    with Image.open(tmp_path / "sheet.png") as sheet:
        seen = {tuple(int(value) for value in colour) for colour in np.asarray(sheet).reshape(-1, 3)[::7]}

    assert set(colours) <= seen
    assert not list(tmp_path.glob("*.part"))


def test_two_pictures_stand_beside_each_other(tmp_path: Path) -> None:
    left, right = picture(tmp_path / "a.png", (200, 0, 0)), picture(tmp_path / "b.png", (0, 200, 0))
    side_by_side(left, right, ("before", "after"), tmp_path / "both.png")
    with Image.open(tmp_path / "both.png") as both:
        assert both.size == (644, 180)
        assert both.getpixel((10, 10)) == (200, 0, 0)
        assert both.getpixel((634, 10)) == (0, 200, 0)
