"""TLS by files: looked at before anything is served, so that a wrong file is told in a sentence."""

from __future__ import annotations

import ssl

from solver_service.errors import ServeError
from solver_service.web.settings import ServiceSettings


def check_tls(settings: ServiceSettings) -> None:
    """See whether certificate and key can be used, where they are set.

    Raises:
        ServeError: one is set without the other, a file cannot be read, or the two do not belong together.
    """
    certificate, key = settings.tls_certificate, settings.tls_key
    if certificate is None and key is None:
        return
    if certificate is None or key is None:
        lacking = "tls_certificate" if certificate is None else "tls_key"
        raise ServeError(f"{lacking} is not set beside {certificate or key}; TLS needs both, in PEM")
    try:
        context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
        # a key with a password would make the service wait for one at the terminal
        context.load_cert_chain(certificate, key, password=lambda: "")
    except (OSError, ValueError) as error:  # ssl.SSLError is an OSError
        raise ServeError(
            f"tls_certificate {certificate} with tls_key {key} cannot be used: {error}; "
            "a certificate chain and its key without password, both in PEM, are allowed"
        ) from error
