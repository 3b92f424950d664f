"""RViz's Topic property: a topic's name, and the quality of service to subscribe to it with."""

from __future__ import annotations

from linkwright.graph import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy
from linkwright.viewer.config.property_store import Path, PropertyStore
from linkwright.viewer.config.schema import PropertySpec

SYSTEM_DEFAULT = "System Default"
FILTER_SIZE = "Filter size"


def topic_spec(
    name: str = "Topic",
    default: str = "",
    description: str = "The topic to listen to.",
    *,
    depth: int = 5,
    durability: str = "Volatile",
    reliability: str = "Reliable",
    filter_size: int | None = None,
    durability_help: str = "Whether a message published before counts too.",
    when: tuple[Path, str] | None = None,
    messages: tuple[str, ...] = (),
) -> PropertySpec:
    """The property with its parts.

    Args:
        name: of the property.
        default: topic.
        description: the tooltip.
        depth: RViz's default for how many messages may wait.
        durability: RViz's default.
        reliability: RViz's default.
        filter_size: default of how many messages wait for their transforms; None where they need none.
        durability_help: the tooltip of ``Durability Policy``.
        when: as `PropertySpec.when`.
        messages: as `PropertySpec.messages`.
    """
    children = [
        PropertySpec("Depth", "int", depth, "How many messages may wait.", minimum=1, maximum=1000),
        PropertySpec(
            "History Policy",
            "enum",
            "Keep Last",
            "Whether only the last messages wait, or all.",
            options=("Keep Last", "Keep All", SYSTEM_DEFAULT),
        ),
        PropertySpec(
            "Reliability Policy",
            "enum",
            reliability,
            "Whether every message must arrive.",
            options=("Reliable", "Best Effort", SYSTEM_DEFAULT),
        ),
        PropertySpec(
            "Durability Policy",
            "enum",
            durability,
            durability_help,
            options=("Volatile", "Transient Local", SYSTEM_DEFAULT),
        ),
    ]
    if filter_size is not None:
        children.append(
            PropertySpec(
                FILTER_SIZE,
                "int",
                filter_size,
                "How many messages may wait for their transforms.",
                minimum=1,
                maximum=1000,
            )
        )
    return PropertySpec(name, "topic", default, description, messages=messages, children=tuple(children), when=when)


def qos_of(properties: PropertyStore, name: str = "Topic", *, lasting: bool | None = None) -> QoSProfile:
    """The quality of service that a Topic property asks for.

    Args:
        properties: of the display.
        name: of the property.
        lasting: whether messages published before count too, whatever the property says.
    """
    get = properties.text
    keep_all = get(name, "History Policy") == "Keep All"
    best_effort = get(name, "Reliability Policy") == "Best Effort"
    if lasting is None:
        lasting = get(name, "Durability Policy") == "Transient Local"
    return QoSProfile(
        depth=int(properties.number(name, "Depth")),
        history=HistoryPolicy.KEEP_ALL if keep_all else HistoryPolicy.KEEP_LAST,
        reliability=ReliabilityPolicy.BEST_EFFORT if best_effort else ReliabilityPolicy.RELIABLE,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if lasting else DurabilityPolicy.VOLATILE,
    )
