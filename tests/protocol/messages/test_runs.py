import msgpack
import msgspec
import pytest

from protocol import (
    GridGeometry,
    GridInfo,
    InvalidMessage,
    RunChanged,
    StartRun,
    pack,
    unpack_client,
    unpack_server,
)
from tests.protocol.examples import RUN

GEOMETRY = GridGeometry(12, 34, 2.5, -10.0, 1e6, "EPSG:32616", "NGVD29", 250.0)


def test_a_geometry_survives_its_wire_form() -> None:
    assert GridInfo.from_geometry(GEOMETRY).geometry == GEOMETRY


def test_more_cells_than_a_grid_may_have_are_refused() -> None:
    with pytest.raises(ValueError, match="cells"):
        GridInfo(1 << 16, 1 << 16, 1.0, 0.0, 0.0)
    fields = msgpack.unpackb(pack(RunChanged(RUN)))
    fields["run"]["grid"] |= {"nrows": 1 << 16, "ncols": 1 << 16}
    with pytest.raises(InvalidMessage, match="cells"):
        unpack_server(msgpack.packb(fields))


@pytest.mark.parametrize("device", ["auto", "cpu", "cuda", "cuda:0", "cuda:12"])
def test_devices_that_may_be_asked_for(device: str) -> None:
    assert unpack_client(pack(StartRun(1, "c", device=device))) == StartRun(1, "c", device=device)


@pytest.mark.parametrize("device", ["", "gpu", "cuda:", "cuda:x", "cpu; rm", "cpu\n", "cuda:0000"])
def test_other_devices_are_refused(device: str) -> None:
    with pytest.raises(InvalidMessage, match="device"):
        unpack_client(pack(StartRun(1, "c", device=device)))


@pytest.mark.parametrize(("field", "value"), [("duration", 0.0), ("output_interval", -1.0)])
def test_impossible_times_are_refused(field: str, value: float) -> None:
    with pytest.raises(InvalidMessage, match=field):
        unpack_client(pack(msgspec.structs.replace(StartRun(1, "c"), **{field: value})))


def test_an_unknown_status_is_refused() -> None:
    with pytest.raises(InvalidMessage, match="status"):
        unpack_server(pack(RunChanged(msgspec.structs.replace(RUN, status="thinking"))))
