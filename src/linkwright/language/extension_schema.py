"""The extension elements of a description: ros2_control, Gazebo and transmissions.

Sources: hardware_interface's parser and schema (ros2_control), libsdformat's parser of URDF (Gazebo).
"""

from __future__ import annotations

from dataclasses import replace

from linkwright.schema import AttributeRule, ElementRule, ValueType
from linkwright.sdf.links import LINK
from linkwright.sdf.models import MODEL
from linkwright.sdf.values import INTEGER, NUMBER, TEXT, TRUTH, VECTOR3, choice, value
from linkwright.urdf.schema import ROBOT

HARDWARE_PLUGIN = ValueType("name of a hardware plugin")
JOINT_NAME = ValueType("name of a joint")
PART_NAME = ValueType("name of a link or joint")
INTERFACE_NAME = ValueType("name of an interface")
PARAMETER_NAME = ValueType("name of a parameter")

_NAME = AttributeRule("name", TEXT, "its name", required=True)
_JOINT = AttributeRule("name", JOINT_NAME, "the name of the joint in the description", required=True)


def _with_text(rule: ElementRule, meaning: str) -> ElementRule:
    return replace(rule, text=AttributeRule("text", TEXT, meaning))


def _parameter(meaning: str) -> ElementRule:
    name = AttributeRule("name", PARAMETER_NAME, "the name of the parameter", required=True)
    return _with_text(ElementRule("param", meaning, (name,), is_repeated=True), "the value of the parameter")


_LIMITS = ElementRule(
    "limits",
    "whether commands are limited",
    (AttributeRule("enable", TRUTH, "whether commands are limited", default="true", usually_written=True),),
)


def _interface(tag: str, meaning: str) -> ElementRule:
    return ElementRule(
        tag,
        meaning,
        (
            AttributeRule(
                "name",
                INTERFACE_NAME,
                "the kind of interface, such as position (rad or m), velocity (rad/s or m/s) or effort (N m or N)",
                required=True,
            ),
            AttributeRule("data_type", TEXT, "the type of the value", default="double"),
            AttributeRule("size", INTEGER, "the number of values", default="1"),
        ),
        (_parameter("a property of the interface, such as min, max or initial_value"), _LIMITS),
        is_repeated=True,
    )


_COMMAND = _interface("command_interface", "a command that controllers write and the hardware follows")
_STATE = _interface("state_interface", "a state that the hardware measures and controllers read")
_SENSOR_STATE = replace(_STATE, children=_STATE.children[:1])
_COMPONENT_PARAMETER = _parameter("a parameter of the component for the hardware plugin")


def _transmission_part(tag: str, name: AttributeRule, meaning: str) -> ElementRule:
    return ElementRule(
        tag,
        meaning,
        (
            name,
            AttributeRule(
                "role", TEXT, "its role in the transmission, such as joint1 or actuator1", usually_written=True
            ),
        ),
        (
            value("mechanical_reduction", NUMBER, "the ratio of the speeds of actuator and joint", default="1"),
            value("offset", NUMBER, "the position of the joint where the actuator is at zero", "rad or m", default="0"),
        ),
        is_repeated=True,
    )


_TRANSMISSION_PLUGIN = value("plugin", TEXT, "the class, such as transmission_interface/SimpleTransmission")

_PLUGIN = value("plugin", HARDWARE_PLUGIN, "the class of the hardware plugin, as package/Class")

ROS2_CONTROL = ElementRule(
    "ros2_control",
    "hardware for controllers: its plugin, and the commands and states of joints and sensors",
    (
        _NAME,
        AttributeRule(
            "type",
            choice("system", "actuator", "sensor"),
            "system for hardware with several joints, actuator for one joint, sensor for states alone",
            required=True,
        ),
        AttributeRule("rw_rate", INTEGER, "how often the hardware is read and written", "Hz"),
        AttributeRule("is_async", TRUTH, "whether the hardware is read and written in a thread of its own"),
        AttributeRule("thread_priority", INTEGER, "the priority of that thread"),
    ),
    (
        ElementRule(
            "hardware",
            "the plugin that talks to the hardware, and its parameters",
            (),
            (
                replace(
                    value("plugin", HARDWARE_PLUGIN, "the class of the hardware plugin, as package/Class"),
                    required=True,
                ),
                _parameter("a parameter of the hardware plugin"),
                value("group", TEXT, "the group of hardware that fails together"),
            ),
            required=True,
        ),
        ElementRule(
            "joint",
            "a joint of the description, with its command and state interfaces",
            (_JOINT, AttributeRule("mimic", TRUTH, "whether it follows the joint that its <mimic> names")),
            (_COMMAND, _STATE, _COMPONENT_PARAMETER, _LIMITS),
            is_repeated=True,
        ),
        ElementRule(
            "sensor", "a sensor with its states", (_NAME,), (_SENSOR_STATE, _COMPONENT_PARAMETER), is_repeated=True
        ),
        ElementRule(
            "gpio",
            "inputs and outputs that belong to no joint",
            (_NAME,),
            (_COMMAND, _STATE, _COMPONENT_PARAMETER),
            is_repeated=True,
        ),
        ElementRule(
            "transmission",
            "the gears between actuators and joints",
            (_NAME,),
            (
                _TRANSMISSION_PLUGIN,
                _transmission_part("actuator", _NAME, "an actuator of the transmission"),
                _transmission_part("joint", _JOINT, "a joint of the transmission"),
                _parameter("a parameter of the transmission"),
            ),
            is_repeated=True,
        ),
    ),
    is_repeated=True,
)

