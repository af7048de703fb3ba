"""What an operator may choose about a service."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from protocol import CHANNEL_NAMES
from solver_service.store import default_data_dir
from solver_service.uploads.import_messages import ImportLimits
from solver_service.uploads.upload_rules import UploadRules
from solver_service.web.token_limits import NAMES, TokenLimits


@dataclass(frozen=True)
class ServiceSettings:
    """One service.

    Attributes:
        host: address to listen on.
        port: TCP port; 0 picks a free one, told in the ready line.
        data_dir: folder of runs, frames and checkpoints; one service at a time.
        token_file: file with the token; made with a random one (mode 600) where it does not exist. None:
            `token`
            below the data folder.
        ready_file: where the ready line is written as well, None for standard output only.
        stop_with_stdin: end when standard input closes, so that a service never outlives the viewer that
            began it.
        cases: cases offered beside the embedded ones and those of `FEV_DATA_HOME`: names or paths.
        device: device of runs that ask for "auto".
        threads: solver threads of a worker on the CPU; None for all cores.
        allowed_origins: values of the Origin header that are served beside the own address; native viewers
            send none.
        tls_certificate: file with the certificate chain (PEM); with it the stream and REST are encrypted.
        tls_key: file with the key of the certificate (PEM).
        ring_bytes: memory in which a worker keeps recent states for Recalculate [bytes].
        checkpoint_interval_s: wall time between checkpoints on disk [s].
        spare_workers: warm workers that stand by.
        restart_attempts: how often a run whose worker died is taken up again by itself; a blow-up never is.
        restart_within_s: the time in which these attempts count [s].
        store_bytes: most bytes of frames and checkpoints; None for as much as the disk has.
        reserve_bytes: room on the disk that is left to others [bytes].
        upload_bytes: most bytes of an uploaded archive.
        upload_cells: most cells of an uploaded case.
        upload_memory_bytes: most memory of the process that imports one [bytes].
        upload_time_s: most time that the import of one may take [s].
        channels: what runs may keep beside the depth; none keeps nothing.
        worker_silence_s: how long a worker may give no sign at all before another takes its run [s].
        worker_stall_s: how long it may do one and the same thing, such as a step or a compilation [s].
        log_format: "text" or "json".
        log_level: least level of the lines that are written.
        max_runs: runs that a token may keep; None for no limit, as with all that follow.
        max_cells: cells that the runs of a token may compute at the same time.
        max_gpu_bytes: GPU memory that the runs of a token may take [bytes].
        max_disk_bytes: room that frames, checkpoints and uploads of a token may take [bytes].
        max_edits_per_s: changes of edits that a token may make within a second.
        max_viewers: streams that a token may have open.
    """

    host: str = "127.0.0.1"
    port: int = 0
    data_dir: Path = field(default_factory=default_data_dir)
    token_file: Path | None = None
    ready_file: Path | None = None
    stop_with_stdin: bool = False
    cases: tuple[str, ...] = ()
    device: str = "auto"
    threads: int | None = None
    allowed_origins: tuple[str, ...] = ()
    tls_certificate: Path | None = None
    tls_key: Path | None = None
    ring_bytes: int = 1 << 30
    checkpoint_interval_s: float = 60.0
    spare_workers: int = 1
    restart_attempts: int = 3
    restart_within_s: float = 600.0
    store_bytes: int | None = None
    reserve_bytes: int = 256 << 20
    upload_bytes: int = 1 << 30
    upload_cells: int = 20_000_000
    upload_memory_bytes: int = 8 << 30
    upload_time_s: float = 600.0
    channels: tuple[str, ...] = CHANNEL_NAMES
    worker_silence_s: float = 30.0
    worker_stall_s: float = 600.0
    log_format: str = "text"
    log_level: str = "warning"
    max_runs: int | None = None
    max_cells: int | None = None
    max_gpu_bytes: int | None = None
    max_disk_bytes: int | None = None
    max_edits_per_s: int | None = None
    max_viewers: int | None = None

    @property
    def limits(self) -> TokenLimits:
        """What a token may take that says nothing itself, and the token file."""
        return TokenLimits(**{name: getattr(self, name) for name in NAMES})

    @property
    def upload_rules(self) -> UploadRules:
        """What an upload may take."""
        limits = ImportLimits(
            cells=self.upload_cells, memory_bytes=self.upload_memory_bytes, time_s=self.upload_time_s
        )
        return UploadRules(self.upload_bytes, limits, self.reserve_bytes)

    @property
    def token_path(self) -> Path:
        """The token file."""
        return self.token_file or self.data_dir / "token"
