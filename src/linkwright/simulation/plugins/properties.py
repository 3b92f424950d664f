"""What models, links and joints are made of, asked by services: ``libgazebo_ros_properties.so``.

Source: gazebo_ros_pkgs for ROS 2 (services and their answers). Of what it sets, gravity can be set here; of the
settings of the physics engine ODE, which is not here, nothing is told.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from linkwright.messages import Vector3
from linkwright.sdf.poses import SEPARATOR
from linkwright.sdf.worlds import physics_of
from linkwright.simulation.plugins.entities import Entities, answered, numbers, pose_message
from linkwright.simulation.plugins.parameters import NoParameters
from linkwright.simulation.plugins.plugin import SimulatedPlugin
from linkwright.simulation.simulation import NANOSECONDS

_TYPES = {"revolute": 0, "continuous": 1, "prismatic": 2, "fixed": 3, "ball": 4, "universal": 5}
"""Those of GetJointProperties."""


class ClassicProperties(SimulatedPlugin[NoParameters]):
    """``libgazebo_ros_properties.so``, of a world."""

    def start(self) -> None:
        """Make the services."""
        self._entities = Entities(self.simulation)
        for name, callback in (
            ("GetModelProperties", self._model),
            ("GetLinkProperties", self._link),
            ("GetJointProperties", self._joint),
            ("GetPhysicsProperties", self._physics),
            ("SetPhysicsProperties", self._set_physics),
        ):
            verb, kind = name[:3].lower(), name[3:].removesuffix("Properties").lower()
            self.node.service(f"gazebo_msgs/srv/{name}", f"{verb}_{kind}_properties", callback)

    def _model(self, request: Any, response: Any) -> Any:
        def tell() -> str:
            scene_model = self.simulation.scene.models[self._entities.model(request.model_name)]
            model, begin = scene_model.model, f"{scene_model.name}{SEPARATOR}"
            response.canonical_link_name = begin + (
                model.canonical_link or next((each.name for each in model.links), "")
            )
            response.link_names = [begin + each.name for each in model.links]
            response.collision_names = [each.name for link in model.links for each in link.collisions]
            response.joint_names = [each.name for each in model.joints]
            response.child_model_names = [each.name for each in model.models]
            response.is_static = model.static
            return "GetModelProperties: got properties"

        return answered(response, tell)

    def _link(self, request: Any, response: Any) -> Any:
        def tell() -> str:
            simulation = self.simulation
            number = simulation.body(self._entities.link(request.link_name))
            body = simulation.model.body(number)
            w, x, y, z = body.iquat.tolist()
            response.com = pose_message((*body.ipos.tolist(), x, y, z, w))
            response.gravity_mode = bool(simulation.model.body_gravcomp[number] == 0.0)
            response.mass = float(body.mass[0])
            response.ixx, response.iyy, response.izz = body.inertia.tolist()
            return "GetLinkProperties: got properties"

        return answered(response, tell)

    def _joint(self, request: Any, response: Any) -> Any:
        def tell() -> str:
            simulation = self.simulation
            placed = simulation.scene.joints[self._entities.joint(request.joint_name)]
            response.type = _TYPES.get(placed.joint.type, 0)
            if len(placed.axes) == 1:
                position, velocity = simulation.joint_state(placed.name)
                response.position, response.rate = [position], [velocity]
                response.damping = [float(simulation.model.joint(placed.name).damping[0])]
            return "GetJointProperties: got properties"

        return answered(response, tell)

    def _physics(self, _: Any, response: Any) -> Any:
        self.simulation.refresh()
        response.time_step = self.simulation.step / NANOSECONDS
        response.max_update_rate = physics_of(self.place.world).real_time_update_rate
        response.gravity = Vector3(*np.asarray(self.simulation.model.opt.gravity).tolist())
        response.success, response.status_message = True, "GetPhysicsProperties: got properties"
        return response

    def _set_physics(self, request: Any, response: Any) -> Any:
        self.simulation.set_gravity(numbers(request.gravity))
        response.success, response.status_message = True, "gravity is set, nothing else"
        return response
