"""What a terrain edit is and what it does to the bed: the same bits in the preview and in the solver."""

from __future__ import annotations

from protocol.edits.apply import EditedBed, apply_edits, edited_cells
from protocol.edits.check import check_edit
from protocol.edits.log import EditLog
from protocol.edits.model import Edit, EditArea, EditLine, EditType, Operation
from protocol.edits.raster import rasterise_edit

__all__ = [
    "Edit",
    "EditArea",
    "EditLine",
    "EditLog",
    "EditType",
    "EditedBed",
    "Operation",
    "apply_edits",
    "check_edit",
    "edited_cells",
    "rasterise_edit",
]
