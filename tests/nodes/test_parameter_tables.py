"""Parameters of nodes from dataclasses.

Parameters of controllers are tested with the controllers.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.graph import Graph, Parameter, ParameterType
from linkwright.nodes.parameter_tables import declare_table, for_each, list_entries, one_of, parameter


@dataclass(frozen=True, kw_only=True)
class Place:
    x: float = 0.5


@dataclass(frozen=True, kw_only=True)
class Settings:
    frame: str = parameter("map", description="of the plan")
    places: tuple[str, ...] = ("here",)
    limit: float | None = None
    start: Place = Place()


async def test_table_is_declared_under_prefix_and_read(graph: Graph) -> None:
    node = graph.create_node("planner", parameters={"plan.start.x": 2.0})
    assert declare_table(node, Settings, "plan") == Settings(start=Place(x=2.0))
    assert node.get_parameter("plan.places").type_ is ParameterType.STRING_ARRAY
    assert node.describe_parameters(["plan.frame"])[0].description == "of the plan"


async def test_declared_table_is_read_again_with_changes(graph: Graph) -> None:
    node = graph.create_node("planner")
    declare_table(node, Settings)
    node.set_parameters([Parameter("frame", value="odom"), Parameter("limit", value=1.5)])
    assert declare_table(node, Settings) == Settings(frame="odom", limit=1.5)


async def test_custom_defaults_replace_table_defaults(graph: Graph) -> None:
    defaults = Settings(frame="odom", places=("a", "b"))
    assert declare_table(graph.create_node("planner"), Settings, defaults=defaults) == defaults


async def test_value_of_wrong_type_is_rejected(graph: Graph) -> None:
    node = graph.create_node("planner", parameters={"frame": 1.0})
    with pytest.raises(LinkwrightError) as caught:
        declare_table(node, Settings)
    assert caught.value.diagnostics[0].code == "GRAPH201"


@dataclass(frozen=True, kw_only=True)
class Wheel:
    """A wheel.

    Attributes:
        radius: in meters,
            with the tyre.
    """

    radius: float = 0.1


@dataclass(frozen=True, kw_only=True)
class Drive:
    wheels: tuple[str, ...] = parameter((), description="the joints")
    kind: str = parameter("front", check=one_of("front", "rear"))
    sizes: Mapping[str, Wheel] = for_each("wheels", Wheel)


def test_entries_describe_parameters_without_node():
    wheels, kind, radius = list_entries(Drive)
    assert (wheels.name, wheels.kind, wheels.description) == ("wheels", ParameterType.STRING_ARRAY, "the joints")
    assert (kind.default, kind.choices) == ("front", ("front", "rear"))
    assert (radius.name, radius.keys, radius.description) == (
        "sizes.*.radius",
        ("wheels",),
        "in meters, with the tyre.",
    )
