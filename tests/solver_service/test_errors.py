import inspect
import pickle
import re

import pytest

from solver_service import errors
from solver_service.errors import ServiceError, SolverBlowUp

KINDS = [kind for _, kind in inspect.getmembers(errors, inspect.isclass) if kind is not ServiceError]


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.__name__)
def test_every_error_is_a_service_error_and_drawn_in_the_tree(kind: type[Exception]) -> None:
    assert issubclass(kind, ServiceError)
    assert re.search(rf"^ {{8,12}}{kind.__name__} ", errors.__doc__ or "", re.MULTILINE)


def test_a_blow_up_names_time_cell_value_and_cause() -> None:
    error = SolverBlowUp(12.5, 3, 7, "depth h = nan m", "the inflow is not finite")

    assert str(error) == (
        "The run stopped at 12.500 s in cell (row 3, column 7): depth h = nan m; the inflow is not finite."
    )


def test_a_blow_up_crosses_a_process_border_whole() -> None:
    error = pickle.loads(pickle.dumps(SolverBlowUp(12.5, 3, 7, "h = nan", "a cause")))

    assert (error.time, error.row, error.col, error.value, error.cause) == (12.5, 3, 7, "h = nan", "a cause")
