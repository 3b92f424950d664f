"""Services for physical properties of models, links and joints.

The library is ``libgazebo_ros_properties.so``.

Source: gazebo_ros_pkgs for ROS 2 (services and their responses). The services do not cover lights, nor settings that
only the physics engine ODE has.
"""

from __future__ import annotations

from math import inf
from typing import Any

import numpy as np

from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase
from linkwright.geometry.validity import TOLERANCE, is_positive_definite, triangle_excess
from linkwright.messages import Vector3, from_values
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.sdf.poses import SEPARATOR
from linkwright.sdf.worlds import find_physics
from linkwright.simulation.plugins.entities import Entities, fill_response, pose_to_message, vector_components
from linkwright.simulation.plugins.parameters import NoParameters
from linkwright.simulation.plugins.plugin import SimulatedPlugin
from linkwright.simulation.scene.bodies import set_coefficient, set_joint_range

_JOINT_TYPES = {"revolute": 0, "continuous": 1, "prismatic": 2, "fixed": 3, "ball": 4, "universal": 5}
"""The joint types of ``GetJointProperties``, by their names in SDF."""
_UNREACHABLE_LIMIT = 1e9
"""A joint limit in rad (or m) that is never reached."""


class ClassicProperties(SimulatedPlugin[NoParameters]):
    """The substitute for ``libgazebo_ros_properties.so``, a plugin of a world."""

    def start(self) -> None:
        """Create the services that get and set properties."""
        self._entities = Entities(self.simulation)
        for name, callback in (
            ("GetModelProperties", self._get_model),
            ("GetLinkProperties", self._get_link),
            ("GetJointProperties", self._get_joint),
            ("SetLinkProperties", self._set_link),
            ("SetJointProperties", self._set_joint),
            ("GetPhysicsProperties", self._get_physics),
            ("SetPhysicsProperties", self._set_physics),
        ):
            verb, kind = name[:3].lower(), name[3:].removesuffix("Properties").lower()
            self.node.service(f"gazebo_msgs/srv/{name}", f"{verb}_{kind}_properties", callback)

    def _get_model(self, request: Any, response: Any) -> Any:
        def get_properties() -> str:
            scene_model = self.simulation.scene.models[self._entities.model(request.model_name)]
            model, prefix = scene_model.model, f"{scene_model.name}{SEPARATOR}"
            response.canonical_link_name = prefix + (
                model.canonical_link or next((link.name for link in model.links), "")
            )
            response.link_names = [prefix + link.name for link in model.links]
            response.collision_names = [collision.name for link in model.links for collision in link.collisions]
            response.joint_names = [joint.name for joint in model.joints]
            response.child_model_names = [nested.name for nested in model.models]
            response.is_static = model.static
            return "GetModelProperties: got properties"

        return fill_response(response, get_properties)

    def _get_link(self, request: Any, response: Any) -> Any:
        def get_properties() -> str:
            simulation = self.simulation
            index = simulation.body(self._entities.link(request.link_name))
            body = simulation.model.body(index)
            w, x, y, z = body.iquat.tolist()
            response.com = pose_to_message((*body.ipos.tolist(), x, y, z, w))
            response.gravity_mode = bool(simulation.model.body_gravcomp[index] == 0.0)
            response.mass = float(body.mass[0])
            response.ixx, response.iyy, response.izz = body.inertia.tolist()
            return "GetLinkProperties: got properties"

        return fill_response(response, get_properties)

    def _get_joint(self, request: Any, response: Any) -> Any:
        def get_properties() -> str:
            simulation = self.simulation
            scene_joint = simulation.scene.joints[self._entities.joint(request.joint_name)]
            response.type = _JOINT_TYPES.get(scene_joint.joint.type, 0)
            if len(scene_joint.axes) == 1:
                position, velocity = simulation.joint_state(scene_joint.name)
                response.position, response.rate = [position], [velocity]
                response.damping = [float(simulation.model.joint(scene_joint.name).damping[0])]
            return "GetJointProperties: got properties"

        return fill_response(response, get_properties)

    def _set_link(self, request: Any, response: Any) -> Any:
        def set_properties() -> str:
            link = self._entities.link(request.link_name)
            moments = (request.ixx, request.iyy, request.izz, request.ixy, request.ixz, request.iyz)
            if not (0.0 < request.mass < inf and _is_possible(*moments)):
                raise LinkwrightError(
                    Diagnostic(
                        "SIM111",
                        phrase(
                            "this mass or inertia is not physically possible; give a positive mass and moments that "
                            "satisfy the triangle inequality"
                        ),
                    )
                )
            center = vector_components(request.com.position)
            body = self.simulation.scene.spec.body(link)
            body.explicitinertial, body.mass, body.ipos = True, request.mass, list(center)
            body.fullinertia, body.gravcomp = list(moments), 0.0 if request.gravity_mode else 1.0
            self.simulation.mark_changed()
            return "SetLinkProperties: properties set"

        return fill_response(response, set_properties)

    def _set_joint(self, request: Any, response: Any) -> Any:
        """Set the damping and the limits of the first axis.

        Other properties are specific to ODE and have no effect.
        """

        def set_properties() -> str:
            self.simulation.refresh()
            scene_joint = self.simulation.scene.joints[self._entities.joint(request.joint_name)]
            config = request.ode_joint_config
            joint, compiled_joint = (
                self.simulation.scene.spec.joint(scene_joint.name),
                self.simulation.model.joint(scene_joint.name),
            )
            lower, upper = (
                compiled_joint.range.tolist()
                if self.simulation.model.jnt_limited[compiled_joint.id]
                else (-_UNREACHABLE_LIMIT, _UNREACHABLE_LIMIT)
            )
            if len(config.lo_stop) or len(config.hi_stop):
                set_joint_range(joint, next(iter(config.lo_stop), lower), next(iter(config.hi_stop), upper))
            if len(config.damping):
                set_coefficient(joint, "damping", config.damping[0])
            self.simulation.mark_changed()
            return "SetJointProperties: properties set"

        return fill_response(response, set_properties)

    def _get_physics(self, _: Any, response: Any) -> Any:
        self.simulation.refresh()
        response.time_step = self.simulation.step / NANOSECONDS_PER_SECOND
        response.max_update_rate = find_physics(self.context.world).real_time_update_rate
        response.gravity = from_values(Vector3, np.asarray(self.simulation.model.opt.gravity).tolist())
        response.success, response.status_message = True, "GetPhysicsProperties: got properties"
        return response

    def _set_physics(self, request: Any, response: Any) -> Any:
        self.simulation.set_gravity(vector_components(request.gravity))
        response.success, response.status_message = True, "gravity is set; other settings have no effect"
        return response


def _is_possible(ixx: float, iyy: float, izz: float, ixy: float, ixz: float, iyz: float) -> bool:
    """Return whether an inertia tensor is physically possible."""
    tensor = np.array([[ixx, ixy, ixz], [ixy, iyy, iyz], [ixz, iyz, izz]])
    return bool(np.isfinite(tensor).all()) and is_positive_definite(tensor) and triangle_excess(tensor) <= TOLERANCE
