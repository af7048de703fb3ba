from viewer.app.stage import Stage
from viewer.app.viewer_app import ViewerApp
from viewer.gui.conductor import Conductor, Painter


def public_methods(kind: type) -> set[str]:
    return {name for name in vars(kind) if not name.startswith("_")}


def test_the_state_machine_can_conduct_the_window() -> None:
    assert public_methods(Conductor) <= set(dir(ViewerApp))


def test_the_stage_can_paint_for_the_window() -> None:
    assert public_methods(Painter) <= set(dir(Stage))
    assert "paint" in public_methods(Painter)
