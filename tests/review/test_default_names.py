"""Topics and frames that nodes have by default, because a parameter gives them."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import sentences

MANIFEST = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")}
CPP = """#include <rclcpp/rclcpp.hpp>
Arm::Arm() : Node("arm") {{
  {}
  out_ = create_publisher<Bool>("done", 1);
}}
"""
PYTHON = """import rclpy
from rclpy.node import Node


class Arm(Node):
    def __init__(self):
        super().__init__("arm")
        {}
        self.out = self.create_publisher(Bool, "done", 1)
"""
SUBSCRIPTION = 'auto t = declare_parameter<std::string>("input", "scan"); s_ = create_subscription<Bool>(t, 1, f);'
LAUNCH = '<launch><node pkg="arm" exec="arm"><param name="input" value="scan"/></node></launch>'
NOT_FOUND = "by default, programs that use the name 'scan' do not find it"
NO_FRAME = "by default, programs that look for the frame 'scan' in the messages do not find it"


def find_changes(repository, compare, text: str, files: dict[str, str] | None = None):
    path = "arm/arm/arm.py" if text.startswith("import") else "arm/src/arm.cpp"
    repository.commit({**MANIFEST, path: text, **(files or {})})
    repository.write({path: text.replace('"scan"', '"points"')})
    (found,) = compare(repository).subjects
    return sentences(found), [str(change.reason) for change in found.changes if change.reason]


@pytest.mark.parametrize(
    ("code", "reason"),
    [
        (SUBSCRIPTION, NOT_FOUND),
        ('declare_parameter("input", "scan"); get_parameter("input", t_); s_ = create_subscription<Bool>(t_, 1, f);',
         NOT_FOUND),
        (('declare_parameter("input", rclcpp::ParameterValue("scan"));'
         ' s_ = create_publisher<Bool>(get_parameter("input").as_string(), 1);'), NOT_FOUND),
        ('nh.param<std::string>("input", t_, "scan"); s_ = nh.subscribe(t_, 1, f);', NOT_FOUND),
        ('nh.param("input", t_, std::string("scan")); s_ = nh.advertise<Bool>(t_, 1);', NOT_FOUND),
        ('frame_ = declare_parameter<std::string>("input", "scan"); m.header.frame_id = frame_;', NO_FRAME),
    ],
)  # fmt: skip
def test_other_default_topic_or_frame_in_cpp_is_breaking(repository, compare, code, reason):
    (sentence,), reasons = find_changes(repository, compare, CPP.format(code))
    assert sentence.endswith('parameter \'input\': default "scan" -> "points"')
    assert reasons == [reason]


@pytest.mark.parametrize(
    ("code", "reason"),
    [
        (("self.declare_parameter('input', \"scan\")\n"
         "        self.pub = self.create_publisher(Bool, self.get_parameter('input').value, 1)"), NOT_FOUND),
        (("self.declare_parameters('', [('input', \"scan\")])\n"
         "        self.pub = self.create_publisher(Bool, self.get_parameter('input').value, 1)"), NOT_FOUND),
        (("self.frame = self.declare_parameter('input', \"scan\").value\n"
         "        self.message.header.frame_id = self.frame"), NO_FRAME),
        (("self.declare_parameter('input', \"scan\")\n"
         "        self.topic: str = str(self.get_parameter('input').value).strip()\n"
         "        self.pub = self.create_publisher(Bool, self.topic, 1)"), NOT_FOUND),
    ],
)  # fmt: skip
def test_other_default_topic_or_frame_in_python_is_breaking(repository, compare, code, reason):
    (sentence,), reasons = find_changes(repository, compare, PYTHON.format(code))
    assert sentence == "parameter 'input': default 'scan' -> 'points'"
    assert reasons == [reason]


@pytest.mark.parametrize(
    ("code", "files"),
    [
        ('declare_parameter("input", "scan");', {}),
        ('auto t = declare_parameter<std::string>("input", "scan"); c_ = create_client<Bool>(t);', {}),
        ('auto t = declare_parameter<std::string>("input", "scan"); t += "/raw"; f(t);', {}),
        (SUBSCRIPTION,
         {"arm/config/arm.yaml": "arm:\n  ros__parameters:\n    input: scan\n"}),
        (SUBSCRIPTION,
         {"arm/launch/arm.launch.xml": LAUNCH}),
    ],
)  # fmt: skip
def test_other_default_is_not_breaking(repository, compare, code, files):
    (sentence,), reasons = find_changes(repository, compare, CPP.format(code), files)
    assert sentence == 'parameter \'input\': default "scan" -> "points"'
    assert reasons == []


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('t.child_frame_id = "tool";', 't.child_frame_id = declare_parameter<std::string>("child", "tool");'),
        ('m.header.frame_id = "tool";',
         'f_ = declare_parameter<std::string>("child", "tool"); m.header.frame_id = f_;'),
        ('buffer.lookupTransform("tool", "tip", now);',
         'f_ = declare_parameter<std::string>("child", "tool"); buffer.lookupTransform(f_, "tip", now);'),
    ],
)  # fmt: skip
def test_frame_that_becomes_the_default_of_a_parameter_is_not_removed(repository, compare, old, new):
    for first, second, change in ((old, new, "added"), (new, old, "removed")):
        repository.commit({**MANIFEST, "arm/src/arm.cpp": CPP.format(first)})
        repository.write({"arm/src/arm.cpp": CPP.format(second)})
        (found,) = compare(repository).subjects
        assert sentences(found)[0] == f"parameters {change}: 'child' (\"tool\")"
        assert not any("frame" in sentence for sentence in sentences(found))


def test_names_of_parameters_of_a_plugin_are_known(repository, compare):
    declared = (
        'nav2_util::declare_parameter_if_not_declared(node, name_ + ".{0}", rclcpp::ParameterValue("odom"));'
        ' node->get_parameter(name_ + ".{0}", {0}_);'
    )
    new = " ".join(
        [
            *(declared.format(item) for item in ("frame", "topic")),
            "m.header.frame_id = frame_; p_ = node->create_publisher<Odometry>(topic_, 1);",
        ]
    )
    repository.commit(
        {
            **MANIFEST,
            "arm/src/arm.cpp": CPP.format('m.header.frame_id = "odom"; p_ = create_publisher<Odometry>("odom", 1);'),
        }
    )
    repository.write({"arm/src/arm.cpp": CPP.format(new)})
    (found,) = compare(repository).subjects
    assert sentences(found)[0] == "publisher 'odom' (Odometry) comes from parameter 'topic' now ('odom' by default)"
    assert not any("frames of messages" in line for line in sentences(found))


EMPTY = """import rclpy
from rclpy.node import Node


