"""Names inside the URDF extensions ``<gazebo>``, ``<transmission>`` and ``<ros2_control>``.

Sources: the schemas of ros2_control, the ROS 1 transmission format, and the elements of ``<gazebo>`` that sdformat
and Gazebo Classic read.
"""

from __future__ import annotations

from collections.abc import Mapping

CHILD_TAGS: Mapping[str, tuple[str, ...]] = {
    "ros2_control": ("hardware", "joint", "sensor", "gpio", "transmission"),
    "ros2_control/hardware": ("plugin", "param", "group", "properties"),
    "ros2_control/hardware/properties": ("async",),
    "ros2_control/joint": ("command_interface", "state_interface", "param", "properties", "limits"),
    "ros2_control/joint/command_interface": ("param", "limits"),
    "ros2_control/joint/state_interface": ("param", "limits"),
    "ros2_control/sensor": ("state_interface", "command_interface", "param", "properties"),
    "ros2_control/sensor/state_interface": ("param",),
    "ros2_control/gpio": ("command_interface", "state_interface", "param", "properties", "limits"),
    "ros2_control/gpio/command_interface": ("param", "limits"),
    "ros2_control/gpio/state_interface": ("param", "limits"),
    "ros2_control/transmission": ("plugin", "joint", "actuator", "param", "mechanical_reduction"),
    "ros2_control/transmission/joint": ("mechanical_reduction", "offset", "role"),
    "ros2_control/transmission/actuator": ("mechanical_reduction", "offset", "role"),
    "transmission": ("type", "joint", "actuator", "leftActuator", "rightActuator", "gap_joint", "simulated_reduction"),
    "transmission/joint": (
        "hardwareInterface",
        "mechanicalReduction",
        "offset",
        "role",
        "jointOffset",
        "mechanical_reduction",
    ),
    "transmission/actuator": ("hardwareInterface", "mechanicalReduction", "role", "offset", "mechanical_reduction"),
    "gazebo": (
        "material", "mu1", "mu2", "mu", "kp", "kd", "maxVel", "minDepth", "maxContacts", "fdir1", "selfCollide",
        "gravity", "turnGravityOff", "dampingFactor", "laserRetro", "implicitSpringDamper", "stopCfm", "stopErp",
        "cfmDamping", "provideFeedback", "fudgeFactor", "springReference", "springStiffness", "preserveFixedJoint",
        "disableFixedJointLumping", "sensor", "plugin", "visual", "collision", "static", "pose", "self_collide",
        "enable_wind", "light", "inertial", "ambient", "diffuse", "specular", "emissive", "lighting", "joint", "link",
        "physics", "surface", "gripper", "velocity_decay", "bounce", "max_contacts", "friction", "must_be_base_link",
        "frame", "model", "audio_sink", "audio_source", "kinematic", "battery", "projector", "axis", "dynamics",
        "sensor_reference", "canonicalBody", "param", "soft_cfm", "soft_erp", "slip", "rolling_friction", "min_depth",
        "max_vel", "dontCollapse", "include", "maxStepSize", "stopKp", "stopKd", "initialJointPosition", "parent",
        "child", "allow_auto_disable", "particle_emitter", "gearbox_ratio", "gearbox_reference_body", "thread_pitch",
        "axis2",
    ),
}  # fmt: skip
"""The elements that some program reads in an element, by the element's path from ``<robot>``."""

ATTRIBUTE_NAMES: Mapping[str, tuple[str, ...]] = {
    "gazebo": ("reference", "name", "version"),
    "ros2_control": ("name", "type", "rw_rate", "is_async", "thread_priority"),
    "ros2_control/joint": ("name", "mimic", "role"),
    "ros2_control/joint/command_interface": ("name", "data_type", "size"),
    "ros2_control/joint/state_interface": ("name", "data_type", "size"),
    "ros2_control/sensor": ("name",),
    "ros2_control/gpio": ("name",),
    "ros2_control/hardware/param": ("name",),
    "ros2_control/joint/param": ("name",),
    "transmission": ("name",),
    "transmission/joint": ("name",),
    "transmission/actuator": ("name",),
}
"""The attributes that some program reads in an element, by the element's path from ``<robot>``."""

JOINT_ELEMENTS = frozenset(
    {
        *("stopCfm", "stopErp", "stopKp", "stopKd", "fudgeFactor", "cfmDamping", "implicitSpringDamper"),
        *("springReference", "springStiffness", "provideFeedback", "preserveFixedJoint", "disableFixedJointLumping"),
        "initialJointPosition",
    }
)
"""Elements of a ``<gazebo reference="...">`` for a joint."""

LINK_ELEMENTS = frozenset(
    {
        *("material", "mu1", "mu2", "kp", "kd", "maxVel", "minDepth", "maxContacts", "fdir1", "selfCollide", "gravity"),
        *("turnGravityOff", "dampingFactor", "laserRetro", "visual", "collision", "inertial", "velocity_decay"),
    }
)
"""Elements of a ``<gazebo reference="...">`` for a link."""

INTERFACE_NAMES = (
    "position", "velocity", "effort", "acceleration", "torque", "force", "current", "temperature", "voltage",
    "stiffness", "damping", "mechanical_gain", "position.x", "position.y", "position.z", "orientation.x",
    "orientation.y", "orientation.z", "orientation.w",
)  # fmt: skip
"""The names of interfaces that controllers request. Hardware may have others."""
