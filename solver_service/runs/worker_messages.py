"""What the web process and a worker say to each other through their pipe.

Commands go to the worker, reports come back. Both ends are this program, so plain pickled values are enough.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from protocol import ChannelName
from solver_service.runs.case_facts import CaseFacts
from solver_service.runs.lineage import Leg
from solver_service.runs.worker_failure import FailureKind
from solver_service.store import CheckpointRecord, FrameRecord


@dataclass(frozen=True)
class WorkerSettings:
    """What a worker is told when it is born.

    Attributes:
        data_dir: the data folder.
        epoch: epoch of the service; its rows are refused once another service has begun.
        ring_bytes: memory for recent states [bytes].
        checkpoint_interval_s: wall time between checkpoints on disk [s].
        threads: solver threads on the CPU; None for all cores.
        device: device whose kernels are loaded ahead.
        log_format: "text" or "json".
        log_level: least level of the lines it writes.
    """

    data_dir: Path
    epoch: int
    ring_bytes: int
    checkpoint_interval_s: float
    threads: int | None
    device: str
    log_format: str = "text"
    log_level: str = "warning"


@dataclass(frozen=True)
class LoadCase:
    """Load a case and keep it; answered by CaseLoaded or CaseRefused."""

    case: str
    device: str


@dataclass(frozen=True)
class Begin:
    """Compute this run now, whatever was computed before (which stays resumable).

    Attributes:
        run: the run; the last leg of its lineage.
        case: case to load if it is not the one at hand.
        case_fingerprint: what the case must still be.
        device: where to compute.
        legs: the lineage.
        output_interval: time between frames [s].
        last_index: index of the last frame.
        paused: bring the run to its first frame only and wait.
        number: tells this order from others for the same run; comes back with `Left`.
        channels: what goes with its frames beside the depth.
    """

    run: str
    case: str
    case_fingerprint: str
    device: str
    legs: tuple[Leg, ...]
    output_interval: float
    last_index: int
    paused: bool = False
    number: int = 0
    channels: tuple[ChannelName, ...] = ()


@dataclass(frozen=True)
class Pause:
    """Stop between two steps, checkpoint, wait; a run without a frame gets its first one before it waits.

    `final` runs are not resumed and need neither.
    """

    run: str
    final: bool = False


@dataclass(frozen=True)
class SaveState:
    """Put the state of a lineage at a frame on disk for another worker; answered by StateSaved."""

    run: str
    index: int


@dataclass(frozen=True)
class Quit:
    """Checkpoint what is running and end."""


Command = LoadCase | Begin | Pause | SaveState | Quit


@dataclass(frozen=True)
class Ready:
    """The worker has loaded its kernels."""

    pid: int
    devices: tuple[str, ...]


@dataclass(frozen=True)
class Pulse:
    """The process lives; comes each second from a thread of its own.

    Attributes:
        looks: how often the solver thread has looked for commands.
        waits: whether it waits for one.
    """

    looks: int
    waits: bool


@dataclass(frozen=True)
class Unfit:
    """The worker cannot compute here and ends."""

    message: str


@dataclass(frozen=True)
class CaseLoaded:
    """The case is in memory.

    Attributes:
        case: its name.
        title: its title.
        fingerprint: hash of its bed and forcing.
        facts: what the run tree keeps of it.
        duration: simulated time it asks for [s].
        output_interval: time between frames it asks for [s].
        device: the device that computes.
    """

    case: str
    title: str
    fingerprint: str
    facts: CaseFacts
    duration: float
    output_interval: float
    device: str


@dataclass(frozen=True)
class CaseRefused:
    """The case cannot be computed."""

    case: str
    message: str


@dataclass(frozen=True)
class Running:
    """The state is at hand and the run computes."""

    run: str


@dataclass(frozen=True)
class FrameStored:
    """A frame has its row.

    Attributes:
        frame: the row.
        waited_s: how long the solver waited to hand the frame over [s].
        stored_s: from the hand-over to the row [s].
    """

    frame: FrameRecord
    waited_s: float
    stored_s: float


@dataclass(frozen=True)
class CheckpointStored:
    """A checkpoint has its row."""

    checkpoint: CheckpointRecord


@dataclass(frozen=True)
class StateSaved:
    """The answer to SaveState; `ok` is False when the worker holds no such state any more."""

    run: str
    index: int
    ok: bool


@dataclass(frozen=True)
class ProgressReport:
    """Where the computation stands; the fields of the wire's `progress`."""

    run: str
    time: float
    steps: int
    dt: float
    speed_x_real_time: float
    wall_s: float
    cell_steps_per_s: float
    volume_error_relative: float
    wet_cells: int
    limiting_cell: tuple[int, int] | None
    eta_s: float | None


@dataclass(frozen=True)
class BudgetReport:
    """Where the water came from and went, up to a frame; `budget` is that of the solver by name."""

    run: str
    time: float
    budget: dict[str, Any]


@dataclass(frozen=True)
class Paused:
    """The run waits; `message` says why when nobody asked for it.

    Attributes:
        run: the run.
        message: a sentence, or nothing.
        lacks_room: whether it waits for room on the disk and may go on by itself when there is some.
        number: number of the Begin that is paused; 0 where it waits whatever was asked since.
    """

    run: str
    message: str = ""
    lacks_room: bool = False
    number: int = 0


@dataclass(frozen=True)
class Failed:
    """The run cannot go on in this process.

    Attributes:
        run: the run, or nothing when none was computed.
        kind: what went wrong.
        message: a clause for people.
        ending: whether the process ends with it.
    """

    run: str
    kind: FailureKind
    message: str
    ending: bool = False


@dataclass(frozen=True)
class Left:
    """Nothing of this run is on its way to the disk any more, until another Begin.

    Attributes:
        run: the run.
        number: number of the last Begin that was obeyed.
    """

    run: str
    number: int


@dataclass(frozen=True)
class Remark:
    """Something a person should know although the run goes on."""

    run: str
    message: str


Report = (
    Ready
    | Pulse
    | Unfit
    | CaseLoaded
    | CaseRefused
    | Running
    | FrameStored
    | CheckpointStored
    | StateSaved
    | ProgressReport
    | BudgetReport
    | Paused
    | Failed
    | Left
    | Remark
)
