from viewer.commands import FollowView, PresentView, command_from_mapping


def test_a_script_can_present_and_follow() -> None:
    assert command_from_mapping({"command": "PresentView"}) == PresentView(True)
    assert command_from_mapping({"command": "PresentView", "on": False}) == PresentView(False)
    assert command_from_mapping({"command": "FollowView", "session": "anna"}) == FollowView("anna")
    assert command_from_mapping({"command": "FollowView"}) == FollowView(None)