_ROS1_INTERFACE = value("hardwareInterface", TEXT, "the interface, such as hardware_interface/PositionJointInterface")
TRANSMISSION = ElementRule(
    "transmission",
    "the gears between an actuator and a joint, for ROS 1",
    (_NAME,),
    (
        value("type", TEXT, "the class, such as transmission_interface/SimpleTransmission"),
        ElementRule("joint", "the joint", (_JOINT,), (_ROS1_INTERFACE,), is_repeated=True),
        ElementRule(
            "actuator",
            "the actuator",
            (_NAME,),
            (value("mechanicalReduction", NUMBER, "the ratio of the speeds of actuator and joint"), _ROS1_INTERFACE),
            is_repeated=True,
        ),
    ),
    is_repeated=True,
)

_LINK_SETTINGS = (
    value("material", TEXT, "a material of Gazebo classic, such as Gazebo/Orange"),
    value("mu1", NUMBER, "the coefficient of friction in the first direction"),
    value("mu2", NUMBER, "the coefficient of friction across the first direction"),
    value("fdir1", VECTOR3, "the first direction of friction, in the frame of the link"),
    value("kp", NUMBER, "the stiffness of contacts", "N/m"),
    value("kd", NUMBER, "the damping of contacts", "N s/m"),
    value("minDepth", NUMBER, "the depth from which contacts push back", "m"),
    value("maxVel", NUMBER, "the greatest speed with which contacts push apart", "m/s"),
    value("maxContacts", INTEGER, "the greatest number of contacts with another shape"),
    value("selfCollide", TRUTH, "whether the link collides with other links of the robot"),
    value("gravity", TRUTH, "whether gravity acts on the link"),
    value("turnGravityOff", TRUTH, "whether gravity does not act on the link"),
    value("dampingFactor", NUMBER, "the share of the velocity that is lost in each step"),
    value("laserRetro", NUMBER, "the intensity with which the link reflects lasers"),
)
_JOINT_SETTINGS = (
    value("preserveFixedJoint", TRUTH, "whether the fixed joint stays a joint instead of joining both links"),
    value("disableFixedJointLumping", TRUTH, "whether both links stay apart, with a revolute joint that cannot move"),
    value("implicitSpringDamper", TRUTH, "whether the damping of the joint is computed implicitly"),
    value("springStiffness", NUMBER, "the stiffness of a spring in the joint", "N m/rad or N/m"),
    value("springReference", NUMBER, "the position at which the spring is relaxed", "rad or m"),
    value("provideFeedback", TRUTH, "whether the force and torque in the joint are measured"),
    value("stopCfm", NUMBER, "the softness of the joint's limits"),
    value("stopErp", NUMBER, "the share of an error at the limits that a step corrects"),
    value("fudgeFactor", NUMBER, "scales the force that moves the joint away from its limits"),
)
_MODEL_TAGS = ("static", "self_collide", "allow_auto_disable", "pose", "enable_wind")

GAZEBO = ElementRule(
    "gazebo",
    "settings for the simulator, for the link or joint that it names or else for the whole robot",
    (AttributeRule("reference", PART_NAME, "the link or joint; without it, the whole robot", usually_written=True),),
    (
        *(LINK.child_rules[tag] for tag in ("sensor", "visual", "collision", "light", "velocity_decay")),
        MODEL.child_rules["plugin"],
        *_LINK_SETTINGS,
        *_JOINT_SETTINGS,
        *(MODEL.child_rules[tag] for tag in _MODEL_TAGS if tag in MODEL.child_rules),
    ),
    is_repeated=True,
)

DESCRIPTION = replace(ROBOT, children=(*ROBOT.children, GAZEBO, ROS2_CONTROL, TRANSMISSION))
"""The root element of a description, with the extensions."""
