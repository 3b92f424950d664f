"""Names below that of the node in ROS 1, which are private."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences

MANIFEST = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")}
CPP = '#include <ros/ros.h>\nint main(int c, char ** v) {{ ros::NodeHandle nh; nh.subscribe("in", 1, f); {} }}\n'
PYTHON = "import rospy\nrospy.init_node('arm')\n{}\n"


@pytest.fixture
def review_source(repository, compare):
    """Review another text of a source, and return the sentences and the breaking ones."""

    def run(name, old, new):
        repository.commit({**MANIFEST, f"arm/src/{name}": old})
        repository.write({f"arm/src/{name}": new})
        result = compare(repository)
        return [sentence for subject in result.subjects for sentence in sentences(subject)], breaking(result)

    return run


@pytest.mark.parametrize(
    "code",
    [
        'nh.param<std::string>((ros::this_node::getName() + "/frame"), frame, "base");',
        'nh.param<std::string>(ros::this_node::getName()+"/frame", frame, "base");',
        'std::string name = ros::this_node::getName(); nh.param<std::string>(name + "/frame", frame, "base");',
    ],
)
def test_parameter_below_the_name_of_the_node_is_private_in_cpp(review_source, code):
    lines, _ = review_source("a.cpp", CPP.format(""), CPP.format(code))
    assert "parameters added: '~frame' (\"base\")" in lines


def test_parameter_below_the_name_of_the_node_is_private_in_python(review_source):
    code = "frame = rospy.get_param(rospy.get_name() + '/frame', 'base')"
    lines, _ = review_source("a.py", PYTHON.format(""), PYTHON.format(code))
    assert "parameters added: '~frame' ('base')" in lines


@pytest.mark.parametrize(
    ("name", "text", "old", "new"),
    [
        ("a.cpp", CPP, 'nh.param(ros::this_node::getName() + "/rate", rate, 5.0);', 'nh.param("~rate", rate, 5.0);'),
        ("a.py", PYTHON, "x = rospy.get_param(rospy.get_name() + '/rate', 5)", "x = rospy.get_param('~rate', 5)"),
    ],
)
def test_the_other_notation_of_a_private_name_is_no_change(review_source, name, text, old, new):
    lines, broken = review_source(name, text.format(old), text.format(new))
    assert not any("rate" in line and "added" in line for line in lines)
    assert broken == []


def test_a_name_below_another_text_is_not_private(review_source):
    code = 'std::string name = ros::this_node::getName(); name = side(); nh.param<int>(name + "/rate", rate, 1);'
    lines, _ = review_source("a.cpp", CPP.format(""), CPP.format(code))
    assert not any("~rate" in line for line in lines)
