"""Changes of interfaces that do not follow the layout of ROS packages."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE, PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

STATE = """module robot {
struct State {
  long mode;
};
const long LIMIT = 3;
struct Pose {
  State state;
  double x;
};
};
"""


@pytest.mark.parametrize(
    ("old", "new", "expected", "is_breaking"),
    [
        ("long mode;", "long mode;\n  long level;", "field 'robot::State.level' of type int32 added", True),
        ("  double x;\n", "", "field 'robot::Pose.x' removed", True),
        ("struct Pose", "struct Place", "structure 'robot::Pose' renamed to 'robot::Place'", True),
        (STATE[STATE.index("struct Pose") :], "};\n", "structure 'robot::Pose' removed", True),
        ("LIMIT = 3", "LIMIT = 4", "constant 'robot.LIMIT': 3 -> 4", True),
        ("struct Pose", "struct Speed { float x; };\nstruct Pose", "structure 'robot::Speed' added", False),
    ],
)
def test_idl_files_outside_of_folders_of_ros_are_compared(repository, compare, old, new, expected, is_breaking):
    repository.commit({"dds/State_t.idl": STATE})
    repository.write({"dds/State_t.idl": STATE.replace(old, new)})
    result = compare(repository)
    assert sentences(subject(result, "dds/State_t.idl")) == [expected]
    assert breaking(result) == ([expected] if is_breaking else [])


ENUM = """module robot {
enum Mode { OFF, @value(4) DRIVE, BRAKE };
union Value switch (Mode) {
  case OFF: long code;
  case DRIVE: case BRAKE: double speed;
  default: octet other;
};
};
"""


@pytest.mark.parametrize(
    ("old", "new", "expected", "is_breaking"),
    [
        ("BRAKE };", "BRAKE, TURN };", "constant 'robot::Mode.TURN' = 6 added", False),
        ("OFF, @value", "@value", "constant 'robot::Mode.OFF' removed", True),
        ("@value(4)", "@value(3)", "constant 'robot::Mode.DRIVE': 4 -> 3", True),
        ("enum Mode", "enum Modes", "enumeration 'robot::Mode' renamed to 'robot::Modes'", True),
        ("enum Mode { OFF, @value(4) DRIVE, BRAKE };\n", "", "enumeration 'robot::Mode' removed", True),
        ("union", "enum Side { LEFT, RIGHT };\nunion", "enumeration 'robot::Side' added: LEFT, RIGHT", False),
        ("double speed", "float speed", "field 'robot::Value.speed': float64 -> float32", True),
        ("  default: octet other;\n", "", "field 'robot::Value.other' removed", True),
    ],
)
def test_enumerations_and_unions_in_idl_are_compared(repository, compare, old, new, expected, is_breaking):
    repository.commit({"dds/Mode.idl": ENUM})
    repository.write({"dds/Mode.idl": ENUM.replace(old, new)})
    result = compare(repository)
    assert expected in sentences(subject(result, "dds/Mode.idl"))
    assert (expected in breaking(result)) == is_breaking


def test_other_idl_files_that_cannot_be_parsed_are_not_compared(repository, compare):
    repository.commit({"dds/Mode.idl": "bitmask Mode { A, B };\n"})
    repository.write({"dds/Mode.idl": "bitmask Mode { A, B, C };\n"})
    (problem,) = subject(compare(repository), "dds/Mode.idl").problems
    assert str(problem.text).startswith("neither version can be read")


def test_a_message_that_becomes_a_service_is_a_renamed_file(repository, compare):
    fields = "".join(f"int32 value_{number}\n" for number in range(20))
    repository.commit({"p/msg/Count.msg": fields})
    repository.commit({"p/msg/Count.msg": None, "p/srv/Count.srv": f"{fields}---\n"})
    assert breaking(compare(repository, "HEAD~1..HEAD")) == ["renamed from p/msg/Count.msg"]


FIELDS = "string ns\nfloat64 x\nfloat64 y\nuint8 OFF=0\nuint8 ON=1\n"


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("string ns", "string namespace_name", ["field 'ns' renamed to 'namespace_name'"]),
        ("64 x\nfloat64 y", "64 a\nfloat64 b", ["field 'x' renamed to 'a'", "field 'y' renamed to 'b'"]),
        ("string ns", "int32 id", ["field 'id' of type int32 added", "field 'ns' removed"]),
        (
            "string ns\nfloat64 x\nfloat64 y",
            "float64 x\nfloat64 y\nstring id",
            ["field 'id' of type string added", "field 'ns' removed"],
        ),
        ("float64 x\nfloat64 y", "float64 y\nfloat64 x", ["order of the fields changed"]),
        ("OFF", "STOPPED", ["constant 'OFF' renamed to 'STOPPED'"]),
        ("uint8 OFF=0", "uint8 STOPPED=2", ["constant 'STOPPED' = 2 added", "constant 'OFF' removed"]),
    ],
)
def test_renamed_fields_and_constants_have_one_line(repository, compare, old, new, expected):
    repository.commit({"p/msg/State.msg": FIELDS})
    repository.write({"p/msg/State.msg": FIELDS.replace(old, new)})
    result = compare(repository)
    assert sentences(subject(result, "p/msg/State.msg")) == expected
    assert set(breaking(result)) == {text for text in expected if "= 2 added" not in text}


def test_fields_of_types_that_only_ros1_has_are_compared(repository, compare):
    path = "arm_description/msg/State.msg"
    repository.commit({**PACKAGE, path: "time stamp\nduration[] waits\nint32 x\n"})
    fields = "builtin_interfaces/Time stamp\nbuiltin_interfaces/Duration[] waits\nint32 y\n"
    repository.write({path: fields})
    result = compare(repository)
    assert sentences(subject(result, path)) == [
        "can be read now; in the old version: the type 'time' is a ROS 1 type",
        "field 'x' renamed to 'y'",
        "field 'stamp': time -> builtin_interfaces/Time",
        "field 'waits': duration[] -> builtin_interfaces/Duration[]",
    ]
    assert not breaking(result)


ROS1_MANIFEST = """<package format="2">
  <name>arm_msgs</name><version>1.0.0</version><description>Messages.</description>
  <maintainer email="a@b.org">A</maintainer><license>MIT</license>
  <buildtool_depend>catkin</buildtool_depend>
