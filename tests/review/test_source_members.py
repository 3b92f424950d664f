"""The lines of a review about node names, timers and actions that are declared in a header."""

from __future__ import annotations

import os

import pytest

from linkwright.review.sources.cpp.members import read_included_headers
from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

MANIFEST = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")}
TIMER = "import rospy\nrospy.init_node('arm')\n"


def test_the_only_node_of_a_source_is_renamed_although_another_file_has_the_new_name(repository, compare):
    old = "import rospy\nrospy.init_node('master2')\n"
    repository.commit({**MANIFEST, "arm/master.py": old, "arm/old_master.py": old.replace("master2", "master")})
    repository.write({"arm/master.py": old.replace("master2", "master")})
    assert breaking(compare(repository)) == ["node 'master2' renamed to 'master'"]


def test_an_added_node_with_a_computed_name_is_told_with_names_that_another_node_has(repository, compare):
    imports = "import rospy\nfrom names import Bool, make_name\n"
    text = imports + "rospy.init_node({})\np = rospy.Publisher('out', Bool, queue_size=1)\n"
    repository.commit({**MANIFEST, "arm/a.py": text.format("'arm'")})
    repository.write({"arm/b.py": text.format("make_name()")})
    (found,) = compare(repository).subjects
    assert sentences(found) == ["publishers added: 'out' (Bool)"]


@pytest.mark.parametrize(
    "call",
    [
        "rospy.Timer(rospy.Duration(0.2), f)",
        "rospy.timer.Timer(rospy.Duration(0.2), f)",
        "rospy.Timer(rospy.Duration.from_sec(0.2), f)",
    ],
)
def test_the_period_of_a_timer_of_ros_1_is_told(repository, compare, call):
    period = call[call.index("rospy.Duration") : call.index(", f)")]
    repository.commit({**MANIFEST, "arm/a.py": TIMER + call})
    repository.write({"arm/a.py": TIMER + call.replace("0.2", "0.5")})
    (found,) = compare(repository).subjects
    assert sentences(found) == [f"rate or period: Timer({period}) -> Timer({period.replace('0.2', '0.5')})"]


def test_the_periods_of_an_added_node_are_told(repository, compare):
    repository.commit(MANIFEST)
    repository.write(
        {"arm/a.py": TIMER + "from arm import f\nrospy.Timer(rospy.Duration(0.2), f)\nrate = rospy.Rate(10)\n"}
    )
    (found,) = compare(repository).subjects
    assert sentences(found) == ["nodes added: 'arm'", "rates and periods: Timer(rospy.Duration(0.2)), Rate(10)"]


@pytest.mark.parametrize(
    ("declaration", "made", "expected"),
    [
        ("actionlib::SimpleActionServer<arm_msgs::ReachAction> as_;",
         'Arm::Arm() : as_(nh_, "reach", boost::bind(&Arm::f, this, _1), false) {}',
         "action 'reach' (ReachAction) renamed to 'grasp' (ReachAction)"),
        ("typedef actionlib::SimpleActionClient<arm_msgs::ReachAction> Client;\n  Client client_;",
         'Arm::Arm() : client_("reach", true) {}',
         "action client 'reach' (ReachAction) renamed to 'grasp' (ReachAction)"),
        ("using Server = nav2_util::SimpleActionServer<arm_msgs::action::Reach>;\n  std::unique_ptr<Server> server_;",
         'Arm::Arm() { server_ = std::make_unique<Server>(shared_from_this(), "reach", f); }',
         "action 'reach' (Reach) renamed to 'grasp' (Reach)"),
        ("boost::shared_ptr<actionlib::SimpleActionServer<ReachAction> > as_;",
         'Arm::Arm() { as_.reset(new actionlib::SimpleActionServer<ReachAction>(nh_, "reach", f, false)); }',
         "action 'reach' (ReachAction) renamed to 'grasp' (ReachAction)"),
        ("message_filters::Subscriber<sensor_msgs::Image> image_;", 'Arm::Arm() : image_(nh_, "reach", 1) {}',
         "subscription 'reach' (Image) renamed to 'grasp' (Image)"),
        ("message_filters::Subscriber<sensor_msgs::Image> image_;",
         'void Arm::f() { image_.subscribe(nh_, "reach", 1); }',
         "subscription 'reach' (Image) renamed to 'grasp' (Image)"),
        ("std::shared_ptr<message_filters::Subscriber<Image>> image_;",
         'void Arm::f() { image_->subscribe(this, "reach"); }',
         "subscription 'reach' (Image) renamed to 'grasp' (Image)"),
        ("std::shared_ptr<message_filters::Subscriber<Image>> image_;",
         'Arm::Arm() { image_ = std::make_shared<message_filters::Subscriber<Image>>(this, "reach"); }',
         "subscription 'reach' (Image) renamed to 'grasp' (Image)"),
        ("boost::shared_ptr<message_filters::Subscriber<Image> > image_;",
         'Arm::Arm() { image_.reset(new message_filters::Subscriber<Image>(nh_, "reach", 10)); }',
         "subscription 'reach' (Image) renamed to 'grasp' (Image)"),
    ],
)  # fmt: skip
def test_a_member_that_a_header_declares_has_the_name_that_the_source_gives(
    repository, compare, declaration, made, expected
):
    header = f"class Arm {{\n  {declaration}\n}};\n"
    source = f"#include <arm/arm.hpp>\n{made}\n"
    repository.commit({**MANIFEST, "arm/include/arm/arm.hpp": header, "arm/src/arm.cpp": source})
    repository.write({"arm/src/arm.cpp": source.replace('"reach"', '"grasp"')})
    (found,) = compare(repository).subjects
    assert sentences(found) == [expected]


