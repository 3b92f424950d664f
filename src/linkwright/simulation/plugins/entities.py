"""Poses and velocities of models and links, by the names in gazebo_ros's services.

Source: gazebo_ros_pkgs for ROS 2 (``gazebo_ros_state``) and its messages.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from functools import partial
from typing import Any

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, did_you_mean, phrase
from linkwright.geometry.single import IDENTITY, Transform, compose, invert, normalized, rotate
from linkwright.messages import Header, Quaternion, Time, Vector3, from_values, get_message
from linkwright.sdf.poses import SEPARATOR, WORLD
from linkwright.simulation.simulation import Simulation

_WORLD_FRAMES = ("", WORLD, "map", "/map")
"""The names of the world's frame."""


class Entities:
    """Access to models and links of a simulation by the names in gazebo_ros's services.

    Args:
        simulation: the simulation of the world.
    """

    def __init__(self, simulation: Simulation) -> None:
        self._simulation = simulation

    def link(self, name: str) -> str:
        """Return the full name of a link, ``model::link``, from its full or short name.

        The short name is sufficient if only one model has such a link.

        Raises:
            LinkwrightError: SIM141, there is no such link, or several models have one.
        """
        return self._find_full_name(name, self._simulation.scene.bodies)

    def joint(self, name: str) -> str:
        """Return the full name of a joint, ``model::joint``, from its full or short name.

        The short name is sufficient if only one model has such a joint.

        Raises:
            LinkwrightError: SIM141, there is no such joint, or several models have one.
        """
        return self._find_full_name(name, self._simulation.scene.joints)

    def model(self, name: str) -> str:
        """Return `name` if a model has this name.

        Raises:
            LinkwrightError: SIM141, there is no such model.
        """
        if name not in self._simulation.scene.models:
            raise _not_found_error(name, self._simulation.scene.models)
        return name

    def frame_pose(self, name: str) -> Transform:
        """Return the pose of a model or link in the world.

        For a name of the world's frame, this is the identity.

        Raises:
            LinkwrightError: SIM141, there is no such entity.
        """
        if name in _WORLD_FRAMES:
            return IDENTITY
        if name in self._simulation.scene.models:
            return self._simulation.model_pose(name)
        return self._simulation.link_pose(self.link(name))

    def state(self, name: str, reference: str = "") -> Any:
        """Return the pose and twist of a model or link as a ``gazebo_msgs/msg/EntityState``.

        Args:
            name: the name of the model or link.
            reference: the model or link in whose frame the state is expressed; the world if empty.

        Raises:
            LinkwrightError: SIM141, there is no such entity.
        """
        simulation = self._simulation
        is_model = name in simulation.scene.models
        link = simulation.scene.models[name].structure.links[0].link.name if is_model else self.link(name)
        pose = simulation.model_pose(name) if is_model else simulation.link_pose(link)
        linear, angular = simulation.link_velocity(link)
        to_reference = invert(self.frame_pose(reference))
        message = get_message("gazebo_msgs/msg/EntityState")(name=name, reference_frame=reference or WORLD)
        message.pose = pose_to_message(compose(to_reference, pose))
        message.twist.linear = from_values(Vector3, rotate(to_reference[3:], tuple(linear.tolist())))
        message.twist.angular = from_values(Vector3, rotate(to_reference[3:], tuple(angular.tolist())))
        return message

    def set_state(self, state: Any) -> None:
        """Set the pose and twist of a model from a message ``gazebo_msgs/msg/EntityState``.

        Raises:
            LinkwrightError: SIM141, there is no such entity; SIM103, the model is fixed to the world.
        """
        name, frame_pose = self.model(state.name), self.frame_pose(state.reference_frame)
        self._simulation.set_model_pose(name, compose(frame_pose, transform_from_message(state.pose)))
        linear, angular = (
            rotate(frame_pose[3:], vector_components(vector)) for vector in (state.twist.linear, state.twist.angular)
        )
        self._simulation.set_model_velocity(name, linear, angular)

    def fill_get_response(self, service: str, request: Any, response: Any, log: Callable[[Phrase], object]) -> Any:
        """Fill in and return the response to ``gazebo_msgs/srv/GetEntityState``.

        `log`, such as a logger's method, receives the reason for a failure.
        """
        response.header = Header(
            stamp=Time.from_nanoseconds(self._simulation.time), frame_id=request.reference_frame or WORLD
        )

        def fill_state() -> None:
            response.state = self.state(request.name, request.reference_frame)

        return _respond_without_message(response, fill_state, service, log)

    def fill_set_response(self, service: str, request: Any, response: Any, log: Callable[[Phrase], object]) -> Any:
        """Set the requested state, and fill in the response to ``gazebo_msgs/srv/SetEntityState``.

        `log`, such as a logger's method, receives the reason for a failure.
        """
        return _respond_without_message(response, partial(self.set_state, request.state), service, log)

    def _find_full_name(self, name: str, full_names: Collection[str]) -> str:
        if name in full_names:
            return name
        matches = [full_name for full_name in full_names if full_name.endswith(f"{SEPARATOR}{name}")]
        if len(matches) == 1:
            return matches[0]
        raise _not_found_error(name, (*self._simulation.scene.models, *full_names))


