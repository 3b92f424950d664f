"""The lines of a review about classes that have another name, and about callbacks with equal names."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences

MANIFEST = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")}
CPP = """#include "spring.hpp"
Spring::Spring() : count_(0) {}
void Spring::configure(const Element & element)
{
  topic_ = element.get("Spring");
}
void Spring::onCommand(const Double & message)
{
  command_ = message.data * 2;
}
EXPORT(Spring)
"""
NODES = """class Camera : public rclcpp::Node {
public:
  Camera() : Node("camera") { sub_ = create_subscription<Image>("image", 10, std::bind(&Camera::update, this, _1)); }
  void update(const Image & m) { x = 1; }
};
class Marker : public rclcpp::Node {
public:
  Marker() : Node("marker") { sub_ = create_subscription<Pose>("pose", 10, std::bind(&Marker::update, this, _1)); }
  void update(const Pose & m) { y = 1; }
};
"""
PYTHON_NODES = """class Base(Node):
    def __init__(self, body):
        self.create_subscription(Pose, "pose", self.update, 10)


class Camera(Node):
    def __init__(self, body):
        self.create_subscription(Image, "image", self.update, 10)
        self.create_subscription(Pose, body, self.measure, 10)

    def update(self, m):
        self.x = m.pose


class Marker(Base):
    def update(self, m):
        self.y = m.pose

    def measure(self, m):
        self.z = m.pose


class Store:
    def update(self, m):
        self.w = m.pose
"""


@pytest.fixture
def review_lines(repository, compare):
    """Review another text of a source, and return the sentences."""

    def run(path, old, new):
        repository.commit({**MANIFEST, path: old})
        repository.write({path: new})
        result = compare(repository)
        assert not breaking(result)
        return [sentence for subject in result.subjects for sentence in sentences(subject)]

    return run


def test_code_of_a_class_with_another_name_is_not_changed(review_lines):
    new = CPP.replace("Spring:", "Coil:").replace(":Spring(", ":Coil(").replace("(Spring)", "(Coil)")
    assert review_lines("arm/src/spring.cpp", CPP, new) == ["code renamed: 'Spring' -> 'Coil'"]


def test_text_with_the_old_name_of_a_class_is_not_the_class(review_lines):
    assert review_lines("arm/src/spring.cpp", CPP, CPP.replace("Spring", "Coil")) == [
        'in \'Coil::configure()\': `topic_ = element.get("Spring")` -> `topic_ = element.get("Coil")`',
        "code renamed: 'Spring' -> 'Coil'",
    ]


def test_changed_method_of_a_class_with_another_name_is_named(review_lines):
    new = CPP.replace("Spring:", "Coil:").replace(":Spring(", ":Coil(").replace("data * 2", "data + offset_")
    assert review_lines("arm/src/spring.cpp", CPP, new.replace("(Spring)", "(Coil)")) == [
        "in 'Coil::onCommand()': `command_ = message.data * 2` -> `command_ = message.data + offset_`",
        "code renamed: 'Spring' -> 'Coil'",
    ]


def test_class_without_methods_may_have_another_name(review_lines):
    old = """class ArmData {
public:
  int count = 0;
  double rate = 1.0;
};
Arm::Arm() : data_(std::make_unique<ArmData>()) {}
void Arm::run() { go(data_->count); }
"""
    assert review_lines("arm/src/arm.cpp", old, old.replace("ArmData", "ArmState")) == [
        "code renamed: 'ArmData' -> 'ArmState'"
    ]


def test_different_class_with_other_methods_is_not_the_old_one(review_lines):
    new = """#include "spring.hpp"
void Motor::configure(const Element & element)
{
  start(element);
}
void Motor::start(const Element & element)
{
  element.go();
}
void Motor::stop() { halt(); }
"""
    (line,) = review_lines("arm/src/spring.cpp", CPP, new)
    assert "code renamed" not in line


@pytest.mark.parametrize(
    ("old", "new", "line"),
    [
        ("x = 1;", "x = f();", "in 'Camera::update()' (callback of subscription 'image'): `x = 1` -> `x = f()`"),
        ("y = 1;", "y = f();", "in 'Marker::update()' (callback of subscription 'pose'): `y = 1` -> `y = f()`"),
    ],
)
def test_callback_in_cpp_is_that_of_its_class(review_lines, old, new, line):
    assert review_lines("arm/src/nodes.cpp", NODES, NODES.replace(old, new)) == [line]


@pytest.mark.parametrize(
    ("name", "line"),
    [
        ("x", "in 'Camera.update()' (callback of subscription 'image')"),
        ("y", "in 'Marker.update()' (callback of subscription 'pose')"),  # the base class subscribes
        ("z", "in 'Marker.measure()'"),
        ("w", "in 'Store.update()'"),
    ],
)
def test_callback_in_python_is_that_of_its_class(review_lines, name, line):
    new = PYTHON_NODES.replace(f"self.{name} = m.pose", f"self.{name} = m.pose if m else None")
    change = f"`self.{name} = m.pose` -> `self.{name} = m.pose if m else None`"
    assert review_lines("arm/arm/nodes.py", PYTHON_NODES, new) == [f"{line}: {change}"]


def test_renamed_class_of_an_installed_header_is_one_breaking_change(repository, compare):
    header = """class Old : public rclcpp::Node {
public:
  explicit Old(const rclcpp::NodeOptions & options);
  void initialize(int a, int b);
private:
  int inputs_ = 0;
};
"""
    build = "project(arm)\ninstall(DIRECTORY include/ DESTINATION include)\n"
    repository.commit({**MANIFEST, "arm/CMakeLists.txt": build, "arm/include/arm/n.hpp": header})
    repository.write({"arm/include/arm/n.hpp": header.replace("Old", "Teleoperation")})
    result = compare(repository)
    assert [line for subject in result.subjects for line in sentences(subject)] == breaking(result)
    assert breaking(result) == ["class 'Old' renamed to 'Teleoperation'"]
