from collections.abc import Iterator
from pathlib import Path

import pytest

from bench.service_process import ServiceProcess
from tests.end_to_end.dam_break import write_dam_break


@pytest.fixture(scope="session")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[ServiceProcess]:
    folder: Path = tmp_path_factory.mktemp("web")
    case = str(write_dam_break(folder / "dam-break"))
    options = {"cases": [case], "allowed_origins": ["https://map.example"], "spare_workers": 1}
    with ServiceProcess(folder / "data", **options) as service:
        yield service
