import pytest

from solver_service.errors import AccessError
from solver_service.web.token_limits import NAMES, TokenLimits


def test_what_a_token_does_not_say_is_what_the_service_allows() -> None:
    own = TokenLimits(max_runs=0, max_viewers=7)
    defaults = TokenLimits(max_runs=5, max_cells=100)
    assert own.over(defaults) == TokenLimits(max_runs=0, max_cells=100, max_viewers=7)


@pytest.mark.parametrize("value", [-1, 1 << 54, float("nan"), float("inf")])
@pytest.mark.parametrize("name", NAMES)
def test_a_limit_that_cannot_be_is_refused_with_its_name(name: str, value: float) -> None:
    with pytest.raises(AccessError, match=name):
        TokenLimits(**{name: value})  # type: ignore[arg-type]
