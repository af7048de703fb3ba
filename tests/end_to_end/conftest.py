from collections.abc import Iterator

import pytest

from bench.service_process import ServiceClient, ServiceProcess
from protocol import BlockLayout
from tests.end_to_end.dam_break import CELLS, write_dam_break


@pytest.fixture(scope="session")
def case(tmp_path_factory: pytest.TempPathFactory) -> str:
    return str(write_dam_break(tmp_path_factory.mktemp("case") / "dam-break"))


@pytest.fixture(scope="session")
def service(tmp_path_factory: pytest.TempPathFactory, case: str) -> Iterator[ServiceProcess]:
    with ServiceProcess(tmp_path_factory.mktemp("data"), cases=[case], threads=2) as service:
        yield service


@pytest.fixture
def client(service: ServiceProcess) -> Iterator[ServiceClient]:
    with ServiceClient(service, layout=BlockLayout(CELLS, CELLS)) as client:
        yield client
