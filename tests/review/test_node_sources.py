"""Changes of literal names in the sources of nodes in a review."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML, Repository
from tests.review.conftest import breaking, sentences, subject

PYTHON = """import rclpy
from rclpy.action import ActionServer
from rclpy.node import Node
from std_msgs.msg import Bool, String

TOPIC = "state"


class Driver(Node):
    def __init__(self):
        super().__init__("driver")
        self.declare_parameter("rate", 10)
        self.declare_parameters("arm", [("length", 1.0), ("mass", 2.0)])
        self.state = self.create_publisher(String, TOPIC, 10)
        self.create_subscription(Bool, "enable", self.enable, 10)
        self.create_service(SetBool, "stair_mode", self.set_mode)
        self.create_client(Trigger, "home")
        self.server = ActionServer(self, Reach, "reach", self.reach)
"""
CPP = """// create_publisher<String>("old", 10);
class Camera : public rclcpp::Node {
public:
  explicit Camera(const rclcpp::NodeOptions & options) : rclcpp::Node("camera", options) {
    rate_ = declare_parameter<double>("rate", 10.0);
    image_ = this->create_publisher<sensor_msgs::msg::Image>("image", rclcpp::QoS(1));
    sub_ = create_subscription<std_msgs::msg::Bool>("enable", 10, [this](std::shared_ptr<const Bool> m) {});
    service_ = create_service<std_srvs::srv::SetBool>("stair_mode", f);
    server_ = rclcpp_action::create_server<Reach>(this, "reach", a, b, c);
  }
};
"""
FILES = {
    "arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"),
    "arm/arm/driver.py": PYTHON,
    "arm/src/camera.cpp": CPP,
}


@pytest.mark.parametrize(
    ("path", "old", "new", "expected", "is_breaking"),
    [
        ("arm/arm/driver.py", 'SetBool, "stair_mode"', 'SetMode, "stairs_mode"',
         ["service 'stair_mode' (SetBool) renamed to 'stairs_mode' (SetMode)"], True),
        ("arm/arm/driver.py", '"state"', '"arm_state"',
         ["publisher 'state' (String) renamed to 'arm_state' (String)"], True),
        ("arm/arm/driver.py", '        self.create_subscription(Bool, "enable", self.enable, 10)\n', "",
         ["subscriptions removed: 'enable' (Bool)"], True),
        ("arm/arm/driver.py", "Reach,", "Grasp,", ["action 'reach': type Reach -> Grasp"], True),
        ("arm/arm/driver.py", "Reach,", "Grasp.Result,", ["action 'reach': type Reach -> Grasp.Result"], True),
        ("arm/arm/driver.py", '"rate", 10', '"rate", 20', ["parameter 'rate': default 10 -> 20"], False),
        ("arm/arm/driver.py", '("mass", 2.0)', "", ["parameters removed: 'arm.mass' (2.0)"], True),
        ("arm/arm/driver.py", '"home"', '"go_home"',
         ["service client 'home' (Trigger) renamed to 'go_home' (Trigger)"], True),
        ("arm/arm/driver.py", '"driver"', '"arm_driver"', ["node 'driver' renamed to 'arm_driver'"], True),
        ("arm/arm/driver.py", '"enable"', 'self.name',
         ["subscription 'enable' (Bool) has a computed name now: self.name"], False),
        ("arm/arm/driver.py", "self.enable, 10", "self.enable, 1", ["subscription 'enable': QoS 10 -> 1"], False),
        ("arm/src/camera.cpp", '"image"', '"image_raw"',
         ["publisher 'image' (Image) renamed to 'image_raw' (Image)"], True),
        ("arm/src/camera.cpp", '"camera"', '"left_camera"', ["node 'camera' renamed to 'left_camera'"], True),
        ("arm/src/camera.cpp", '"rate", 10.0', '"rate", 20.0', ["parameter 'rate': default 10.0 -> 20.0"], False),
        ("arm/src/camera.cpp", "<Reach>", "<Grasp>", ["action 'reach': type Reach -> Grasp"], True),
        ("arm/src/camera.cpp", '"image", rclcpp', "name_, rclcpp",
         ["publisher 'image' (Image) has a computed name now: name_"], False),
        ("arm/src/camera.cpp", '"old"', '"older"', [], False),
        ("arm/src/camera.cpp", "    service_ =", '    create_publisher<Bool>("ready", 1);\n    service_ =',
         ["publishers added: 'ready' (Bool)"], False),
    ],
)  # fmt: skip
def test_changed_names_in_sources_are_reported(repository, compare, path, old, new, expected, is_breaking):
    text = FILES[path]
    assert old in text
    other_files = {other: content for other, content in FILES.items() if other != path and other.endswith("xml")}
    repository.commit({**other_files, path: text})
    repository.write({path: text.replace(old, new)})
    result = compare(repository)
    assert [sentence for found in result.subjects for sentence in sentences(found)] == expected
    assert bool(breaking(result)) is is_breaking
    assert (path in result.other_files) is not expected


@pytest.mark.parametrize(("topic", "is_breaking"), [("enable", True), ("/joint_states", False), ("tf", False)])
def test_removed_subscription_of_a_common_topic_is_not_breaking(repository, compare, topic, is_breaking):
    line = '        self.create_subscription(Bool, "enable", self.enable, 10)\n'
    text = PYTHON.replace("enable", topic.strip("/")).replace(f'"{topic.strip("/")}"', f'"{topic}"')
    removed = line.replace("enable", topic.strip("/")).replace(f'"{topic.strip("/")}"', f'"{topic}"')
    assert removed in text
    repository.commit({"arm/package.xml": FILES["arm/package.xml"], "arm/arm/driver.py": text})
    repository.write({"arm/arm/driver.py": text.replace(removed, "")})
    expected = [f"subscriptions removed: '{topic}' (Bool)"] if is_breaking else []
    assert breaking(compare(repository)) == expected


def test_name_that_moves_to_another_source_of_the_package_is_not_reported(repository, compare):
    repository.commit(FILES)
    line = "        self.state = self.create_publisher(String, TOPIC, 10)\n"
    moved = f"from driver import *\n\n\ndef publish(self):\n{line.replace('TOPIC', repr('state'))}"
    repository.commit({"arm/arm/driver.py": PYTHON.replace(line, ""), "arm/arm/state.py": moved})
    (found,) = compare(repository, "HEAD~1..HEAD").subjects
    assert sentences(found) == ["code changed in 'Driver.__init__()'"]


@pytest.mark.parametrize("folder", ["repository", "tests"])
def test_name_that_an_unchanged_source_also_has_is_not_reported(tmp_path, compare, folder):
    repository = Repository(tmp_path / folder)
    other = "def publish(node):\n    node.create_publisher(String, 'arm_state', 10)\n"
    changed = PYTHON.replace('"state"', "'arm_state'")
    repository.commit({**FILES, "arm/arm/driver.py": changed, "arm/arm/state.py": other})
    repository.commit({"arm/arm/driver.py": changed.replace("self.state = self.create_publisher", "self.publish")})
    (found,) = compare(repository, "HEAD~1..HEAD").subjects
    assert sentences(found) == ["in 'Driver.__init__()': `self.publish(String, TOPIC, 10)` added"]


def test_similar_names_are_not_searched_among_many(repository, compare):
    def source(prefix: str) -> str:
        lines = [f'        self.declare_parameter("{prefix}{number}", {number})' for number in range(1500)]
        return "\n".join([PYTHON.partition("        self.declare")[0], *lines, ""])

    repository.commit({**FILES, "arm/arm/driver.py": source("left")})
    repository.commit({"arm/arm/driver.py": source("right")})
    found = subject(compare(repository, "HEAD~1..HEAD"), "arm/arm/driver.py")
    assert any("parameters removed: 'left0' (0)" in sentence for sentence in sentences(found))


def test_removed_source_of_a_node_is_breaking(repository, compare):
    repository.commit(FILES)
    repository.commit({"arm/src/camera.cpp": None})
    found = subject(compare(repository, "HEAD~1..HEAD"), "arm/src/camera.cpp")
    assert "publishers removed: 'image' (Image)" in sentences(found)


ROS1 = """import rospy