def test_a_client_whose_name_a_parameter_gives_is_added(repository, compare):
    source = """#include <ros/ros.h>
Arm::Arm() {
  std::string server = nh_.param<std::string>("server", "reach");
}
"""
    made = "  client_.reset(new actionlib::SimpleActionClient<arm_msgs::ReachAction>(server, false));\n}"
    repository.commit({**MANIFEST, "arm/src/arm.cpp": source})
    repository.write({"arm/src/arm.cpp": source.replace("}", made)})
    (found,) = compare(repository).subjects
    assert "action clients added: 'reach' (ReachAction) from parameter 'server'" in sentences(found)


def test_a_node_that_existed_before_its_manifest_is_not_added(repository, compare):
    header = "class Base : public rclcpp::Node {\n public:\n  Base(const std::string & name) : Node(name) {}\n};\n"
    source = '#include "base.hpp"\nclass Arm : public Base {\n  Arm() : Base("arm") { publish("a"); }\n};\n'
    repository.commit(
        {"arm/CMakeLists.txt": "project(arm)\n", "arm/include/base.hpp": header, "arm/src/arm.cpp": source}
    )
    repository.write({**MANIFEST, "arm/src/arm.cpp": source.replace('publish("a")', 'publish("b")')})
    assert not [line for found in compare(repository).subjects for line in sentences(found) if "nodes added" in line]


def test_parameters_of_default_member_initializers_in_a_header_are_compared(repository, compare):
    header = 'class Arm : public Node {\n  double rate_ = declare_parameter("rate", 10.0);\n};\n'
    repository.commit({**MANIFEST, "arm/include/arm/arm.hpp": header})
    repository.write({"arm/include/arm/arm.hpp": header.replace("10.0", "20.0")})
    (found,) = compare(repository).subjects
    assert sentences(found) == ["parameter 'rate': default 10.0 -> 20.0"]


@pytest.mark.skipif(os.name == "nt", reason="symbolic links of POSIX")
@pytest.mark.parametrize("include", ["{outside}/secret.hpp", "../../../secret.hpp", "link.hpp"])
def test_headers_outside_of_the_package_are_not_read(tmp_path, include):
    (tmp_path / "secret.hpp").write_text("actionlib::SimpleActionServer<SecretAction> server_;\n")
    source = tmp_path / "repository/arm/src/arm.cpp"
    source.parent.mkdir(parents=True)
    (source.parents[1] / "package.xml").write_text(MANIFEST["arm/package.xml"])
    (source.parent / "link.hpp").symlink_to(tmp_path / "secret.hpp")
    path = include.format(outside=tmp_path)
    source.write_text(f'#include "{path}"\nArm::Arm() : server_(nh_, "reach", f, false) {{}}\n')
    assert read_included_headers(source) == []


POINT_HEADER = """#pragma once
namespace m {
class Link {
public:
  Link() {}
  double center;
  double step{0.1};
  double speed, rate = 2.0;
  std::vector<int> sizes;
private:
  int count_;
};
}
"""
HEADER_PACKAGE = {
    "arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"),
    "arm/CMakeLists.txt": "project(arm)\ninstall(DIRECTORY include/ DESTINATION include)\n",
}


