"""World plugins whose services fix links of two models to each other.

They are ``libgazebo_link_attacher.so`` and ``libgazebo_ros_link_attacher.so``.

Source: IFRA_LinkAttacher and gazebo_ros_link_attacher (services, types, texts). There, the joint is a revolute joint
whose limits are 0; here, the links are fixed. IFRA_LinkAttacher keeps one pair attached at a time.
"""

from __future__ import annotations

from typing import Any

from linkwright.geometry.single import compose, invert
from linkwright.sdf.poses import SEPARATOR
from linkwright.simulation.plugins.parameters import NoParameters
from linkwright.simulation.plugins.plugin import SimulatedPlugin

_Pair = tuple[str, str]
"""The full names of two links."""


class _LinkAttacher(SimulatedPlugin[NoParameters]):
    """Fixes pairs of links."""

    CARRIED = ("_pairs",)

    def reset(self) -> None:
        """Separate all links."""
        for pair in list(self._pairs):
            self.detach(pair)

    def stop(self) -> None:
        """Separate all links, because the world may be removed next."""
        self.reset()

    def start_pairs(self) -> None:
        """Forget all pairs."""
        self._pairs: set[_Pair] = set()

    @property
    def has_pairs(self) -> bool:
        """Whether a pair is attached whose links still exist."""
        scene = self.simulation.scene
        self._pairs = {pair for pair in self._pairs if scene.is_welded(*pair)}
        return bool(self._pairs)

    def find_missing(self, model: str, link: str) -> str:
        """Return the name of the model or link that does not exist, or an empty text."""
        scene = self.simulation.scene
        if model not in scene.models:
            return model
        return "" if f"{model}{SEPARATOR}{link}" in scene.bodies else link

    def attach(self, pair: _Pair) -> None:
        """Fix the second link to the first one, where they are."""
        simulation = self.simulation
        first_pose, second_pose = (simulation.link_pose(link) for link in pair)
        if not simulation.scene.is_welded(*pair):
            simulation.scene.weld(*pair, compose(invert(first_pose), second_pose))
            self._apply_change()
        self._pairs.add(pair)

    def detach(self, pair: _Pair) -> bool:
        """Separate two links, and return whether they were attached."""
        scene = self.simulation.scene
        was_attached = pair in self._pairs and scene.is_welded(*pair)
        self._pairs.discard(pair)
        if was_attached:
            scene.unweld(*pair)
            self._apply_change()
        return was_attached

    def _apply_change(self) -> None:
        self.simulation.mark_changed()
        self.simulation.refresh()


class LinkAttacher(_LinkAttacher):
    """The substitute for ``libgazebo_link_attacher.so``, with the services ``ATTACHLINK`` and ``DETACHLINK``."""

    def start(self) -> None:
        """Create the services."""
        self.start_pairs()
        self.node.service("linkattacher_msgs/srv/AttachLink", "ATTACHLINK", self._on_attach)
        self.node.service("linkattacher_msgs/srv/DetachLink", "DETACHLINK", self._on_detach)

    def _on_attach(self, request: Any, response: Any) -> Any:
        for model, link in ((request.model1_name, request.link1_name), (request.model2_name, request.link2_name)):
            if missing := self.find_missing(model, link):
                kind = "model" if missing == model else "link"
                response.success, response.message = False, f"Failed to find {kind} with name: {missing}"
                return response
        if self.has_pairs:
            response.success = False
            response.message = "Both links have already been attached, aborting new attachment."
            return response
        self.attach(_read_pair(request))
        response.success, response.message = True, f"ATTACHED: {_describe(request)}"
        return response

    def _on_detach(self, request: Any, response: Any) -> Any:
        response.success = self.detach(_read_pair(request))
        failure = "" if response.success else " -- ERROR (Joint does not exist!)"
        response.message = f"DETACHED{failure}: {_describe(request)}"
        return response


class RosLinkAttacher(_LinkAttacher):
    """The substitute for ``libgazebo_ros_link_attacher.so``.

    The services are ``/link_attacher_node/attach`` and ``/link_attacher_node/detach``, and in ports for ROS 2
    ``/attach`` and ``/detach``.
    """

    def start(self) -> None:
        """Create the services."""
        self.start_pairs()
        for prefix in ("/link_attacher_node", ""):
            self.node.service("gazebo_ros_link_attacher/srv/Attach", f"{prefix}/attach", self._on_attach)
            self.node.service("gazebo_ros_link_attacher/srv/Attach", f"{prefix}/detach", self._on_detach)

    def _on_attach(self, request: Any, response: Any) -> Any:
        parts = (request.model_name_1, request.link_name_1), (request.model_name_2, request.link_name_2)
        response.ok = not any(self.find_missing(*part) for part in parts)
        if response.ok:
            first, second = (SEPARATOR.join(part) for part in parts)
            self.attach((first, second))
        return response

    def _on_detach(self, request: Any, response: Any) -> Any:
        first = f"{request.model_name_1}{SEPARATOR}{request.link_name_1}"
        second = f"{request.model_name_2}{SEPARATOR}{request.link_name_2}"
        response.ok = self.detach((first, second))
        return response


def _read_pair(request: Any) -> _Pair:
    """Return the links of a request."""
    return (
        f"{request.model1_name}{SEPARATOR}{request.link1_name}",
        f"{request.model2_name}{SEPARATOR}{request.link2_name}",
    )


def _describe(request: Any) -> str:
    return (
        f"{{MODEL , LINK}} -> {{{request.model1_name} , {request.link1_name}}} -- "
        f"{{{request.model2_name} , {request.link2_name}}}."
    )
