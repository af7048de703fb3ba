"""`fev-viewer`: the window, or the same job without one.

fev-viewer ws://HOST:PORT --token-file F        look at a service
fev-viewer --local CASE                         start a service on this machine and run a case
fev-viewer --local CASE --headless DIR          the same without a window: pictures and figures go to DIR
fev-viewer demo [CASE] [--headless DIR]         what ./fev demo does
"""

from __future__ import annotations

import sys
import tempfile
import time
from dataclasses import replace
from pathlib import Path
from typing import Annotated

import typer

from viewer.app.display import has_display
from viewer.app.endpoint import Endpoint, read_token, stream_url
from viewer.errors import ViewerError

__all__ = ["main"]

EXIT_REFUSED = 2
DEMO_CASE = "jacksboro"

application = typer.Typer(
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,  # or the unit in "[s]" would be taken for markup
    help=f"{__doc__}".replace("\n\n", "\n\n\b\n"),  # \b keeps the lines of the table apart
)


@application.command("view", help="Look at a service, or start one on this machine.")
def view(
    url: Annotated[str | None, typer.Argument(help="Address of a service: ws://HOST:PORT")] = None,
    local: Annotated[
        str | None, typer.Option("--local", metavar="CASE", help="Start a service and run CASE")
    ] = None,
    token_file: Annotated[Path | None, typer.Option(help="File with the token of the service at URL")] = None,
    case: Annotated[str | None, typer.Option(help="Case to start at once on the service at URL")] = None,
    headless: Annotated[
        Path | None, typer.Option(metavar="DIR", help="No window; pictures go to DIR")
    ] = None,
    script: Annotated[Path | None, typer.Option(metavar="FILE", help="Commands for --headless")] = None,
    data_dir: Annotated[Path | None, typer.Option(help="Store of the service that --local starts")] = None,
    duration: Annotated[
        float | None, typer.Option(help="Simulated time [s]; default: the case's own")
    ] = None,
    output_interval: Annotated[float | None, typer.Option(help="Time between frames [s]")] = None,
    device: Annotated[str, typer.Option(help="auto, cpu or cuda:N")] = "auto",
) -> None:
    """Look at a service, or start one on this machine."""
    _run(
        url,
        local or case,
        local is not None,
        token_file,
        headless,
        script,
        data_dir,
        duration,
        output_interval,
        device,
    )


@application.command("demo", help="Run the demo: a service on this machine and the viewer on a case.")
def demo(
    case: Annotated[str, typer.Argument(help="Case to run")] = DEMO_CASE,
    headless: Annotated[
        Path | None, typer.Option(metavar="DIR", help="No window; pictures go to DIR")
    ] = None,
    device: Annotated[str, typer.Option(help="auto, cpu or cuda:N")] = "auto",
) -> None:
    """Run the demo: a service on this machine and the viewer on a case."""
    if headless is None and not has_display():
        headless = Path("out") / f"demo-{Path(case).stem}"
        print(f"no display: flying headless, pictures go to {headless}", file=sys.stderr)
    _run(None, case, True, None, headless, None, None, None, None, device)


def main() -> None:
    """Run the command line; errors become one sentence on standard error and a non-zero exit status."""
    arguments = sys.argv[1:]
    if not arguments or arguments[0] not in ("view", "demo", "--help", "-h"):
        arguments.insert(0, "view")
    application(arguments, prog_name="fev-viewer")


def _run(
    url: str | None,
    case: str | None,
    is_local: bool,
    token_file: Path | None,
    headless: Path | None,
    script: Path | None,
    data_dir: Path | None,
    duration: float | None,
    output_interval: float | None,
    device: str,
) -> None:
    started = time.monotonic()
    try:
        _check(url, is_local, headless, script)
        from viewer.app.program import ViewerJob, fly_headless, open_window
        from viewer.commands import StartRun

        endpoint = Endpoint(url, read_token(token_file), data_dir)
        start = None if case is None else StartRun(case, duration, output_interval, device)
        job = ViewerJob(endpoint, start, started)
        if headless is None:
            raise typer.Exit(open_window(job))
        if is_local and data_dir is None:
            with tempfile.TemporaryDirectory(prefix="fev-flight-") as folder:
                fly_headless(
                    replace(job, endpoint=replace(endpoint, data_dir=Path(folder))), headless, script
                )
        else:
            fly_headless(job, headless, script)
    except ViewerError as error:
        print(f"fev-viewer: {error}", file=sys.stderr)
        raise typer.Exit(EXIT_REFUSED) from None


def _check(url: str | None, is_local: bool, headless: Path | None, script: Path | None) -> None:
    if is_local == (url is not None):
        raise ViewerError("give either the address of a service (ws://HOST:PORT) or --local CASE")
    if url is not None:
        stream_url(url)
    if script is not None and headless is None:
        raise ViewerError("--script needs --headless DIR")
    if headless is not None and headless.exists() and not headless.is_dir():
        raise ViewerError(f"--headless {headless} is a file; a folder is needed")
