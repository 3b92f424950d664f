"""Names that C++ sources join from texts and parameters, in variables, members and base classes."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import sentences, subject

MANIFEST = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")}
PATH = "arm/src/arm.cpp"
SOURCE = """#include <rclcpp/rclcpp.hpp>
Arm::Arm() : Node("arm") {
  std::string camera = declare_parameter<std::string>("camera", "front");
  std::string other = declare_parameter<std::string>("other", "rear");
  const auto base = camera + "/rgb";
  base_ = camera + "/rgb";
  image_ = create_publisher<Image>(base + "/image", 1);
}
void Arm::start() {
  info_ = create_publisher<Info>(base_ + "/info", 1);
}
"""
IMAGE = "publisher '<camera>/rgb/image' (Image) renamed to "
INFO = "publisher '<camera>/rgb/info' (Info) renamed to "


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ('base = camera + "/rgb"', 'base = camera + "/color"', [f"{IMAGE}'<camera>/color/image' (Image)"]),
        ('base = camera + "/rgb"', 'base = camera + "/" + other',
         [f"{IMAGE}'<camera>/<other>/image' (Image)"]),
        ('base + "/image"', 'base + "/images"', [f"{IMAGE}'<camera>/rgb/images' (Image)"]),
        ('base_ = camera + "/rgb"', 'base_ = camera + "/color"', [f"{INFO}'<camera>/color/info' (Info)"]),
        ('base = camera + "/rgb";', 'text = camera;\n  const auto base = text + "/rgb";', []),
    ],
)  # fmt: skip
def test_a_variable_in_a_name_is_a_sum(repository, compare, old, new, expected):
    repository.commit({**MANIFEST, PATH: SOURCE})
    assert SOURCE.count(old) == 1
    repository.write({PATH: SOURCE.replace(old, new)})
    lines = [line for found in compare(repository).subjects for line in sentences(found)]
    assert [line for line in lines if "publisher" in line] == expected


@pytest.mark.parametrize("line", ["base = ns_ + base;", 'base = other + "/x"; other = base + "/y";'])
def test_a_variable_in_its_own_sum_is_unknown(repository, compare, line):
    source = SOURCE.replace('  const auto base = camera + "/rgb";\n', f"  {line}\n")
    repository.commit({**MANIFEST, PATH: source})
    repository.write({PATH: source.replace('"/info"', '"/infos"')})
    (found,) = compare(repository).subjects
    assert sentences(found)[0] == INFO + "'<camera>/rgb/infos' (Info)"


def test_a_member_that_is_set_twice_is_unknown(repository, compare):
    source = SOURCE.replace('  base_ = camera + "/rgb";\n', '  base_ = camera + "/rgb";\n  base_ = compute();\n')
    repository.commit({**MANIFEST, PATH: source})
    repository.write({PATH: source.replace('  base_ = camera + "/rgb"', '  base_ = camera + "/color"')})
    lines = [line for found in compare(repository).subjects for line in sentences(found)]
    assert not any(line.startswith("publisher") for line in lines)


BASE_HEADER = """class Driver : public rclcpp::Node {
 public:
  explicit Driver(const std::string & name);
  std::string getPart() { return part_; }
 private:
  std::string part_;
};
"""
BASE_SOURCE = """#include "driver/driver.hpp"
Driver::Driver(const std::string & name) : Node(name) {
  get_parameter_or("part", part_, std::string("camera"));
  declare_parameter("rate", 10.0);
}
"""
CAMERA_HEADER = '#include "driver/driver.hpp"\nclass Camera : public Driver {\n  void start();\n};\n'
CAMERA = """#include "camera/camera.hpp"
void Camera::start() {
  image_ = create_publisher<Image>(getPart() + "/rgb", 1);
}
"""
DEPTH_HEADER = "#include <rclcpp/rclcpp.hpp>\nclass Depth : public rclcpp::Node {\n  void start();\n};\n"
DEPTH = """#include "depth/depth.hpp"
void Depth::start() {
  std::string name;
  get_parameter_or("name", name, std::string("depth"));
  declare_parameter("rate", 10.0);
  image_ = create_publisher<Image>(name + "/depth", 1);
}
"""
FILES = {
    **{f"{name}/package.xml": PACKAGE_XML.replace("arm_description", name) for name in ("driver", "camera", "depth")},
    "driver/include/driver/driver.hpp": BASE_HEADER,
    "driver/src/driver.cpp": BASE_SOURCE,
    "camera/include/camera/camera.hpp": CAMERA_HEADER,
    "camera/src/camera.cpp": CAMERA,
    "depth/include/depth/depth.hpp": DEPTH_HEADER,
    "depth/src/depth.cpp": DEPTH,
}


def test_the_base_class_of_another_package_reads_the_parameter(repository, compare):
    repository.commit(FILES)
    repository.write({"camera/src/camera.cpp": CAMERA.replace('"/rgb"', '"/color"')})
    (found,) = compare(repository).subjects
    assert sentences(found) == ["publisher '<part>/rgb' (Image) renamed to '<part>/color' (Image)"]


def test_a_derived_class_has_the_names_of_its_base_class(repository, compare):
    repository.commit(FILES)
    header = '#include "camera/camera.hpp"\nclass Depth : public Camera {\n  void start();\n};\n'
    source = '#include "depth/depth.hpp"\nvoid Depth::start() {\n  Camera::start();\n}\n'
    repository.write({"depth/include/depth/depth.hpp": header, "depth/src/depth.cpp": source})
    lines = sentences(subject(compare(repository), "depth/src/depth.cpp"))
    assert "publisher '<name>/depth' (Image) renamed to '<part>/rgb' (Image)" in lines
    assert "parameters removed: 'name' (\"depth\")" in lines