rospy.init_node("driver")
rospy.Publisher("state", String, queue_size=1)
rospy.Subscriber("enable", Bool, enable)
rospy.Service("home", Trigger, home)
"""


def test_names_of_ros_1_are_compared(repository, compare):
    cpp = 'void f(ros::NodeHandle & n) { p = n.advertise<std_msgs::Bool>("ready", 1); s = n.subscribe("go", 1, g); }\n'
    repository.commit({"arm/driver.py": ROS1, "arm/driver.cpp": cpp})
    repository.write(
        {"arm/driver.py": ROS1.replace('"home"', '"rest"'), "arm/driver.cpp": cpp.replace('"go"', '"run"')}
    )
    assert breaking(compare(repository)) == [
        "subscription 'go' renamed to 'run'",
        "service 'home' (Trigger) renamed to 'rest' (Trigger)",
    ]


LAUNCH = """from launch import LaunchDescription
from launch_ros.actions import ComposableNodeContainer
from launch_ros.descriptions import ComposableNode


def generate_launch_description():
    return LaunchDescription([
        ComposableNodeContainer(name="all", package="rclcpp_components", executable="component_container",
            composable_node_descriptions=[ComposableNode(package="arm", plugin="arm::Camera")]),
    ])
"""


@pytest.mark.parametrize(("name", "count"), [("camera", 0), ("left", 1)])
def test_default_name_of_a_node_that_is_written_out_is_not_a_change(repository, compare, name, count):
    repository.commit({**FILES, "arm/launch/arm.launch.py": LAUNCH})
    text = LAUNCH.replace('plugin="arm::Camera"', f'plugin="arm::Camera", name="{name}"')
    repository.write({"arm/launch/arm.launch.py": text})
    assert len(compare(repository).subjects) == count


def test_topics_of_a_new_node_are_listed_although_another_node_has_them(repository, compare):
    repository.commit({"a/package.xml": PACKAGE_XML, "a/scripts/driver.py": PYTHON})
    repository.write({"a/scripts/second.py": PYTHON.replace('"driver"', '"second"')})
    found = sentences(subject(compare(repository), "a/scripts/second.py"))
    assert "publishers added: 'state' (String)" in found
    assert "subscriptions added: 'enable' (Bool)" in found


FORMATTED = """void A::start() {
  char name[] = "in00";
  for (int i = 0; i < 4; i++) { snprintf(name, sizeof(name), "in%02d", i); a = nh.advertise<m::State>(name, 1); }
  for (int i = 0; i < 4; i++) { snprintf(name, sizeof(name), "out%02d", i); b = nh.advertise<m::State>(name, 1); }
}
"""
PATTERN = """import rclpy