@pytest.mark.parametrize(
    ("old", "new", "expected", "is_breaking"),
    [
        ("center", "middle", "public member 'Link::center' (double) renamed to 'Link::middle' (double)", True),
        ("  std::vector<int> sizes;\nprivate:\n", "private:\n  std::vector<int> sizes;\n",
         "public members no longer public: 'Link::sizes' (std::vector<int>)", True),
        (", rate = 2.0", "", "public members removed: 'Link::rate' (double)", True),
        ("  double step{0.1};\n", "", "public members removed: 'Link::step' (double)", True),
        ("  double center;\n  double step{0.1};\n  double speed, rate = 2.0;\n  std::vector<int> sizes;\n",
         "  double step{0.1};\n  double speed, rate = 2.0;\n  double mass;\n",
         "public members removed: 'Link::center' (double), 'Link::sizes' (std::vector<int>)", True),
        ("double center", "float center", "public member 'Link::center': type double -> float", False),
        ("double center", "static double center", "public member 'Link::center': type double -> static double", False),
        ("double center", "std::string center", "public member 'Link::center': type double -> std::string", True),
    ],
)  # fmt: skip
def test_public_members_of_installed_classes_are_an_interface(repository, compare, old, new, expected, is_breaking):
    path = "arm/include/arm/point.hpp"
    repository.commit({**HEADER_PACKAGE, path: POINT_HEADER})
    repository.write({path: POINT_HEADER.replace(old, new)})
    result = compare(repository)
    assert expected in sentences(subject(result, path))
    assert breaking(result) == ([expected] if is_breaking else [])


def test_private_members_of_installed_classes_are_no_interface(repository, compare):
    path = "arm/include/arm/point.hpp"
    repository.commit({**HEADER_PACKAGE, path: POINT_HEADER})
    repository.write({path: POINT_HEADER.replace("count_", "number_")})
    assert breaking(compare(repository)) == []


def test_a_deleted_assignment_is_no_member(repository, compare):
    path = "arm/include/arm/point.hpp"
    repository.commit({**HEADER_PACKAGE, path: POINT_HEADER})
    deleted = "public:\n  Link & operator=(const Link &) = delete;\n"
    repository.write({path: POINT_HEADER.replace("public:\n", deleted)})
    result = compare(repository)
    assert "operator" not in " ".join(str(change.sentence) for item in result.subjects for change in item.changes)


@pytest.mark.parametrize(
    "parameter",
    [
        "const std_msgs::{}ConstPtr& m",
        "std_msgs::{}::ConstPtr m",
        "const std_msgs::msg::{}::ConstSharedPtr & m",
        "std_msgs::msg::{}::UniquePtr m",
        "const boost::shared_ptr<std_msgs::{} const>& m",
        "const ros::MessageEvent<std_msgs::{} const>& m",
        "const std_msgs::{}& m",
    ],
)
def test_the_callback_of_a_subscription_tells_its_type(repository, compare, parameter):
    text = 'void A::cb(%s) {}\nvoid A::start() { s = nh_.subscribe("state", 1, &A::cb, this); }\n'
    repository.commit({"arm/src/node.cpp": text % parameter.format("Float64")})
    repository.write({"arm/src/node.cpp": text % parameter.format("Bool")})
    assert breaking(compare(repository)) == ["subscription 'state': type Float64 -> Bool"]


def test_a_subscription_with_the_same_callback_is_renamed(repository, compare):
    text = 'void A::cb(const m::%sPtr& m) {}\nvoid A::start() { s = nh_.subscribe("%s", 1, &A::cb, this); }\n'
    repository.commit({"arm/src/node.cpp": text % ("Angles", "positions")})
    repository.write({"arm/src/node.cpp": text % ("State", "cmd")})
    assert breaking(compare(repository)) == ["subscription 'positions' (Angles) renamed to 'cmd' (State)"]