</package>
"""


@pytest.mark.parametrize("typed", ["joint_state[] joints", "arm_msgs/joint_state state", "other_msgs/plain_type other"])
def test_ros1_types_may_begin_with_a_lower_case_letter(repository, compare, typed):
    files = {"package.xml": ROS1_MANIFEST, "msg/joint_state.msg": "float64 angle\n"}
    repository.commit({**files, "msg/arm_state.msg": f"int32 id\n{typed}\n"})
    repository.write({"msg/arm_state.msg": f"uint64 id\n{typed}\n"})
    result = compare(repository)
    assert breaking(result) == ["field 'id': int32 -> uint64"]


def test_misspelled_primitive_type_in_ros1_is_still_a_mistake(repository, compare):
    repository.commit({"package.xml": ROS1_MANIFEST, "msg/arm_state.msg": "int32 id\n"})
    repository.write({"msg/arm_state.msg": "itn32 id\n"})
    assert breaking(compare(repository)) == ["can no longer be read: there is no type 'itn32'"]


@pytest.mark.parametrize(("other_tool", "start"), [("", "nodes "), ("ament_cmake", "in ROS 1, nodes ")])
def test_reason_of_an_added_constant_names_ros1_if_the_package_is_for_both_versions(
    repository, compare, other_tool, start
):
    other = f"<buildtool_depend>{other_tool}</buildtool_depend></package>" if other_tool else "</package>"
    repository.commit({"package.xml": ROS1_MANIFEST.replace("</package>", other), "msg/State.msg": "int32 id\n"})
    repository.write({"msg/State.msg": "int32 id\nint32 SLOW = 1\n"})
    (change,) = subject(compare(repository), "msg/State.msg").changes
    assert str(change.reason).startswith(start)


def test_many_added_and_removed_fields_share_a_line(repository, compare):
    repository.commit({"p/msg/State.msg": "float32 a\nfloat32 b\nfloat32 c\nint32 id\n"})
    repository.write({"p/msg/State.msg": "int32 id\nstring[] one_name\nbool is_two\nuint8 three_count\n"})
    assert breaking(compare(repository)) == [
        "fields removed: float32 a, float32 b, float32 c; added: string[] one_name, bool is_two, uint8 three_count",
    ]


BUILD = "project({})\nfind_package(rosidl_default_generators REQUIRED)\nrosidl_generate_interfaces({} {})\n"
MSGS = PACKAGE_XML.replace("arm_description", "{}")
SERVICE = "{}/Pose[] poses\nstring name\nint32 first\nint32 second\nint32 third\n---\nbool success\nstring message\n"


@pytest.mark.parametrize("is_built", [True, False])
def test_an_interface_that_moves_to_another_package_keeps_the_types_of_its_package(repository, compare, is_built):
    pose = "float64 x\n"
    old = {"old_msgs/srv/Find.srv": SERVICE.format("old_msgs"), "old_msgs/msg/Pose.msg": pose}
    new = {"new_msgs/srv/Find.srv": SERVICE.format("new_msgs"), "new_msgs/msg/Pose.msg": pose}
    manifests = {f"{name}_msgs/package.xml": MSGS.format(f"{name}_msgs") for name in ("old", "new")}
    built = "msg/Pose.msg srv/Find.srv"
    repository.commit(
        {
            **manifests,
            "old_msgs/CMakeLists.txt": BUILD.format("old_msgs", "old_msgs", built),
            "new_msgs/CMakeLists.txt": BUILD.format("new_msgs", "new_msgs", built if is_built else "msg/Pose.msg"),
            **old,
        }
    )
    repository.commit({**dict.fromkeys(old), **new})
    lines = [line for found in compare(repository, "HEAD~..HEAD").subjects for line in sentences(found)]
    assert not [line for line in lines if line.startswith("field")]
    assert ("CMakeLists.txt does not build it" in lines) is not is_built


@pytest.mark.parametrize(
    ("old", "new", "is_told"),
    [
        ("int32 id\nint32 sum\n", "int32 key\nint32 id\n", True),
        ("int32 id\nint32 sum\n", "int32 id\nint32 key\n", False),
        ("int32 id\nint32 sum\n", "int32 sum\nint32 id\n", False),
        ("int32 id\nfloat32 sum\n", "int32 key\nint32 id\n", False),
        ("int32 id\nint32 sum\n", "int32 key\nint32 id\nint32 sum\n", False),
    ],
)
def test_field_that_takes_the_place_of_another_one(repository, compare, old, new, is_told):
    repository.commit({"arm/package.xml": PACKAGE_XML, "arm/msg/Goal.msg": old})
    repository.write({"arm/msg/Goal.msg": new})
    lines = sentences(subject(compare(repository), "arm/msg/Goal.msg"))
    told = "field 'id' is in the place of 'sum' now, and 'key' in its old place: it may have another meaning"
    assert (told in lines) == is_told


def test_two_fields_or_constants_of_a_message_share_a_line(repository, compare):
    path = "arm_description/msg/State.msg"
    old = "int32 SLOW = 1\nint32 FAST = 2\nint32 count\nstring frame\nfloat64 rate\n"
    new = "string LEFT = a\nstring RIGHT = b\nfloat64 rate\nbool is_on\nuint8[] data\n"
    repository.commit({**PACKAGE, path: old})
    repository.write({path: new})
    found = subject(compare(repository), path)
    assert sentences(found) == [
        "fields removed: int32 count, string frame; added: bool is_on, uint8[] data",
        "constants added: LEFT = a, RIGHT = b",
        "constants removed: SLOW, FAST",
    ]
    assert [(change.location.line, change.location.is_old) for change in found.changes] == [
        (4, False),
        (1, False),
        (1, True),
    ]


@pytest.mark.parametrize(
    ("path", "text", "is_named"),
    [
        ("arm/srv/Show.srv", "---\nSpec spec\n", True),
        ("arm/msg/Specs.msg", "Spec[] specs\n", True),
        ("arm/action/Show.action", "---\narm/Spec[<=3] spec\n---\n", True),
        ("arm/msg/Specs.msg", "arm/msg/Spec spec  # ROS 2 accepts the longer form\n", True),
        ("hand/msg/Specs.msg", "arm/Spec spec\n", True),
        ("hand/msg/Specs.msg", "Spec spec\n", False),  # a type of the package hand
        ("arm/msg/Specs.msg", "# Spec spec\nint32 a\nSpecial b\n", False),
    ],
)
def test_types_that_contain_a_changed_message_are_named(repository, compare, path, text, is_named):
    manifests = {f"{name}/package.xml": PACKAGE_XML.replace("arm_description", name) for name in ("arm", "hand")}
    repository.commit({**manifests, "arm/msg/Spec.msg": "int32 a\n", path: text})
    repository.write({"arm/msg/Spec.msg": "int32 a\nstring b\n"})
    (change,) = subject(compare(repository), "arm/msg/Spec.msg").changes
    name = path.rpartition("/")[2]
    assert str(change.reason).endswith(f"; the same holds for the types that contain it: '{name}'") is is_named


def test_types_that_contain_a_changed_message_in_another_one_are_named(repository, compare):
    files = {"arm/msg/B.msg": "A a\n", "arm/msg/C.msg": "B b\nint32 c\n", "arm/srv/D.srv": "C c\n---\n"}
    manifest = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")}
    repository.commit({**manifest, **files, "arm/msg/A.msg": "int32 a\n"})
    repository.write({"arm/msg/A.msg": "int64 a\n", "arm/msg/C.msg": "B b\nint64 c\n"})
    (change,) = subject(compare(repository), "arm/msg/A.msg").changes
    assert str(change.reason).endswith("; the same holds for the types that contain it: 'B.msg', 'D.srv'")


def test_removed_interface_is_shown_with_its_fields(repository, compare):
    repository.commit({"a/srv/SetLoad.srv": "float64 load\n---\nbool success\n"})
    repository.write({"a/srv/SetLoad.srv": None})
    (change,) = subject(compare(repository), "a/srv/SetLoad.srv").changes
    assert str(change.sentence) == "interface removed: request: float64 load; response: bool success"
