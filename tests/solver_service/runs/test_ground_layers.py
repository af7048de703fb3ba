import dataclasses
from pathlib import Path

import numpy as np
from PIL import Image

from solver_service.runs.ground_layers import keep_layers, layers_of
from solver_service.scenario import load_case
from solver_service.store import DataFolder


def test_a_case_has_the_pictures_that_it_brings_and_they_are_kept_by_its_bed(tmp_path: Path) -> None:
    plain = load_case("jacksboro")
    picture = tmp_path / "ortho.png"
    Image.fromarray(np.full((30, 50, 3), 90, np.uint8)).save(picture)
    blocked = np.zeros(plain.z_b.shape, np.bool_)
    blocked[:3] = True
    case = dataclasses.replace(
        plain, imagery=picture, model=dataclasses.replace(plain.model, blocked=blocked)
    )
    folder = DataFolder(tmp_path / "data")
    keep_layers(folder, "plain", dataclasses.replace(plain, imagery=None))
    keep_layers(folder, "f00d", case)

    assert layers_of(plain) == ()
    assert layers_of(case) == ("imagery", "walls")
    kept = sorted(path.name for path in (folder.root / "terrain").iterdir())
    assert kept == ["f00d.imagery", "f00d.walls"]
    with Image.open(folder.layer("f00d", "walls")) as walls:
        assert walls.size == (plain.grid.ncols, plain.grid.nrows)
    with Image.open(folder.layer("f00d", "imagery")) as imagery:
        assert imagery.format == "JPEG"