PROTECTED_HEADER = """#pragma once
class Arm {
public:
  Arm();
protected:
  enum Kind { NONE = 0, LONG = 1 };
  int count;
  void move(double speed);
private:
  struct Cache { int size; };
  void clear();
  virtual double measure(int axis) = 0;
};
"""
DERIVED = "classes that derive from the class and use the members do not build"


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("  enum Kind { NONE = 0, LONG = 1 };\n", "", ["protected members removed: 'Arm::Kind'"]),
        ("int count", "int number", ["protected members removed: 'Arm::count' (int)"]),
        ("  void move(double speed);\n", "", ["protected members removed: 'Arm::move' (double)"]),
        ("  int count;\n  void move(double speed);\nprivate:\n", "  void move(double speed);\nprivate:\n  int count;\n",
         ["protected members removed: 'Arm::count' (int)"]),
        ("  Arm();\nprotected:\n", "  Arm();\n", []),
        ("  struct Cache { int size; };\n", "", []),
        ("  void clear();\n", "", []),
    ],
)  # fmt: skip
def test_classes_that_derive_from_an_installed_class_need_protected_members(repository, compare, old, new, expected):
    path = "arm/include/arm/arm.hpp"
    repository.commit({**HEADER_PACKAGE, path: PROTECTED_HEADER})
    repository.write({path: PROTECTED_HEADER.replace(old, new)})
    result = compare(repository)
    assert breaking(result) == expected
    assert [str(change.reason) for item in result.subjects for change in item.changes if change.reason] == (
        [DERIVED] if expected else []
    )


@pytest.mark.parametrize(
    ("new", "expected"),
    [
        ("virtual double read(int axis) = 0;",
         ["private virtual functions added: 'Arm::read' (int)",
          "private virtual functions removed: 'Arm::measure' (int)"]),
        ("virtual double measure(int axis, bool raw) = 0;", ["private function 'Arm::measure': (int) -> (int, bool)"]),
    ],
)  # fmt: skip
def test_classes_that_derive_from_an_installed_class_define_its_private_functions(repository, compare, new, expected):
    path = "arm/include/arm/arm.hpp"
    repository.commit({**HEADER_PACKAGE, path: PROTECTED_HEADER})
    repository.write({path: PROTECTED_HEADER.replace("virtual double measure(int axis) = 0;", new)})
    assert breaking(compare(repository)) == expected


CALLS = "classes that derive from the class and call or define 'Arm::move' do not build"


@pytest.mark.parametrize(
    ("old", "new", "expected", "reason"),
    [
        ("int count", "double count", "protected member 'Arm::count': type int -> double", None),
        ("int count", "Pose count", "protected member 'Arm::count': type int -> Pose",
         "classes that derive from the class and use it as 'int' do not build"),
        ("void move(double speed)", "void move(int steps)", "protected function 'Arm::move': (double) -> (int)", CALLS),
        ("void move(double speed)", "void move(double speed, int n = 1)",
         "protected function 'Arm::move': (double) -> (double, int = ...)", None),
        ("  int count;", "  int count;\n  int size;", "protected members added: 'Arm::size' (int)", None),
    ],
)  # fmt: skip
def test_types_of_protected_members_of_an_installed_class(repository, compare, old, new, expected, reason):
    path = "arm/include/arm/arm.hpp"
    repository.commit({**HEADER_PACKAGE, path: PROTECTED_HEADER})
    repository.write({path: PROTECTED_HEADER.replace(old, new)})
    first = subject(compare(repository), path).changes[0]
    assert (str(first.sentence), first.reason and str(first.reason)) == (expected, reason)


NAMESPACES = "#pragma once\nnamespace arm {\nnamespace detail {\nint count();\n}\n}\n"


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("namespace arm", "namespace tool", "namespace 'arm' renamed to 'tool'"),
        ("namespace detail {\nint count();\n}", "int count();", "namespaces removed: 'detail'"),
        ("int count();", "int count();\nnamespace more {\nint size();\n}", None),
    ],
)
def test_namespaces_of_an_installed_header(repository, compare, old, new, expected):
    path = "arm/include/arm/arm.hpp"
    repository.commit({**HEADER_PACKAGE, path: NAMESPACES})
    repository.write({path: NAMESPACES.replace(old, new)})
    found = [sentence for sentence in breaking(compare(repository)) if "namespace" in sentence]
    assert found == ([expected] if expected else [])


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (NAMESPACES, []),
        (NAMESPACES.replace("namespace detail {\n", "").replace("}\n}", "}"),
         ["'count' moved from namespace 'arm' to 'tool'"]),
    ],
)  # fmt: skip
def test_a_namespace_that_another_header_of_the_package_opens_is_not_lost(repository, compare, text, expected):
    path = "arm/include/arm/arm.hpp"
    other = {"arm/include/arm/tool.hpp": "#pragma once\nnamespace arm {\nint size();\n}\n"}
    repository.commit({**HEADER_PACKAGE, path: text, **other})
    repository.write({path: text.replace("namespace arm", "namespace tool")})
    assert [sentence for sentence in breaking(compare(repository)) if "namespace" in sentence] == expected


