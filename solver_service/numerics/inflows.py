"""Water that a model gets from above and from pipes: sources and rain, with the checks of their series."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
import numpy.typing as npt

from solver_service.errors import ModelError


def check_series(
    what: str, times: npt.NDArray[np.float64], values: npt.NDArray[np.float64], lowest: float = 0.0
) -> None:
    """Refuse a series that is not finite, not increasing in time, or lower than allowed.

    Args:
        what: what the series is of, for the message.
        times: times [s], [k].
        values: values at these times, [k, ...].
        lowest: smallest value allowed; -inf for any.

    Raises:
        ModelError: naming the entry.
    """
    if times.ndim != 1 or times.size == 0 or values.shape[:1] != times.shape:
        raise ModelError(
            f"The series of {what} has {times.size} times and {len(np.atleast_1d(values))} values; "
            "as many, at least 1."
        )
    rows = values.reshape(times.size, -1)
    for k, time in enumerate(times.tolist()):
        bad = rows[k][~(np.isfinite(rows[k]) & (rows[k] >= lowest))]
        if bad.size or not np.isfinite(time):
            allowed = "a finite value" if lowest == -np.inf else f"a finite value >= {lowest:g}"
            shown = bad[0] if bad.size else rows[k][0]
            raise ModelError(
                f"Entry {k} of the series of {what} is {shown} at {time} s; {allowed} is allowed."
            )
        if k and time <= times[k - 1]:
            raise ModelError(f"Entry {k} of the series of {what} is at {time} s, not after {times[k - 1]} s.")


@dataclass(frozen=True)
class Source:
    """Water that enters in some cells, spread evenly over them.

    Raises:
        ModelError: when the series or the cells are not valid.
    """

    rows: npt.NDArray[np.int32]
    """Rows of the cells, each cell once."""
    cols: npt.NDArray[np.int32]
    """Columns of the cells."""
    times: npt.NDArray[np.float64]
    """Times of the series [s], increasing; no inflow before the first."""
    discharge: npt.NDArray[np.float64]
    """Discharge at these times [m3/s], linear between, held after the last."""
    id: str = ""
    """Name in the budget; unnamed ones are source-1, source-2, ... by their place among the sources."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "rows", np.atleast_1d(np.asarray(self.rows, np.int32)))
        object.__setattr__(self, "cols", np.atleast_1d(np.asarray(self.cols, np.int32)))
        object.__setattr__(self, "times", np.atleast_1d(np.asarray(self.times, np.float64)))
        object.__setattr__(self, "discharge", np.atleast_1d(np.asarray(self.discharge, np.float64)))
        check_series("a source's discharge", self.times, self.discharge)
        if self.rows.ndim != 1 or self.rows.shape != self.cols.shape or self.rows.size == 0:
            raise ModelError(
                f"A source has {self.rows.size} rows and {self.cols.size} columns; as many, at least 1."
            )
        if len(set(zip(self.rows.tolist(), self.cols.tolist(), strict=True))) != self.rows.size:
            raise ModelError("A source names a cell twice; each cell once is allowed.")


@dataclass(frozen=True)
class Rain:
    """Rain in rain cells, each of which covers some rows and columns of the grid.

    Raises:
        ModelError: when the series or the indices are not valid.
    """

    times: npt.NDArray[np.float64]
    """Times of the series [s], increasing; no rain before the first."""
    rates: npt.NDArray[np.float64]
    """Rates at these times [m/s], [k, rain rows, rain columns]."""
    row_index: npt.NDArray[np.int32]
    """Rain row of each row of the grid, [nrows]."""
    col_index: npt.NDArray[np.int32]
    """Rain column of each column of the grid, [ncols]."""
    interpolation: Literal["linear", "step"] = "linear"
    """Between two times: linear, or the rate of the earlier one; the last rate is held."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "times", np.atleast_1d(np.asarray(self.times, np.float64)))
        object.__setattr__(self, "rates", np.ascontiguousarray(self.rates, np.float64))
        for name in ("row_index", "col_index"):
            object.__setattr__(self, name, np.atleast_1d(np.asarray(getattr(self, name), np.int32)))
        if self.rates.ndim != 3 or self.rates.size == 0:
            raise ModelError(
                f"The rain has rates of the shape {self.rates.shape}; (times, rain rows, rain columns), "
                "none of them 0, is allowed."
            )
        check_series("rain", self.times, self.rates)
        for what, index, size in (
            ("row", self.row_index, self.rates.shape[1]),
            ("column", self.col_index, self.rates.shape[2]),
        ):
            if index.ndim != 1 or index.size == 0 or index.min() < 0 or index.max() >= size:
                raise ModelError(f"The rain's {what} index points off its {size} {what}s.")
        if self.interpolation not in ("linear", "step"):
            raise ModelError(
                f"The rain's interpolation is {self.interpolation!r}; allowed are linear and step."
            )

    @staticmethod
    def uniform(
        times: npt.ArrayLike,
        rates: npt.ArrayLike,
        shape: tuple[int, int],
        interpolation: Literal["linear", "step"] = "linear",
    ) -> Rain:
        """The same rain everywhere.

        Args:
            times: times of the series [s].
            rates: rates at these times [m/s].
            shape: (nrows, ncols) of the grid.
            interpolation: see the class.

        Raises:
            ModelError: when the series is not valid.
        """
        times, rates = (np.atleast_1d(np.asarray(part, np.float64)) for part in (times, rates))
        check_series("rain", times, rates)
        nrows, ncols = shape
        index = np.zeros(nrows, np.int32), np.zeros(ncols, np.int32)
        return Rain(times, rates.reshape(-1, 1, 1), *index, interpolation)