def _not_found_error(name: str, names: Collection[str]) -> LinkwrightError:
    message = phrase("there is no model or link '{name}'", name=name)
    return LinkwrightError(Diagnostic("SIM141", message, hint=did_you_mean(name, names)))


def fill_response(response: Any, operation: Callable[[], str]) -> Any:
    """Call `operation`, and return the response with `success` and `status_message`.

    `status_message` is the text that `operation` returns, or the reason for a failure.
    """
    try:
        response.success, response.status_message = True, operation()
    except LinkwrightError as error:
        response.success, response.status_message = False, format_finding(error.diagnostics[0])
    return response


def _respond_without_message(
    response: Any, operation: Callable[[], object], service: str, log: Callable[[Phrase], object]
) -> Any:
    """Call `operation`, and return the response with `success`.

    `log` receives the reason for a failure.
    """
    try:
        operation()
        response.success = True
    except LinkwrightError as error:
        response.success = False
        log(describe_refusal(service, error))
    return response


def describe_refusal(service: str, error: LinkwrightError) -> Phrase:
    """Return the reason why a service refused a request, with the hint in parentheses."""
    finding = error.diagnostics[0]
    if finding.hint:
        return phrase("{service}: {problem} ({hint})", service=service, problem=finding.message, hint=finding.hint)
    return phrase("{service}: {problem}", service=service, problem=finding.message)


def format_finding(finding: Diagnostic) -> str:
    """Return a finding on one line: location, message and hint."""
    location = f"{finding.span}: " if finding.span else ""
    hint = f" ({finding.hint})" if finding.hint else ""
    return f"{location}{finding.message}{hint}"


def pose_to_message(pose: Transform) -> Any:
    """Return a pose as a message ``geometry_msgs/msg/Pose``."""
    point = from_values(get_message("geometry_msgs/msg/Point"), pose[:3])
    return get_message("geometry_msgs/msg/Pose")(position=point, orientation=from_values(Quaternion, pose[3:]))


def transform_from_message(message: Any) -> Transform:
    """Return the pose in a message as a transform.

    A quaternion of zeros means no rotation.
    """
    orientation = message.orientation
    quaternion = (orientation.x, orientation.y, orientation.z, orientation.w)
    if not any(quaternion):
        quaternion = (0.0, 0.0, 0.0, 1.0)
    return (*vector_components(message.position), *normalized(*quaternion))


def vector_components(vector: Any) -> tuple[float, float, float]:
    """Return the x, y and z of a point or vector message as a tuple."""
    return vector.x, vector.y, vector.z


def choose_free_name(name: str, names: Sequence[str]) -> str:
    """Return the name, with a number appended if it is in `names`.

    As in gz, the numbers begin with 0: ``box``, ``box_0``, ``box_1``.
    """
    free_name, number = name, 0
    while free_name in names:
        free_name, number = f"{name}_{number}", number + 1
    return free_name