class Node(Base):
    def start(self, name):
        self.create_service(Trigger, f"{name}/go", self.go)
"""


@pytest.mark.parametrize(
    ("path", "text", "old", "new", "expected"),
    [
        ("arm/src/a.cpp", FORMATTED, "out%02d", "exit%02d",
         """publisher '"out%02d"' (State) renamed to '"exit%02d"' (State)"""),
        ("arm/src/a.cpp", FORMATTED, "in%02d", "inner%02d",
         """publisher '"in%02d"' (State) renamed to '"inner%02d"' (State)"""),
        ("arm/a.py", PATTERN, "{name}/go", "{name}/drive",
         'service \'f"{name}/go"\' (Trigger) renamed to \'f"{name}/drive"\' (Trigger)'),
        ("arm/a.py", PATTERN, "Trigger", "SetBool", 'service \'f"{name}/go"\': type Trigger -> SetBool'),
    ],
)  # fmt: skip
def test_names_that_are_patterns_are_compared(repository, compare, path, text, old, new, expected):
    repository.commit({"arm/package.xml": FILES["arm/package.xml"], path: text})
    repository.write({path: text.replace(old, new)})
    assert breaking(compare(repository)) == [expected]


@pytest.mark.parametrize("value", ["prefix", "self.get('name').value"])
def test_another_value_in_a_pattern_is_no_other_name(repository, compare, value):
    repository.commit({"arm/a.py": PATTERN})
    repository.write({"arm/a.py": PATTERN.replace("{name}", f"{{{value}}}")})
    assert breaking(compare(repository)) == []


DEFAULT_TOPIC = """from rclpy.node import Node
class Mapper(Node):
    def __init__(self):
        super().__init__("mapper")
        self.declare_parameter("topic", "/lidar/cones")
        self.topic = self.get_parameter("topic").value
        self.create_subscription(Bool, self.topic, self.map, 10)
        self.create_subscription(String, "mode", self.set, 10)
