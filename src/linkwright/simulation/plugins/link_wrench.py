"""Forces and torques on links, commanded on topics: ``gz-sim-apply-link-wrench-system``.

Source: gz-sim (parameters, topics, meaning: both are in the axes of the world, and the force acts at the origin of the
link). Commands are ``ros_gz_interfaces/msg/EntityWrench`` and ``ros_gz_interfaces/msg/Entity``, to which a bridge
converts the messages of gz.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from linkwright.diagnostics import LinkwrightError, phrase
from linkwright.geometry.arrays import Array
from linkwright.messages import get_message
from linkwright.simulation.plugins.entities import Entities, vector_components
from linkwright.simulation.plugins.plugin import SimulatedPlugin
from linkwright.xmltree import Element

_WRENCH_TYPE, _ENTITY_TYPE = "ros_gz_interfaces/msg/EntityWrench", "ros_gz_interfaces/msg/Entity"


@dataclass(frozen=True, kw_only=True)
class LinkWrenchParameters:
    """Parameters of ``gz-sim-apply-link-wrench-system``."""

    topic: str = ""
    topic_persistent: str = ""
    topic_clear: str = ""


@dataclass(frozen=True, slots=True)
class _Wrench:
    """A wrench on an entity.

    Attributes:
        name: the name of a link or of a model, whose first link is meant.
        is_model: whether the name is that of a model.
        values: the force in N and the torque in N m, in the axes of the world.
    """

    name: str
    is_model: bool
    values: Array


class GzLinkWrench(SimulatedPlugin[LinkWrenchParameters]):
    """The substitute for ``gz-sim-apply-link-wrench-system``, a plugin of the world.

    A wrench acts for one step, or persistently until it is cleared. Persistent wrenches may name entities that do not
    exist yet.
    """

    PARAMETERS = LinkWrenchParameters
    IGNORED = ("persistent", "verbose")  # the first is read by reset
    CARRIED = ("_persistent_wrenches",)

    def start(self) -> None:
        """Read the persistent wrenches of the parameters, and subscribe to the commands.

        Raises:
            LinkwrightError: SIM160, a persistent wrench is not valid.
        """
        parameters, node = self.parameters, self.node
        self._entities = Entities(self.simulation)
        self.reset()
        base = f"/world/{self.context.world.name}/wrench"
        node.subscribe(_WRENCH_TYPE, parameters.topic or base, self._on_wrench, stop_motion=_ignore)
        topic = parameters.topic_persistent or f"{base}/persistent"
        node.subscribe(_WRENCH_TYPE, topic, self._on_persistent_wrench, stop_motion=_ignore)
        node.subscribe(_ENTITY_TYPE, parameters.topic_clear or f"{base}/clear", self._on_clear)
        self.every(0.0, self._apply_wrenches)

    def reset(self) -> None:
        """Restore the wrenches of the parameters."""
        element = self.context.element
        self._new_wrenches: list[_Wrench] = []
        self._persistent_wrenches = (
            [] if element is None else [self._read_wrench(child) for child in element.elements("persistent")]
        )

    def _read_wrench(self, element: Element) -> _Wrench:
        texts = {tag: self.text_in(element, tag) for tag in ("entity_name", "entity_type", "force", "torque")}
        try:
            values = [float(word) for tag in ("force", "torque") for word in (texts[tag] or "0 0 0").split()]
        except ValueError:
            values = []
        if not texts["entity_name"] or texts["entity_type"] not in ("link", "model") or len(values) != 6:
            message = phrase(
                "plugin '{plugin}': <persistent> needs an <entity_name>, an <entity_type> 'link' or 'model', "
                "and three numbers in <force> and <torque>",
                plugin=self.context.name,
            )
            raise self.parameter_error(message)
        return _Wrench(texts["entity_name"], texts["entity_type"] == "model", np.array(values))

    def _on_wrench(self, message: Any) -> None:
        wrench = _parse_wrench(message)
        try:
            self._find_link(wrench)
        except LinkwrightError as error:
            self.node.logger.warning(error.diagnostics[0].message)
        else:
            self._new_wrenches.append(wrench)

    def _on_persistent_wrench(self, message: Any) -> None:
        self._persistent_wrenches.append(_parse_wrench(message))

    def _on_clear(self, message: Any) -> None:
        cleared_entity = self._find_full_name(message.name, is_model=_is_model(message))
        self._persistent_wrenches = [
            wrench
            for wrench in self._persistent_wrenches
            if self._find_full_name(wrench.name, is_model=wrench.is_model) != cleared_entity
        ]

    def _find_full_name(self, name: str, *, is_model: bool) -> str:
        """Return the full name of an entity, or the given name if the entity does not exist."""
        try:
            return self._entities.model(name) if is_model else self._entities.link(name)
        except LinkwrightError:
            return name

    def _find_link(self, wrench: _Wrench) -> str:
        """Return the link on which a wrench acts.

        Raises:
            LinkwrightError: SIM141, there is no such entity.
        """
        if not wrench.is_model:
            return self._entities.link(wrench.name)
        model = self.simulation.scene.models[self._entities.model(wrench.name)]
        return model.structure.links[0].link.name

    def _apply_wrenches(self) -> None:
        """Apply all wrenches for the next step."""
        totals: dict[str, Array] = {}
        for wrench in (*self._persistent_wrenches, *self._new_wrenches):
            try:
                link = self._find_link(wrench)
            except LinkwrightError:
                continue  # the entity may exist later
            totals[link] = totals.get(link, 0.0) + wrench.values
        self._new_wrenches = []
        self.stop_pushing(except_links=totals)
        for link, values in totals.items():
            self.push(link, values[:3], values[3:], at=self.simulation.link_pose(link)[:3])


def _ignore() -> None:
    """Keep the wrenches that act when a command with NaN is dropped."""


def _is_model(entity: Any) -> bool:
    return bool(entity.type == get_message(_ENTITY_TYPE).MODEL)


def _parse_wrench(message: Any) -> _Wrench:
    values = (*vector_components(message.wrench.force), *vector_components(message.wrench.torque))
    return _Wrench(message.entity.name, _is_model(message.entity), np.array(values))
