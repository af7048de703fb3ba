from viewer.commands import AddMeasurePoint, BeginMeasure, EndMeasure, command_from_mapping


def test_a_script_can_measure() -> None:
    assert command_from_mapping({"command": "BeginMeasure"}) == BeginMeasure()
    point = {"command": "AddMeasurePoint", "x": 1, "y": 2.5}
    assert command_from_mapping(point) == AddMeasurePoint(1.0, 2.5)
    assert command_from_mapping({"command": "EndMeasure"}) == EndMeasure()
