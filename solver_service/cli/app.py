"""The commands of `fev-solver`, and how their failures end.

A failure is one sentence on standard error and exit code 2. Libraries are imported inside the commands, so
that `--help` answers at once.
"""

from __future__ import annotations

import logging
import sys
from pathlib import Path
from typing import Annotated

import typer

from solver_service.errors import ServiceError

BAD_INPUT = 2

app = typer.Typer(
    add_completion=False,
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,  # or the unit in "[s]" would be taken for markup
    help="The flood solver of FEV: run a case, check it, or serve runs to viewers.",
)

CaseArgument = Annotated[
    str, typer.Argument(metavar="CASE", help="Name of a case, or path of a folder, case file or .fevcase.")
]
DeviceOption = Annotated[str, typer.Option("--device", help="auto, cpu or cuda:N.")]
ThreadsOption = Annotated[int | None, typer.Option("--threads", help="CPU threads; all cores by default.")]
DataDirOption = Annotated[Path | None, typer.Option("--data-dir", help="Folder of the runs.")]
MaxRuns = Annotated[int | None, typer.Option("--max-runs", help="Runs that a token may keep.")]
MaxCells = Annotated[
    int | None, typer.Option("--max-cells", help="Cells that its runs may compute at the same time.")
]
MaxGpuBytes = Annotated[
    int | None, typer.Option("--max-gpu-bytes", help="GPU memory that its runs may take [bytes].")
]
MaxDiskBytes = Annotated[
    int | None,
    typer.Option("--max-disk-bytes", help="Room for its frames, checkpoints and uploads [bytes]."),
]
MaxEdits = Annotated[int | None, typer.Option("--max-edits-per-s", help="Changes of edits within a second.")]
MaxViewers = Annotated[int | None, typer.Option("--max-viewers", help="Streams that it may have open.")]
JsonOption = Annotated[bool, typer.Option("--json", help="End with one JSON object on standard output.")]


@app.command()
def run(
    case: CaseArgument,
    until: Annotated[float | None, typer.Option("--until", help="Simulated time [s].")] = None,
    out: Annotated[Path | None, typer.Option("--out", help="Folder of the results.")] = None,
    device: DeviceOption = "auto",
    cell_size: Annotated[float | None, typer.Option("--cell-size", help="Cell size [m].")] = None,
    threads: ThreadsOption = None,
    json_line: JsonOption = False,
    netcdf: Annotated[bool, typer.Option("--netcdf", help="Also write timesteps.nc.")] = False,
    zarr: Annotated[bool, typer.Option("--zarr", help="Also write timesteps.zarr.")] = False,
) -> None:
    """Run a case without the web and write maps, gauges, sections and a summary."""
    from solver_service.cli.run import run_offline
    from solver_service.offline import OfflineOptions

    options = OfflineOptions(until, out, device, threads, netcdf, zarr)
    run_offline(case, options, cell_size, json_line)


@app.command()
def check(
    case: CaseArgument,
    device: DeviceOption = "auto",
    json_line: JsonOption = False,
    geojson: Annotated[
        Path | None, typer.Option("--geojson", help="File for the cells and faces of what is built.")
    ] = None,
) -> None:
    """Look at a case: coordinates, units, holes, pits, inflows, structures, memory and time."""
    from solver_service.cli.check import check_and_tell

    check_and_tell(case, device, json_line, geojson)


@app.command("cases")
def list_all(json_line: JsonOption = False) -> None:
    """List the cases that have a name."""
    from solver_service.cli.check import tell_cases

    tell_cases(json_line)


