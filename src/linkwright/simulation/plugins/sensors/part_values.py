"""Values that plugins give to models and their visuals, such as labels and temperatures."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import TypeVar

from linkwright.sdf.models import Model
from linkwright.sdf.plugins import Plugin
from linkwright.sdf.poses import SEPARATOR
from linkwright.simulation.simulation import Simulation

V = TypeVar("V")


def find_part_values(simulation: Simulation, read: Callable[[Plugin], V | None]) -> dict[str, V]:
    """Return the values of models and visuals, by their names as in `get_part_name`.

    Args:
        simulation: the simulation of the world.
        read: returns the value that a plugin gives, or None if it gives none.
    """
    models = simulation.scene.models.values()
    return dict(item for model in models for item in _find_model_values(model.model, model.name, read))


def _find_model_values(model: Model, path: str, read: Callable[[Plugin], V | None]) -> Iterator[tuple[str, V]]:
    for plugin in model.plugins:
        if (value := read(plugin)) is not None:
            yield path, value
    for link in model.links:
        for visual in link.visuals:
            for plugin in visual.plugins:
                if (value := read(plugin)) is not None:
                    yield f"{path}{SEPARATOR}{link.name}{SEPARATOR}{visual.name}#visual", value
    for nested_model in model.models:
        yield from _find_model_values(nested_model, f"{path}{SEPARATOR}{nested_model.name}", read)


def get_closest_value(values: Mapping[str, V], part: str, default: V) -> V:
    """Return the value of a visual, or else of the closest enclosing model with a value, or else a default."""
    name = part
    while name:
        if name in values:
            return values[name]
        name = name.rpartition(SEPARATOR)[0]
    return default
