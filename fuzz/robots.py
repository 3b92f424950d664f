"""URDF and .rviz texts, made from choices."""

from __future__ import annotations

from fuzz.choices import Choices

_NUMBERS = [
    "0",
    "1",
    "-1",
    "0.5",
    "1e3",
    "nan",
    "inf",
    "1e999",
    "",
    " ",
    "x",
    "1,5",
    "0x1",
    " 1 ",
    "1 2",
    "é",
    "-0",
    "${x}",
]
_NAMES = ["a", "b", "c", "base_link", "", " ", "a b", "é", "a/b", "日本"]
_JOINTS = ["fixed", "revolute", "continuous", "prismatic", "floating", "planar", "Fixed", "", "hinge"]
_TAGS = [
    "link",
    "joint",
    "robot",
    "visual",
    "origin",
    "gazebo",
    "transmission",
    "ros2_control",
    "sensor",
    "limits",
    "xacro:if",
]


def urdf(choices: Choices) -> str:
    """Return a robot, not always a valid one."""
    opening = choices.pick(
        ['<robot name="r">', "<robot>", '<robot name="r" version="1.2">', '<robot name="" version="x">']
    )
    body = "".join(choices.pick(_PARTS)(choices) for _ in range(2 + choices.number(8)))
    return f"{opening}{body}{choices.pick(['</robot>', '</robot><robot/>', '</robot> text', ''])}"


def _vector(choices: Choices) -> str:
    return " ".join(choices.pick(_NUMBERS) for _ in range(choices.pick([3, 3, 3, 4, 2, 0, 1])))


def _attribute(choices: Choices, name: str, value: str) -> str:
    return "" if choices.chance(9) else f' {name}="{value}"'


def _origin(choices: Choices) -> str:
    name = choices.pick(["rpy", "quat_xyzw", "rpi"])
    return f"<origin{_attribute(choices, 'xyz', _vector(choices))}{_attribute(choices, name, _vector(choices))}/>"


def _geometry(choices: Choices) -> str:
    shapes = {
        "box": ["size"],
        "sphere": ["radius"],
        "cylinder": ["radius", "length"],
        "capsule": ["radius", "length"],
        "mesh": ["filename", "scale"],
        "cone": [],
    }
    shape = choices.pick(list(shapes))
    values = "".join(
        _attribute(
            choices, name, choices.pick(["package://p/m.stl", "", "m.dae"]) if name == "filename" else _vector(choices)
        )
        if name in ("size", "scale", "filename")
        else _attribute(choices, name, choices.pick(_NUMBERS))
        for name in shapes[shape]
    )
    return choices.pick(
        [
            f"<geometry><{shape}{values}/></geometry>",
            f"<geometry><{shape}{values}/><box/></geometry>",
            "<geometry/>",
            "",
        ]
    )


def _material(choices: Choices) -> str:
    color = choices.pick(
        ['<color rgba="1 0 0 1"/>', f'<color rgba="{_vector(choices)}"/>', "<color/>", "", '<texture filename=""/>']
    )
    return f"<material{_attribute(choices, 'name', choices.pick(_NAMES))}>{color}</material>"


def _inertial(choices: Choices) -> str:
    values = "".join(
        _attribute(choices, name, choices.pick(_NUMBERS)) for name in ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")
    )
    mass = choices.pick([f'<mass value="{choices.pick(_NUMBERS)}"/>', "<mass/>", ""])
    return f"<inertial>{_origin(choices)}{mass}<inertia{values}/></inertial>"


def _link(choices: Choices) -> str:
    parts = []
    for _ in range(choices.number(4)):
        kind = choices.pick(["visual", "collision", "inertial", "odd"])
        if kind == "inertial":
            parts.append(_inertial(choices))
        elif kind == "odd":
            parts.append(f"<{choices.pick(_TAGS[:-1])}/>")
        else:
            parts.append(
                f"<{kind}>{_origin(choices)}{_geometry(choices)}"
                f"{_material(choices) if choices.chance(3) else ''}</{kind}>"
            )
    return f"<link{_attribute(choices, 'name', choices.pick(_NAMES))}>{''.join(parts)}</link>"