"""


@pytest.mark.parametrize(
    ("topic", "is_breaking"), [('"slam/map"', True), ('"lidar/cones"', False), ("topic_of(self)", False)]
)
def test_a_topic_that_was_the_default_of_a_parameter_is_lost(repository, compare, topic, is_breaking):
    repository.commit({"arm/mapper.py": DEFAULT_TOPIC})
    repository.write({"arm/mapper.py": DEFAULT_TOPIC.replace("Bool, self.topic", f"Bool, {topic}")})
    reasons = [str(change.reason) for _, change in compare(repository).breaking_changes]
    assert reasons == (["programs that use the name '/lidar/cones' do not find it"] if is_breaking else [])


def test_a_topic_whose_parameter_has_another_default_is_lost(repository, compare):
    computed = DEFAULT_TOPIC.replace("/lidar/cones", "/lidar/map")
    literal = computed.replace("Bool, self.topic", "Bool, '/lidar/cones'")
    repository.commit({"arm/mapper.py": literal})
    repository.write({"arm/mapper.py": computed})
    assert breaking(compare(repository)) == [
        "subscription '/lidar/cones' (Bool) comes from parameter 'topic' now ('/lidar/map' by default)"
    ]


@pytest.mark.parametrize("imported", ["from launch import LaunchService", "from launch.actions import ExecuteProcess"])
def test_node_that_starts_launch_files_is_a_node(repository, compare, imported):
    text = f"{imported}\n{PYTHON}"
    repository.commit({"arm/driver.py": text})
    repository.write({"arm/driver.py": text.replace('"stair_mode"', '"mode"')})
    assert breaking(compare(repository)) == ["service 'stair_mode' (SetBool) renamed to 'mode' (SetBool)"]


@pytest.mark.parametrize("start", ["\ufeff", "print 'a'\nif 1 < .05:\n    pass\n"])
def test_python2_and_byte_order_marks_are_read(repository, compare, start):
    repository.commit({"arm/driver.py": start + PYTHON})
    repository.write({"arm/driver.py": start + PYTHON.replace('"stair_mode"', '"mode"')})
    assert breaking(compare(repository)) == ["service 'stair_mode' (SetBool) renamed to 'mode' (SetBool)"]


def test_a_source_that_neither_version_can_parse_is_told(repository, compare):
    text = "def run(:\n    return 1\n"
    repository.commit({"arm/driver.py": text})
    repository.write({"arm/driver.py": text.replace("1", "2")})
    (found,) = compare(repository).subjects
    assert [str(problem.text) for problem in found.problems] == [
        "neither version can be read: line 1 has a syntax error"
    ]
    assert found.changes == []


def test_the_default_of_the_constructor_is_the_name_of_the_node(repository, compare):
    text = PYTHON.replace("(self)", "(self, name='driver', *, rate=1)", 1).replace(
        '__init__("driver")', "__init__(name)"
    )
    repository.commit({**FILES, "arm/arm/driver.py": text})
    repository.write({"arm/arm/driver.py": text.replace("'driver'", "'base'")})
    assert breaking(compare(repository)) == ["node 'driver' renamed to 'base'"]


def test_a_node_with_braces_that_moves_to_python_keeps_its_name(repository, compare):
    text = 'struct Arm : rclcpp::Node {};\nHand::Hand(const Options & options) : rclcpp::Node{"hand", options} {}\n'
    repository.commit({**FILES, "arm/src/hand.cpp": text})
    (repository.root / "arm/src/hand.cpp").unlink()
    code = "from rclpy.node import Node\n\n\nclass Hand(Node):\n    def __init__(self):\n"
    repository.write({"arm/arm/hand.py": f"{code}        super().__init__('hand')\n"})
    lines = [line for found in compare(repository).subjects for line in sentences(found)]
    assert not [line for line in lines if "nodes" in line]
    repository.write({"arm/src/hand.cpp": text.replace('"hand"', '"fist"'), "arm/arm/hand.py": ""})
    assert "node 'hand' renamed to 'fist'" in breaking(compare(repository))
