"""Long contacts between a model and a target: ``gz-sim-touchplugin-system``.

Source: gz-sim (parameters, topics; the plugin reports one touch, and is then disabled). The service of gz that enables
the plugin takes a message that ROS cannot send to a service, so here it is a ``std_srvs/srv/SetBool``.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from linkwright.diagnostics import phrase
from linkwright.messages import get_message
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.sdf.links import Link
from linkwright.sdf.poses import SEPARATOR
from linkwright.simulation.plugins.parameters import parameter
from linkwright.simulation.plugins.plugin import SimulatedPlugin
from linkwright.simulation.sensors.mount import GeomTable, get_part_name

_COLLISION_MARK = "#collision"
_WHOLE_LINK = "__default__"
"""The collision of a contact sensor that senses all collisions of its link."""


@dataclass(frozen=True, kw_only=True)
class TouchParameters:
    """Parameters of ``gz-sim-touchplugin-system``."""

    target: str = parameter()
    time: float = parameter()
    collision: tuple[str, ...] = ()
    create_contact_sensor_for_collision: bool = False
    namespace: str = ""
    enabled: bool = False


class GzTouch(SimulatedPlugin[TouchParameters]):
    """The substitute for ``gz-sim-touchplugin-system``."""

    PARAMETERS = TouchParameters
    CARRIED = ("_is_enabled", "_touch_start")

    def start(self) -> None:
        """Find the collisions, and create the topic and the service.

        Raises:
            LinkwrightError: SIM160, no collision of the model has a contact sensor.
        """
        parameters, simulation = self.parameters, self.simulation
        own_collisions = set(self._find_own_collisions())
        if not own_collisions:
            raise self.parameter_error(
                phrase(
                    "plugin '{plugin}': no such collision of '{model}' has a contact sensor",
                    plugin=self.context.name,
                    model=self.context.path,
                )
            )
        for name in own_collisions:
            simulation.keep_awake(name.rpartition(SEPARATOR)[0])

        def mark_own_geoms(geoms: list[str]) -> list[float]:
            return [float(_get_collision(geom) in own_collisions) for geom in geoms]

        def mark_target_geoms(geoms: list[str]) -> list[float]:
            return [float(self._is_target(_get_collision(geom))) for geom in geoms]

        self._own_table, self._target_table = (
            GeomTable(simulation, mark_own_geoms),
            GeomTable(simulation, mark_target_geoms),
        )
        self.reset()
        base = f"/{parameters.namespace.strip('/')}" if parameters.namespace else self._build_default_namespace()
        self._output = self.node.publisher("std_msgs/msg/Bool", f"{base}/touched")
        self.node.service("std_srvs/srv/SetBool", f"{base}/enable", self._on_enable)
        self.every(0.0, self._check_contacts)

    def reset(self) -> None:
        """Restore the initial state, enabled or disabled."""
        self._set_enabled(is_enabled=self.parameters.enabled)

    def _build_default_namespace(self) -> str:
        return f"/model/{self.context.path.replace(SEPARATOR, '/model/')}/touch"

    def _find_own_collisions(self) -> Iterator[str]:
        """Yield the full names of the collisions whose contacts count."""
        parameters, model = self.parameters, self.context.model
        for link in () if model is None else model.links:
            sensed_names = _find_sensed_collisions(link)
            for collision in link.collisions:
                name = SEPARATOR.join((self.context.path, link.name, collision.name))
                is_selected = not parameters.collision or collision.name in parameters.collision
                has_sensor = parameters.create_contact_sensor_for_collision or bool(
                    sensed_names & {collision.name, _WHOLE_LINK}
                )
                if has_sensor and (is_selected or name in parameters.collision):
                    yield name

    def _is_target(self, collision: str) -> bool:
        """Return whether a collision is the target.

        A part of its name is enough, with the separators of gz or of SDF.
        """
        return self.parameters.target in collision or self.parameters.target in collision.replace(SEPARATOR, "/")

    def _on_enable(self, request: Any, response: Any) -> Any:
        self._set_enabled(is_enabled=bool(request.data))
        response.success = True
        return response

    def _set_enabled(self, *, is_enabled: bool) -> None:
        self._is_enabled = is_enabled
        self._touch_start: int | None = None

    def _check_contacts(self) -> None:
        if not self._is_enabled:
            return
        if not self._is_touching():
            self._touch_start = None
            return
        now = self.simulation.time
        if self._touch_start is None:
            self._touch_start = now
        if now - self._touch_start > self.parameters.time * NANOSECONDS_PER_SECOND:
            self._output.publish(get_message("std_msgs/msg/Bool")(data=True))
            self._set_enabled(is_enabled=False)

    def _is_touching(self) -> bool:
        data = self.simulation.data
        if not data.ncon:
            return False
        first, second = data.contact.geom[: data.ncon].T
        own, target = self._own_table.array() > 0.0, self._target_table.array() > 0.0
        return bool(((own[first] & target[second]) | (own[second] & target[first])).any())


def _find_sensed_collisions(link: Link) -> set[str]:
    """Return the names of the collisions that the contact sensors of a link sense."""
    return {
        sensor.contact.collision.rpartition(SEPARATOR)[2] if sensor.contact is not None else _WHOLE_LINK
        for sensor in link.sensors
        if sensor.type == "contact"
    }


def _get_collision(geom: str) -> str:
    """Return the full name of the collision to which a geom belongs, or an empty text."""
    name, mark, _ = get_part_name(geom).partition(_COLLISION_MARK)
    return name if mark else ""
