"""The web face of the service: REST, the websocket stream, and `serve`, which runs them."""

from solver_service.web.settings import ServiceSettings

__all__ = ["ServiceSettings", "serve"]


def serve(settings: ServiceSettings) -> None:
    """Run the service until a signal, or the end of its standard input, stops it.

    Raises:
        ServiceError: the port or the data folder is taken, or the token file cannot be used.
    """
    from solver_service.web.server import run_service  # FastAPI only where it is served

    run_service(settings)