ALIASES = """#pragma once
class Arm {
public:
  typedef std::function<void(int)> Callback;
  using Speed = double;
  void start(Callback callback);
  void move(Speed speed);
};
"""


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("Callback", "Handler", []),
        ("(Speed speed)", "(double speed)", []),
        ("(Speed speed)", "(int speed)", ["function 'Arm::move': (Speed) -> (int)"]),
    ],
)
def test_other_names_of_types_are_no_other_types(repository, compare, old, new, expected):
    path = "arm/include/arm/arm.hpp"
    repository.commit({**HEADER_PACKAGE, path: ALIASES})
    repository.write({path: ALIASES.replace(old, new)})
    assert breaking(compare(repository)) == expected


def test_header_that_a_manifest_of_rosbuild_exports_is_an_interface(repository, compare):
    manifest = '<package><export><cpp cflags="-I${prefix}/include"/></export></package>'
    files = {"arm/manifest.xml": manifest, "arm/CMakeLists.txt": "rosbuild_init()\n"}
    repository.commit({**files, "arm/include/arm/arm.h": ALIASES})
    repository.write({"arm/include/arm/arm.h": ALIASES.replace("  void move(Speed speed);\n", "")})
    assert breaking(compare(repository)) == ["functions removed: 'Arm::move' (Speed)"]


def test_a_node_whose_base_class_gets_its_name_in_braces_is_compared(repository, compare):
    text = 'Arm::Arm(const rclcpp::NodeOptions & options) : rclcpp::Node{"arm", options} {}\n'
    repository.commit({**MANIFEST, "arm/src/arm.cpp": text})
    repository.write({"arm/src/arm.cpp": text.replace('"arm"', '"arms"')})
    assert breaking(compare(repository)) == ["node 'arm' renamed to 'arms'"]


@pytest.mark.parametrize(
    ("base", "expected"),
    [("public rclcpp_lifecycle::LifecycleNode", ["node 'arm' renamed to 'arms'"]), ("public Device", [])],
)
def test_a_node_whose_own_base_class_gets_its_name_is_compared(repository, compare, base, expected):
    header = f"#pragma once\nclass BaseNode : {base} {{\npublic:\n  BaseNode(const std::string & name);\n}};\n"
    source = '#include "arm/base_node.hpp"\nArm::Arm() : arm::BaseNode("arm"), rate_(1) {}\n'
    repository.commit({**MANIFEST, "arm/include/arm/base_node.hpp": header, "arm/src/arm.cpp": source})
    repository.write({"arm/src/arm.cpp": source.replace('"arm"', '"arms"')})
    assert breaking(compare(repository)) == expected


@pytest.mark.parametrize("made", ['message_filters.Subscriber("reach", Image)', "Subscriber(self, Image, 'reach')"])
def test_filtered_subscription_in_python_is_compared(repository, compare, made):
    source = f"import message_filters\nfrom message_filters import Subscriber\nsub = {made}\n"
    repository.commit({**MANIFEST, "arm/scripts/arm.py": source})
    repository.write({"arm/scripts/arm.py": source.replace("reach", "grasp")})
    (found,) = compare(repository).subjects
    assert sentences(found) == ["subscription 'reach' (Image) renamed to 'grasp' (Image)"]


@pytest.mark.parametrize(
    ("name", "is_breaking"),
    [
        ("/move_group/rate", False),
        ("/planner/rate", True),
        ("/arm/rate", True),
        ("/rate", True),
        ("planner/rate", True),
    ],
)
def test_removed_parameter_of_another_node_breaks_nobody(repository, compare, name, is_breaking):
    source = 'int main() {{ ros::init(argc, argv, "arm");\n  ros::NodeHandle nh;\n  {} }}\n'
    repository.commit({**MANIFEST, "arm/src/arm.cpp": source.format(f'nh.getParam("{name}", rate);')})
    repository.write({"arm/src/arm.cpp": source.format("")})
    (found,) = compare(repository).subjects
    change = next(change for change in found.changes if name in str(change.sentence))
    assert (change.reason is not None) is is_breaking


@pytest.mark.parametrize("head", ["struct ALIGN_16 Point", "class ARM_PUBLIC Point final", "struct Point"])
def test_a_macro_before_the_name_of_a_class_hides_no_members(repository, compare, head):
    path = "arm/include/arm/arm.hpp"
    text = f"#pragma once\n{head} {{\npublic:\n  int count;\n  static int size();\n}};\n"
    repository.commit({**HEADER_PACKAGE, path: text})
    repository.write({path: text.replace("  static int size();\n", "")})
    assert breaking(compare(repository)) == ["functions removed: 'Point::size'"]
