from typing import Any

import msgspec
import pytest

from protocol import RunInfo
from solver_service.uploads.upload_record import UploadRecord
from solver_service.web import api_examples
from solver_service.web.api_types import OfferedCase, OpenStream, Problem, ServiceStatus, TokenFacts, Version

TYPES: list[tuple[Any, Any]] = [
    (RunInfo, api_examples.RUN_INFO),
    (OfferedCase, api_examples.CASE),
    (TokenFacts, api_examples.TOKEN),
    (OpenStream, api_examples.STREAM),
    (ServiceStatus, api_examples.STATUS),
    (Version, api_examples.VERSION),
    (UploadRecord, api_examples.UPLOAD),
    *((Problem, problem) for problem in api_examples.PROBLEMS.values()),
]


@pytest.mark.parametrize(("kind", "example"), TYPES)
def test_an_example_is_of_its_type(kind: Any, example: dict[str, Any]) -> None:
    msgspec.convert(example, kind)
    for name in example:  # nothing in it that the type does not know
        assert name in {field.name for field in msgspec.inspect.type_info(kind).fields}  # type: ignore[union-attr]
    first = next(iter(example))
    with pytest.raises(msgspec.ValidationError):
        msgspec.convert({**example, first: object()}, kind)
