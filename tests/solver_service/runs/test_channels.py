from solver_service.runs.channels import MAXIMA_EVERY, due_channels, kept_channels

BOTH = ("velocity", "maxima")


def test_names_are_kept_once_in_one_order_and_unknown_ones_not_at_all() -> None:
    assert kept_channels(["maxima", "velocity", "maxima"]) == BOTH
    assert kept_channels(["maxima", "tides"]) == ("maxima",)
    assert kept_channels([]) == ()


def test_velocity_goes_with_every_frame_and_maxima_with_some() -> None:
    due = {index: due_channels(BOTH, index, 5, 22) for index in range(5, 23)}
    assert all("velocity" in names for names in due.values())
    assert [index for index, names in due.items() if "maxima" in names] == [5, 8, 12, 16, 20, 22]
    assert MAXIMA_EVERY == 4


def test_what_is_not_kept_is_never_due() -> None:
    assert due_channels(("velocity",), 8, 0, 8) == ("velocity",)
    assert due_channels((), 8, 0, 8) == ()
