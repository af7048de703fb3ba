"""The shallow-water solver: arrays and numbers in, arrays and numbers out; no files, no network."""

from solver_service.errors import DeviceError, ModelError, SolverBlowUp
from solver_service.numerics.allocation import Allocation, MemoryOptions, allocation_table, device_bytes
from solver_service.numerics.bed_change import BedChange
from solver_service.numerics.breach import Breach, BreachState
from solver_service.numerics.budget import VolumeBudget
from solver_service.numerics.conduits import ConduitState
from solver_service.numerics.device import device_names, free_memory, pick_device, warm_kernels
from solver_service.numerics.edge_boundary import EdgeBoundary
from solver_service.numerics.gauges import GaugeSeries
from solver_service.numerics.infiltration import Infiltration
from solver_service.numerics.inflows import Rain, Source
from solver_service.numerics.maxima import Maxima
from solver_service.numerics.model import FloodModel
from solver_service.numerics.params import SolverParams
from solver_service.numerics.section import Section, SectionProfile, SectionSeries, SectionTotals
from solver_service.numerics.snapshot import Snapshot
from solver_service.numerics.solver import ShallowWaterSolver
from solver_service.numerics.structures import Culvert, Pump, Structure, Weir

__all__ = [
    "Allocation",
    "BedChange",
    "Breach",
    "BreachState",
    "ConduitState",
    "Culvert",
    "DeviceError",
    "EdgeBoundary",
    "FloodModel",
    "GaugeSeries",
    "Infiltration",
    "Maxima",
    "MemoryOptions",
    "ModelError",
    "Pump",
    "Rain",
    "Section",
    "SectionProfile",
    "SectionSeries",
    "SectionTotals",
    "ShallowWaterSolver",
    "Snapshot",
    "SolverBlowUp",
    "SolverParams",
    "Source",
    "Structure",
    "VolumeBudget",
    "Weir",
    "allocation_table",
    "device_bytes",
    "device_names",
    "free_memory",
    "pick_device",
    "warm_kernels",
]
