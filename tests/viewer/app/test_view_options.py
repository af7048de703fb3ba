import pytest

from viewer.app.view_options import OPTION_NAMES, changed_options
from viewer.commands import CommandError
from viewer.lod import Border
from viewer.render import RenderOptions
from viewer.world import WaterColour


def test_an_option_is_set_by_its_name() -> None:
    options = changed_options(RenderOptions(), "exaggeration", 2)

    assert options.exaggeration == 2.0
    assert changed_options(options, "wireframe", True).wireframe
    assert changed_options(options, "water_colour", "hazard").water_colour is WaterColour.HAZARD
    assert changed_options(options, "flow_arrows", True).flow_arrows
    assert changed_options(options, "block_size", 65.0).block_size == 65
    assert changed_options(options, "border", "pad").border is Border.PAD


def test_every_name_is_an_option_of_the_renderer() -> None:
    assert set(OPTION_NAMES) <= set(RenderOptions.__dataclass_fields__)


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("exaggeration", 0.0),
        ("exaggeration", True),
        ("tau_px", float("inf")),
        ("wireframe", 1),
        ("x", 1),
        ("fog", "on"),
        ("water_colour", "taste"),
        ("water_colour", True),
        ("block_size", 34),
        ("block_size", True),
        ("border", "cut"),
    ],
)
def test_a_wrong_value_is_refused(name: str, value: object) -> None:
    with pytest.raises(CommandError, match=r"not allowed|unknown"):
        changed_options(RenderOptions(), name, value)  # type: ignore[arg-type]
