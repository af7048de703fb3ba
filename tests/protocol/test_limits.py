from protocol import BlockLayout, limits


def test_every_limit_is_a_positive_number() -> None:
    numbers = {name: value for name, value in vars(limits).items() if name.isupper()}
    assert numbers
    assert all(isinstance(value, int) and value > 0 for value in numbers.values())


def test_parts_fit_into_messages() -> None:
    assert limits.PART_BYTES < limits.INBOUND_MAX_BYTES <= limits.OUTBOUND_MAX_BYTES


def test_the_largest_frame_and_terrain_fit_into_their_parts() -> None:
    assert limits.MAX_PARTS * limits.PART_BYTES >= limits.MAX_TERRAIN_BYTES >= limits.MAX_FRAME_BYTES


def test_the_states_of_the_largest_grids_fit() -> None:
    side = limits.MAX_SIDE
    for nrows, ncols in ((8192, 8192), (side, limits.MAX_CELLS // side), (limits.MAX_CELLS // side, side)):
        assert BlockLayout(nrows, ncols).packed_size <= limits.MAX_STATE_BYTES


def test_the_largest_edit_has_fewer_items_than_allowed() -> None:
    assert 4 * limits.MAX_VERTICES + 64 < limits.INBOUND_MAX_ITEMS
    assert limits.MAX_VERTICES <= limits.MAX_ARRAY_LENGTH
    assert limits.MAX_EDITS <= limits.MAX_ARRAY_LENGTH
    assert 4 * limits.MAX_LOG_VERTICES + 32 * limits.MAX_EDITS < limits.OUTBOUND_MAX_ITEMS
