"""What can go wrong in the service, as one tree.

    ServiceError
        ModelError          a flood model or solver parameter is not valid
        DeviceError         a device is named but absent, or cannot be used
        SolverBlowUp        the computation gave a value that is not finite, or its time step collapsed
        TerrainError        a terrain file cannot be read or is not what it must be
        CaseError           a case file or one of the files it names is not valid
            CaseTooLarge    an archive has more bytes than may be uploaded
        StoreError          the data folder cannot be read or written
            StoreFull       there is no room in the data folder
        RunError            a run cannot do what was asked of it
        ServeError          the service cannot listen
        AccessError         a token does not allow this, or the tokens cannot be read or written
            QuotaError      the holder of a token would take more than is allowed

Every message is one sentence that names the file, key or cell, the value, and what is allowed.
"""

from __future__ import annotations


class ServiceError(Exception):
    """Base of everything the service refuses or fails at."""


class ModelError(ServiceError):
    """A flood model or a solver parameter is not valid."""


class DeviceError(ServiceError):
    """A device is named but absent, or cannot be used."""


class SolverBlowUp(ServiceError):
    """The computation gave a value that is not finite, or its time step collapsed.

    Args:
        time: simulation time [s] of the state that was found bad.
        row: grid row of the cell.
        col: grid column of the cell.
        value: the value found there, as text with its name and unit.
        cause: the likely cause, as a clause.
    """

    def __init__(self, time: float, row: int, col: int, value: str, cause: str) -> None:
        super().__init__(
            f"The run stopped at {time:.3f} s in cell (row {row}, column {col}): {value}; {cause}."
        )
        self.time = time
        self.row = row
        self.col = col
        self.value = value
        self.cause = cause

    def __reduce__(self) -> tuple[type[SolverBlowUp], tuple[float, int, int, str, str]]:
        return (SolverBlowUp, (self.time, self.row, self.col, self.value, self.cause))


class TerrainError(ServiceError):
    """A terrain file cannot be read or is not what it must be."""


class CaseError(ServiceError):
    """A case file, or one of the files it names, is not valid."""


class CaseTooLarge(CaseError):
    """An archive has more bytes than may be uploaded."""


class StoreError(ServiceError):
    """The data folder cannot be read or written."""


class StoreFull(StoreError):
    """There is no room in the data folder: the disk, a quota or the budget of the service is full."""


class RunError(ServiceError):
    """A run cannot do what was asked of it."""


class ServeError(ServiceError):
    """The service cannot listen."""


class AccessError(ServiceError):
    """A token does not allow this, or the tokens cannot be read or written."""


class QuotaError(AccessError):
    """The holder of a token would take more than is allowed.

    Args:
        limit: name of the limit, such as `max_runs`.
        sentence: what was asked and what is allowed.
    """

    def __init__(self, limit: str, sentence: str) -> None:
        super().__init__(sentence)
        self.limit = limit
