import pytest

from viewer.app.view_options import OPTION_NAMES, changed_options
from viewer.commands import CommandError
from viewer.render import RenderOptions, WaterStyle


def test_an_option_is_set_by_its_name() -> None:
    options = changed_options(RenderOptions(), "exaggeration", 2)

    assert options.exaggeration == 2.0
    assert changed_options(options, "wireframe", True).wireframe
    assert changed_options(options, "depth_classes", True).water_style is WaterStyle.DEPTH_CLASSES
    assert changed_options(options, "depth_classes", False).water_style is WaterStyle.NATURAL


def test_every_name_is_an_option_of_the_renderer() -> None:
    fields = set(RenderOptions.__dataclass_fields__) | {"depth_classes"}

    assert set(OPTION_NAMES) <= fields


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("exaggeration", 0.0),
        ("exaggeration", True),
        ("tau_px", float("inf")),
        ("wireframe", 1),
        ("x", 1),
        ("fog", "on"),
    ],
)
def test_a_wrong_value_is_refused(name: str, value: object) -> None:
    with pytest.raises(CommandError, match=r"not allowed|unknown"):
        changed_options(RenderOptions(), name, value)  # type: ignore[arg-type]