class Arm(Node):
    def __init__(self):
        super().__init__("arm")
        self.declare_parameter(name="camera", value={})
        self.camera = self.get_parameter("camera").value
        self.out = self.create_publisher(Image, "done", 1)

    def send(self, image):
        image.header.frame_id = self.camera
        if not self.camera:
            image.header.frame_id = {}
        self.out.publish(image)
"""


@pytest.mark.parametrize(("fallback", "is_lost"), [("image.source", True), ('"lens"', False)])
def test_frame_that_a_parameter_no_longer_gives_by_default(repository, compare, fallback, is_lost):
    repository.commit({**MANIFEST, "arm/arm/arm.py": EMPTY.format('"lens"', "None")})
    repository.write({"arm/arm/arm.py": EMPTY.format('""', fallback)})
    (found,) = compare(repository).subjects
    assert "parameter 'camera': default 'lens' -> ''" in sentences(found)
    assert any("'lens'" in str(change.reason) for change in found.changes) is is_lost


CPP_SUM = """  auto p = declare_parameter<std::string>("prefix", "ins");
  auto t = declare_parameter<std::string>("input", "scan");
  s_ = create_publisher<Bool>(NAME, 1);"""
PYTHON_SUM = """self.declare_parameter("prefix", "ins")
        self.declare_parameter("input", "scan")
        prefix = self.get_parameter("prefix").value
        name = self.get_parameter("input").value
        self.s = self.create_publisher(Bool, NAME, 1)"""


@pytest.mark.parametrize(
    ("text", "old", "new"),
    [
        (CPP.format(CPP_SUM), "t", 'p + "/" + t'),
        (PYTHON.format(PYTHON_SUM), "name", 'prefix + "/" + name'),
        (PYTHON.format(PYTHON_SUM), "name", 'f"{prefix}/{name}"'),
    ],
)
def test_parameters_that_are_joined_give_a_name_by_default(repository, compare, text, old, new):
    path = "arm/arm/arm.py" if text.startswith("import") else "arm/src/arm.cpp"
    repository.commit({**MANIFEST, path: text.replace("NAME", old)})
    repository.write({path: text.replace("NAME", new)})
    (found,) = compare(repository).subjects
    assert sentences(found)[0] == "publisher 'scan' (Bool) renamed to 'ins/scan' (Bool)"
    assert [str(change.reason) for change in found.changes if change.reason] == [NOT_FOUND]


def test_another_default_of_one_of_the_joined_parameters_is_breaking(repository, compare):
    text = CPP.format(CPP_SUM).replace("NAME", 'p + "/" + t')
    repository.commit({**MANIFEST, "arm/src/arm.cpp": text})
    repository.write({"arm/src/arm.cpp": text.replace('"ins"', '"gps"')})
    (found,) = compare(repository).subjects
    assert [str(change.reason) for change in found.changes] == [NOT_FOUND.replace("scan", "ins/scan")]


def test_a_name_that_something_unknown_precedes_is_shown(repository, compare):
    text = CPP.format("auto t = find_topic(); s_ = create_publisher<Bool>(NAME, 1);")
    repository.commit({**MANIFEST, "arm/src/arm.cpp": text.replace("NAME", "t")})
    repository.write({"arm/src/arm.cpp": text.replace("NAME", 'prefix_ + "/" + t')})
    (found,) = compare(repository).subjects
    assert sentences(found) == ["publisher 't' (Bool) renamed to 'prefix_ + \"/\" + t' (Bool)"]


GIVEN = """class Arm : public rclcpp::Node {{
  Arm() : Node("arm") {{
    {0}
    out_ = create_publisher<Imu>("done", 1);
  }}
  void send() {{ message_.header.frame_id = {1}; {2} out_->publish(message_); }}
  std::string topic_, frame_;
}};
"""
DECLARED = 'declare_parameter("{0}", {0}_); get_parameter("{0}", {0}_); '


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        (('s_ = create_publisher<Bool>("flag", 1);', "frame_", ""),
         (DECLARED.format("topic") + "s_ = create_publisher<Bool>(topic_, 1);", "frame_", ""),
         ("publisher 'flag' (Bool) comes from parameter 'topic' now ('' by default)",
          "by default, programs that use the name 'flag' do not find it")),
        (("", '"tool"', ""), (DECLARED.format("frame"), "frame_", ""),
         ("frame of messages 'tool' comes from parameter 'frame' now ('' by default)",
          "by default, programs that look for the frame 'tool' in the messages do not find it")),
        (("", '"tool"', ""),
         ('declare_parameter<std::string>("frame", "tip"); get_parameter("frame", frame_);', "frame_", ""),
         ("frame of messages 'tool' comes from parameter 'frame' now ('tip' by default)",
          "by default, programs that look for the frame 'tool' in the messages do not find it")),
    ],
)  # fmt: skip
def test_a_parameter_that_gives_another_name_by_default_is_breaking(repository, compare, old, new, expected):
    repository.commit({**MANIFEST, "arm/src/arm.cpp": GIVEN.format(*old)})
    repository.write({"arm/src/arm.cpp": GIVEN.format(*new)})
    changes = [change for found in compare(repository).subjects for change in found.changes if change.reason]
    assert [(str(change.sentence), str(change.reason)) for change in changes] == [expected]


@pytest.mark.parametrize(
    "new",
    [
        # the source sets another text if it is empty
        (DECLARED.format("topic") + 'if (topic_ == "") topic_ = "flag"; s_ = create_publisher<Bool>(topic_, 1);',
         "frame_", ""),
        (DECLARED.format("topic") + "if (!topic_.empty()) s_ = create_publisher<Bool>(topic_, 1);", "frame_", ""),
    ],
)  # fmt: skip
def test_a_name_that_may_be_the_old_one_by_default_is_not_called_empty(repository, compare, new):
    old = ('s_ = create_publisher<Bool>("flag", 1);', '"tool"', "")
    repository.commit({**MANIFEST, "arm/src/arm.cpp": GIVEN.format(*old)})
    repository.write({"arm/src/arm.cpp": GIVEN.format(*new)})
    lines = [line for found in compare(repository).subjects for line in sentences(found)]
    assert lines
    assert not any("comes from parameter" in line for line in lines)


def test_a_frame_is_not_given_by_the_parameter_of_another_message(repository, compare):
    repository.commit({**MANIFEST, "arm/src/arm.cpp": GIVEN.format("", '"tool"', "")})
    new = GIVEN.format(DECLARED.format("frame"), "frame_", "").replace("message_.h", "other.h")
    repository.write({"arm/src/arm.cpp": new})
    lines = [line for found in compare(repository).subjects for line in sentences(found)]
    assert "frames of messages removed: 'tool'" in lines


CMAKE = """cmake_minimum_required(VERSION 3.8)
project(arm)
find_package(ament_cmake REQUIRED)
add_executable(arm src/arm.cpp)
add_executable(viewer src/viewer.cpp)
install(TARGETS arm viewer DESTINATION lib/${PROJECT_NAME})
ament_package()
"""


@pytest.mark.parametrize(("program", "reasons"), [("arm", []), ("viewer", [NOT_FOUND])])
def test_a_launch_file_sets_parameters_only_for_the_programs_that_it_names(repository, compare, program, reasons):
    launch = LAUNCH.replace('exec="arm"', f'exec="{program}"')
    files = {"arm/CMakeLists.txt": CMAKE, "arm/src/viewer.cpp": "", "arm/launch/arm.launch.xml": launch}
    (sentence,), found = find_changes(repository, compare, CPP.format(SUBSCRIPTION), files)
    assert sentence == 'parameter \'input\': default "scan" -> "points"'
    assert found == reasons


@pytest.mark.parametrize(
    ("text", "code"),
    [
        (CPP, 'auto t = declare_parameter<std::string>("input", "scan"); s_ = create_publisher<Bool>(t, 1);'),
        (PYTHON, "t = self.declare_parameter('input', \"scan\").value; self.create_publisher(Bool, t, 1)"),
    ],
)
@pytest.mark.parametrize("is_added", [True, False])
def test_an_added_name_that_a_parameter_gives_is_told_with_the_parameter(repository, compare, text, code, is_added):
    path = "arm/arm/arm.py" if text is PYTHON else "arm/src/arm.cpp"
    repository.commit({**MANIFEST, **({} if is_added else {path: text.format("")})})
    repository.write({path: text.format(code)})
    (found,) = compare(repository).subjects
    name = "'scan' (Bool) from parameter 'input'"
    names = {f"publishers added: {name}", f"publishers added: 'done' (Bool), {name}"}
    assert len(names.intersection(sentences(found))) == 1
    assert not any("computed" in line for line in sentences(found))


def test_a_name_that_becomes_the_default_of_a_parameter_is_another_name(repository, compare):
    path = "arm/arm/arm.py"
    text = PYTHON.format("VALUE\n        self.create_subscription(Bool, NAME, self.stop, 1)")
    repository.commit({**MANIFEST, path: text.replace("VALUE", "pass").replace("NAME", '"/scan"')})
    value = "self.t = str(self.declare_parameter('input', '/points').value).strip()"
    repository.write({path: text.replace("VALUE", value).replace("NAME", "self.t")})
    (found,) = compare(repository).subjects
    assert sentences(found)[0] == "subscription '/scan' (Bool) comes from parameter 'input' now ('/points' by default)"
    assert str(found.changes[0].reason) == "programs that use the name '/scan' do not find it"