def _joint(choices: Choices) -> str:
    inside = [
        "" if choices.chance(12) else f"<{tag}{_attribute(choices, 'link', choices.pick(_NAMES))}/>"
        for tag in ("parent", "child")
    ]
    if choices.chance(2):
        inside.append(_origin(choices))
    if choices.chance(2):
        inside.append(f'<axis xyz="{_vector(choices)}"/>')
    for tag, names in (
        ("limit", ["lower", "upper", "effort", "velocity", "jerk"]),
        ("dynamics", ["damping", "friction"]),
        ("safety_controller", ["k_velocity", "k_position", "soft_lower_limit"]),
        ("calibration", ["rising", "falling"]),
        ("mimic", ["multiplier", "offset"]),
    ):
        if choices.chance(3):
            values = "".join(_attribute(choices, name, choices.pick(_NUMBERS)) for name in names)
            target = _attribute(choices, "joint", choices.pick(_NAMES)) if tag == "mimic" else ""
            inside.append(f"<{tag}{target}{values}/>")
    name = _attribute(choices, "name", choices.pick(_NAMES))
    return f"<joint{name}{_attribute(choices, 'type', choices.pick(_JOINTS))}>{''.join(inside)}</joint>"


def _odd(choices: Choices) -> str:
    return choices.pick(
        [
            "text",
            "<!-- c -->",
            "<gazebo reference='a'><x/></gazebo>",
            "<a><b/></a>",
            "&amp;",
            "<![CDATA[x]]>",
            "<link/>",
        ]
    )


_PARTS = [_link, _link, _joint, _joint, _material, _odd]

_KEYS = [
    *(
        "Visualization Manager",
        "Displays",
        "Class",
        "Name",
        "Enabled",
        "Value",
        "Global Options",
        "Fixed Frame",
        "Views",
    ),
    *(
        "Current",
        "Distance",
        "Yaw",
        "Pitch",
        "Focal Point",
        "X",
        "Background Color",
        "Frame Rate",
        "Topic",
        "Links",
        "Alpha",
    ),
    *("Frames", "Marker Scale", "Description Topic", "Cell Size", "Plane Cell Count", "Color", "Offset", "Tree", "x"),
]
_VALUES = [
    *(
        "1",
        "true",
        "rviz_default_plugins/Grid",
        "rviz_default_plugins/TF",
        "rviz_default_plugins/RobotModel",
        "rviz/Grid",
    ),
    *(
        "rviz_common/Group",
        "255; 0; 0",
        "map",
        ".inf",
        "1e999",
        "~",
        "''",
        "é",
        "[1, 2]",
        "{}",
        "[]",
        "-1",
        "*x",
        "&x 1",
    ),
    *("rviz_default_plugins/Orbit", "rviz_default_plugins/TopDownOrtho", "<Fixed Frame>", "!!python/x 1", "2001-01-01"),
]


def rviz(choices: Choices) -> str:
    """Return a configuration of RViz, not always a valid one."""
    return "Visualization Manager:\n" + _mapping(choices, 1) if not choices.chance(12) else _mapping(choices, 0)


def _mapping(choices: Choices, depth: int) -> str:
    indent = "  " * depth
    lines = []
    for _ in range(1 + choices.number(8)):
        key = choices.pick(_KEYS)
        kind = choices.number(5) if depth < 5 else 0
        if key == "Displays" or kind == 1:
            items = (f"{indent}  -\n{_mapping(choices, depth + 2)}" for _ in range(choices.number(4)) if depth < 6)
            lines.append(f"{indent}{key}:\n" + "".join(items))
        elif kind in (2, 3):
            lines.append(f"{indent}{key}:\n{_mapping(choices, depth + 1)}")
        else:
            lines.append(f"{indent}{key}: {choices.pick(_VALUES)}\n")
    return "".join(lines)
