import viewer.errors
from viewer.errors import ViewerError


def test_every_error_of_the_viewer_is_caught_by_its_base() -> None:
    errors = [getattr(viewer.errors, name) for name in viewer.errors.__all__]

    assert len(errors) >= 5
    assert all(issubclass(error, ViewerError) for error in errors)
