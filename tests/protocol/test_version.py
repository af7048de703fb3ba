import pytest

from protocol import PROTOCOL_VERSION, SUPPORTED_VERSIONS, VersionMismatch, negotiate


def test_a_common_version_is_chosen_among_unknown_ones() -> None:
    assert negotiate(("fev.v9", PROTOCOL_VERSION, "x")) == PROTOCOL_VERSION


def test_the_preferred_version_is_supported() -> None:
    assert PROTOCOL_VERSION in SUPPORTED_VERSIONS


@pytest.mark.parametrize("versions", [(), ("fev.v2",)])
def test_no_common_version_is_refused_naming_both_sides(versions: tuple[str, ...]) -> None:
    with pytest.raises(VersionMismatch, match=r"fev\.v1"):
        negotiate(versions)