@app.command()
def serve(
    config: Annotated[
        Path | None, typer.Option("--config", help="Settings file (TOML); flags win over it.")
    ] = None,
    show_config: Annotated[
        bool, typer.Option("--show-config", help="Tell the settings and where each comes from, and end.")
    ] = False,
    host: Annotated[str | None, typer.Option("--host", help="Address to listen on.")] = None,
    port: Annotated[int | None, typer.Option("--port", help="TCP port; 0 picks one.")] = None,
    data_dir: Annotated[Path | None, typer.Option("--data-dir", help="Folder of the runs.")] = None,
    token_file: Annotated[Path | None, typer.Option("--token-file", help="File with the token.")] = None,
    ready_file: Annotated[
        Path | None, typer.Option("--ready-file", help="File for the ready line as well.")
    ] = None,
    case: Annotated[
        list[str] | None, typer.Option("--case", help="A case to offer beside the known; repeatable.")
    ] = None,
    device: Annotated[str | None, typer.Option("--device", help="auto, cpu or cuda:N.")] = None,
    threads: ThreadsOption = None,
    stop_with_stdin: Annotated[
        bool | None, typer.Option("--stop-with-stdin", help="End when standard input closes.")
    ] = None,
    allow_origin: Annotated[
        list[str] | None, typer.Option("--allow-origin", help="A web origin to serve; repeatable.")
    ] = None,
    tls_certificate: Annotated[
        Path | None, typer.Option("--tls-certificate", help="Certificate chain (PEM) for wss and https.")
    ] = None,
    tls_key: Annotated[Path | None, typer.Option("--tls-key", help="Key of the certificate (PEM).")] = None,
    store_bytes: Annotated[
        int | None, typer.Option("--store-bytes", help="Budget of frames and checkpoints [bytes].")
    ] = None,
    restart_attempts: Annotated[
        int | None, typer.Option("--restart-attempts", help="Restarts of a run in ten minutes.")
    ] = None,
    log_format: Annotated[str | None, typer.Option("--log-format", help="Log lines as text or json.")] = None,
    log_level: Annotated[
        str | None, typer.Option("--log-level", help="debug, info, warning or error.")
    ] = None,
    max_runs: MaxRuns = None,
    max_cells: MaxCells = None,
    max_gpu_bytes: MaxGpuBytes = None,
    max_disk_bytes: MaxDiskBytes = None,
    max_edits_per_s: MaxEdits = None,
    max_viewers: MaxViewers = None,
) -> None:
    """Serve runs to viewers until a signal stops it; writes one JSON line when it listens."""
    from solver_service.cli.serve import serve_runs

    serve_runs(
        config,
        show_config,
        host=host,
        port=port,
        data_dir=data_dir,
        token_file=token_file,
        ready_file=ready_file,
        cases=case or None,
        device=device,
        threads=threads,
        stop_with_stdin=stop_with_stdin,
        allowed_origins=allow_origin or None,
        tls_certificate=tls_certificate,
        tls_key=tls_key,
        store_bytes=store_bytes,
        restart_attempts=restart_attempts,
        log_format=log_format,
        log_level=log_level,
        max_runs=max_runs,
        max_cells=max_cells,
        max_gpu_bytes=max_gpu_bytes,
        max_disk_bytes=max_disk_bytes,
        max_edits_per_s=max_edits_per_s,
        max_viewers=max_viewers,
    )


@app.command()
def export(
    run_id: Annotated[str, typer.Argument(metavar="RUN", help="Id of a stored run.")],
    out: Annotated[Path, typer.Option("--out", help="Folder of the results.")],
    data_dir: Annotated[Path | None, typer.Option("--data-dir", help="Folder of the runs.")] = None,
    zarr: Annotated[bool, typer.Option("--zarr", help="Zarr instead of NetCDF.")] = False,
) -> None:
    """Write the stored frames of a run, with its ancestors' past, as NetCDF or Zarr."""
    from solver_service.cli.export import export_run

    export_run(run_id, out, data_dir, zarr)


@app.command()
def upload(
    case: Annotated[Path, typer.Argument(metavar="CASE", help="Folder of a case, or a .fevcase archive.")],
    server: Annotated[str, typer.Option("--server", help="Address of the service: ws://HOST:PORT.")],
    token_file: Annotated[Path, typer.Option("--token-file", help="File with a token of a controller.")],
    json_line: JsonOption = False,
) -> None:
    """Send a case to a service, which checks it and then offers it to everybody."""
    from solver_service.cli.upload import upload_case

    upload_case(case, server, token_file, json_line)


store = typer.Typer(no_args_is_help=True, rich_markup_mode=None, help="Look at, mend and copy stored runs.")
app.add_typer(store, name="store")


@store.command("check")
def store_check(data_dir: DataDirOption = None) -> None:
    """Look at every stored row and file; exit code 1 where something is wrong."""
    from solver_service.cli.store import check_store

    if not check_store(data_dir):
        raise typer.Exit(1)


@store.command("repair")
def store_repair(data_dir: DataDirOption = None) -> None:
    """Mend a stored folder while no service runs; frames that are lost can be computed again."""
    from solver_service.cli.store import repair_store

    if not repair_store(data_dir):
        raise typer.Exit(1)


@store.command("backup")
def store_backup(
    destination: Annotated[Path, typer.Argument(metavar="FOLDER", help="A folder that is new or empty.")],
    data_dir: DataDirOption = None,
) -> None:
    """Copy the stored runs, also while a service runs; the token is not copied."""
    from solver_service.cli.store import backup_store

    backup_store(destination, data_dir)


