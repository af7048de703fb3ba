"""The answer to `get_imagery`: a picture of a run's terrain in parts."""

from __future__ import annotations

from protocol import GetImagery, ImageryPart
from protocol.limits import PART_BYTES
from solver_service.errors import RunError
from solver_service.runs import RunRegistry

__all__ = ["imagery_parts"]


async def imagery_parts(command: GetImagery, registry: RunRegistry) -> list[ImageryPart]:
    """The messages that carry a picture of the terrain of a run.

    Raises:
        RunError: there is no such run, or its terrain has no such picture.
        StoreError: the picture cannot be read.
    """
    run, layer = command.run, command.layer
    layers = registry.tree.get(run).facts.layers
    if layer not in layers:
        raise RunError(f"run {run} has no {layer} of its terrain; it has {', '.join(layers) or 'none'}")
    data = await registry.read_layer(run, layer)
    count = max(1, -(-len(data) // PART_BYTES))
    return [
        ImageryPart(command.id, run, layer, part, count, data[part * PART_BYTES : (part + 1) * PART_BYTES])
        for part in range(count)
    ]
