"""Where a section runs on the grid, and what it refuses."""

import numpy as np
import pytest

from solver_service.numerics import ModelError, Section, SolverParams

SHAPE = (20, 30)


def test_a_line_to_the_north_counts_flow_to_the_east():
    chain = Section("a", ((9.5, 2.5), (9.5, 6.5))).chain(SHAPE)
    assert chain.faces.tolist() == [[3, 9, 0], [4, 9, 0], [5, 9, 0], [6, 9, 0]]
    assert chain.sign.tolist() == [1.0] * 4
    assert chain.share.tolist() == [1.0] * 4


def test_a_line_to_the_east_counts_flow_to_the_south():
    chain = Section("a", ((2.5, 6.5), (5.5, 6.5))).chain(SHAPE)
    assert chain.faces.tolist() == [[6, 3, 1], [6, 4, 1], [6, 5, 1]]
    assert chain.sign.tolist() == [-1.0] * 3


def test_a_line_drawn_the_other_way_has_the_other_sign():
    line = ((1.2, 3.4), (20.0, 14.0))
    there, back = (Section("a", vertices).chain(SHAPE) for vertices in (line, line[::-1]))
    signs = [dict(zip(map(tuple, c.faces.tolist()), c.sign.tolist(), strict=True)) for c in (there, back)]
    common = signs[0].keys() & signs[1].keys()
    assert len(common) > 20
    assert all(signs[0][face] == -signs[1][face] for face in common)
    assert len(signs[0]) == len(there.faces) == len(back.faces)


def test_the_shares_of_a_staircase_add_up_to_the_length_of_the_line():
    for end in ((17.0, 17.0), (17.0, 9.0), (5.0, 18.0)):
        chain = Section("a", ((3.0, 3.0), end)).chain(SHAPE)
        assert chain.share.sum() == pytest.approx(np.hypot(end[0] - 3.0, end[1] - 3.0), rel=0.02)


def test_what_snapping_took_can_be_shown():
    lines = Section("a", ((9.5, 2.5), (9.5, 4.5))).snapped(SHAPE).face_lines()
    assert lines.tolist() == [[[9.5, 2.5], [9.5, 3.5]], [[9.5, 3.5], [9.5, 4.5]]]


@pytest.mark.parametrize(
    ("section", "words"),
    [
        (lambda: Section("", ((1.0, 1.0), (2.0, 2.0))), "no id"),
        (lambda: Section("a", ((1.0, 1.0),)), "1 vertices"),
        (lambda: Section("a", ((1.0, 1.0), (1.0, 1.0))), "are the same"),
        (lambda: Section("a", ((1.0, 1.0), (40.0, 1.0))).chain(SHAPE), "off the 20 x 30 grid"),
        (lambda: Section("a", ((1.0, 1.0), (1.1, 1.1))).chain(SHAPE), "takes no face"),
        (lambda: SolverParams(sections=(Section("a", ((1, 1), (9, 9))),) * 2), "each id once"),
    ],
)
def test_a_section_that_is_not_valid_is_refused(section, words):
    with pytest.raises(ModelError, match=words) as caught:
        section()
    assert "\n" not in str(caught.value)