@store.command("log")
def store_log(
    run_id: Annotated[str, typer.Argument(metavar="RUN", help="Id of a stored run.")],
    out: Annotated[Path | None, typer.Option("--out", help="File; standard output by default.")] = None,
    data_dir: DataDirOption = None,
) -> None:
    """Write the event log of a run: lineage, edits, moves and checksums as JSON lines."""
    from solver_service.cli.event_log import write_log

    write_log(run_id, out, data_dir)


token = typer.Typer(no_args_is_help=True, rich_markup_mode=None, help="Make, list and revoke tokens.")
app.add_typer(token, name="token")


@token.command("create")
def token_create(
    label: Annotated[str, typer.Argument(metavar="LABEL", help="Whose it is.")],
    scope: Annotated[str, typer.Option("--scope", help="viewer, controller, operator or admin.")],
    days: Annotated[
        float | None, typer.Option("--days", help="Days until it expires; never, without.")
    ] = None,
    data_dir: DataDirOption = None,
    max_runs: MaxRuns = None,
    max_cells: MaxCells = None,
    max_gpu_bytes: MaxGpuBytes = None,
    max_disk_bytes: MaxDiskBytes = None,
    max_edits_per_s: MaxEdits = None,
    max_viewers: MaxViewers = None,
) -> None:
    """Make a token and write it to standard output; it is told only now."""
    from solver_service.cli.token import create_token

    create_token(
        label,
        scope,
        days,
        data_dir,
        max_runs=max_runs,
        max_cells=max_cells,
        max_gpu_bytes=max_gpu_bytes,
        max_disk_bytes=max_disk_bytes,
        max_edits_per_s=max_edits_per_s,
        max_viewers=max_viewers,
    )


@token.command("limit")
def token_limit(
    token_id: Annotated[str, typer.Argument(metavar="ID", help="Id of the token, from the list.")],
    data_dir: DataDirOption = None,
    max_runs: MaxRuns = None,
    max_cells: MaxCells = None,
    max_gpu_bytes: MaxGpuBytes = None,
    max_disk_bytes: MaxDiskBytes = None,
    max_edits_per_s: MaxEdits = None,
    max_viewers: MaxViewers = None,
) -> None:
    """Give a token the limits that are named, and for all others those of the service."""
    from solver_service.cli.token import limit_token

    limit_token(
        token_id,
        data_dir,
        max_runs=max_runs,
        max_cells=max_cells,
        max_gpu_bytes=max_gpu_bytes,
        max_disk_bytes=max_disk_bytes,
        max_edits_per_s=max_edits_per_s,
        max_viewers=max_viewers,
    )


@token.command("list")
def token_list(data_dir: DataDirOption = None, json_line: JsonOption = False) -> None:
    """List the tokens: id, scope, state, when they expire, and whose they are."""
    from solver_service.cli.token import list_tokens

    list_tokens(data_dir, json_line)


@token.command("revoke")
def token_revoke(
    token_id: Annotated[str, typer.Argument(metavar="ID", help="Id of the token, from the list.")],
    data_dir: DataDirOption = None,
) -> None:
    """Revoke a token; a service that runs ends its connections within seconds."""
    from solver_service.cli.token import revoke_token

    revoke_token(token_id, data_dir)


@app.command()
def replay(
    log: Annotated[Path, typer.Argument(metavar="LOG", help="Event log of a run.")],
    case: Annotated[str | None, typer.Option("--case", help="Name or path of its case.")] = None,
    threads: ThreadsOption = None,
) -> None:
    """Compute the frames of an event log again and compare their bytes; exit code 1 where they differ."""
    from solver_service.cli.event_log import replay_log

    if not replay_log(log, case, threads):
        raise typer.Exit(1)


@app.command()
def warmup(device: DeviceOption = "auto") -> None:
    """Compile the kernels for a device, so that the first run starts at once."""
    from solver_service.cli.doctor import warm_up

    warm_up(device)


@app.command()
def doctor(
    json_line: JsonOption = False,
    config: Annotated[
        Path | None, typer.Option("--config", help="Settings file (TOML) of the server to check.")
    ] = None,
) -> None:
    """Tell versions, devices and memory, and try what a server needs; exit code 1 where it lacks some."""
    from solver_service.cli.doctor import tell_machine

    if not tell_machine(json_line, config):
        raise typer.Exit(1)


def main() -> None:
    """Run the command line; never shows a traceback for what the user can mend."""
    logging.basicConfig(level=logging.WARNING, format="%(levelname)s: %(message)s", stream=sys.stderr)
    try:
        app()
    except ServiceError as error:
        print(f"fev-solver: {error}", file=sys.stderr)
        sys.exit(BAD_INPUT)
    except BrokenPipeError:
        sys.stderr.close()
        sys.exit(1)
