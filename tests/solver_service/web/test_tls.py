import json
import ssl
import urllib.request
from pathlib import Path

import pytest
from websockets.exceptions import InvalidMessage
from websockets.sync.client import connect

import protocol
from bench.service_process import ServiceProcess
from solver_service.errors import ServeError
from solver_service.web import ServiceSettings
from solver_service.web.tls import check_tls

FOLDER = Path(__file__).parent / "tls"
CERTIFICATE = FOLDER / "certificate.pem"
KEY = FOLDER / "key.pem"


def test_without_files_there_is_nothing_to_look_at_and_a_fitting_pair_passes() -> None:
    check_tls(ServiceSettings())
    check_tls(ServiceSettings(tls_certificate=CERTIFICATE, tls_key=KEY))


@pytest.mark.parametrize(
    ("certificate", "key", "words"),
    [
        (CERTIFICATE, None, "tls_key is not set"),
        (None, KEY, "tls_certificate is not set"),
        (CERTIFICATE, CERTIFICATE, "cannot be used"),
        (KEY, KEY, "cannot be used"),
        (FOLDER / "none.pem", KEY, "No such file"),
    ],
)
def test_a_pair_that_cannot_be_used_is_refused(
    certificate: Path | None, key: Path | None, words: str
) -> None:
    with pytest.raises(ServeError, match=words):
        check_tls(ServiceSettings(tls_certificate=certificate, tls_key=key))


def test_with_a_certificate_rest_and_stream_are_encrypted_and_nothing_else_is_answered(
    tmp_path: Path,
) -> None:
    trust = ssl.create_default_context(cafile=str(CERTIFICATE))
    options = {"tls_certificate": str(CERTIFICATE), "tls_key": str(KEY), "spare_workers": 0}
    with ServiceProcess(tmp_path, **options) as service:
        assert service.url.startswith("wss://")
        with urllib.request.urlopen(f"{service.http}/healthz", timeout=10.0, context=trust) as answer:
            assert json.load(answer) == {"status": "ok"}
        subprotocols = [protocol.PROTOCOL_VERSION]
        with connect(service.url, ssl=trust, subprotocols=subprotocols, compression=None) as connection:  # type: ignore[arg-type]
            connection.send(protocol.ClientSession("test", token=service.token).open())
            data = connection.recv(timeout=10.0)
            assert isinstance(data, bytes)
            assert isinstance(protocol.unpack_server(data), protocol.Welcome)
        with pytest.raises((InvalidMessage, OSError)):
            connect(service.url.replace("wss://", "ws://"), subprotocols=subprotocols, open_timeout=5.0)  # type: ignore[arg-type]
        with pytest.raises(ssl.SSLCertVerificationError):
            connect(service.url, ssl=ssl.create_default_context(), open_timeout=5.0)
