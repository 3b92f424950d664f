"""The lines of a review about names of node handles of ROS 1 that are members of a class."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import sentences

MANIFEST = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")}
CLASS = "class Arm { public: Arm(); ros::NodeHandle nh, other; ros::Publisher p; };\n"
SOURCE = 'Arm::Arm() { p = nh.advertise<std_msgs::Bool>("ready", 1); }\n'
INCLUDE = "#include <arm/arm.hpp>\n"
PRIVATE_CLASS = CLASS.replace("nh, other", 'nh{"~"}')
PRIVATE_SOURCE = SOURCE.replace("Arm() {", 'Arm() : nh("~") {')
BECOMES_PRIVATE = "publisher 'ready' (Bool) renamed to '~ready' (Bool)"


@pytest.mark.parametrize(
    ("header", "old", "new", "expected"),
    [
        (CLASS, SOURCE, PRIVATE_SOURCE, BECOMES_PRIVATE),
        (CLASS, SOURCE, PRIVATE_SOURCE.replace('("~")', '{"~"}'), BECOMES_PRIVATE),
        ("", CLASS + SOURCE, PRIVATE_CLASS + SOURCE, BECOMES_PRIVATE),
        (CLASS, PRIVATE_SOURCE, PRIVATE_SOURCE.replace('"ready"', '"on"'),
         "publisher '~ready' (Bool) renamed to '~on' (Bool)"),
        (PRIVATE_CLASS, SOURCE, SOURCE.replace("{ p", '{ double g; nh.param("gain", g, 1.0); p'),
         "parameters added: '~gain' (1.0)"),
        (PRIVATE_CLASS, "ros::NodeHandle nh;\n" + SOURCE, "ros::NodeHandle nh;\n" + SOURCE.replace("ready", "on"),
         "publisher 'ready' (Bool) renamed to 'on' (Bool)"),
    ],
)  # fmt: skip
def test_names_of_a_private_node_handle_are_private(repository, compare, header, old, new, expected):
    repository.commit({**MANIFEST, "arm/include/arm/arm.hpp": header, "arm/src/arm.cpp": INCLUDE + old})
    repository.write({"arm/src/arm.cpp": INCLUDE + new})
    (found,) = compare(repository).subjects
    assert sentences(found)[0] == expected
    assert not any(sentence.startswith("values") for sentence in sentences(found))
