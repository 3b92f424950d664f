"""Topics, services and parameters that move from one node of a package to another one."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences

MANIFEST = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")}
NODE = """import rospy
from std_msgs.msg import Float32
{}


rospy.init_node("{}")
{}
"""
LEFT = 'left = rospy.Publisher("left", Float32, queue_size=1)'
RIGHT = 'right = rospy.Publisher("right", Float32, queue_size=1)'


def make(name: str, code: str, module: str = "") -> str:
    return NODE.format(module, name, code)


@pytest.fixture
def find_lines(repository, compare):
    """Review other versions of two nodes, and return the sentences about the first one and the breaking ones."""

    def run(old: dict[str, str], new: dict[str, str]):
        repository.commit({**MANIFEST, **{f"arm/src/{name}": text for name, text in old.items()}})
        repository.write({f"arm/src/{name}": text for name, text in new.items()})
        result = compare(repository)
        found = [item for item in result.subjects if item.path == "arm/src/drive.py"]
        return [sentence for item in found for sentence in sentences(item)], breaking(result)

    return run


def test_topics_that_move_to_an_added_node_are_told(find_lines):
    lines, broken = find_lines(
        {"drive.py": make("drive", f"{LEFT}\n{RIGHT}")},
        {"drive.py": make("drive", "x = 1"), "wheels.py": make("wheels", f"{LEFT}\n{RIGHT}")},
    )
    assert "publishers moved to 'arm/src/wheels.py': 'left' (Float32), 'right' (Float32)" in lines
    assert broken == []


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ({"drive.py": make("drive", LEFT)}, {"drive.py": make("drive", "import wheels"), "wheels.py": LEFT}),
        (
            {"drive.py": make("drive", LEFT), "wheels.py": make("wheels", LEFT)},
            {"drive.py": make("drive", ""), "wheels.py": make("wheels", f"{LEFT}\nx = 1")},
        ),
        (
            {"drive.py": make("drive", LEFT)},
            {"drive.py": make("drive", "", "import wheels"), "wheels.py": make("wheels", LEFT)},
        ),
    ],
)
def test_topics_of_modules_and_of_other_nodes_do_not_move(find_lines, old, new):
    lines, _ = find_lines(old, new)
    assert not any("moved to" in line for line in lines)


PLANNER = """class {name} : public rclcpp::Node {{
 public:
  {name}() : Node("{node}") {{ {code} }}
}};
"""
SPEED = 'speed_ = declare_parameter("speed", 0.5);'


@pytest.mark.parametrize(
    ("node", "name", "is_breaking"),
    [("planner", "driver", True), ("driver", "driver", False), ("planner", "other", False)],
)
def test_parameters_that_move_to_a_new_node_are_breaking(repository, compare, node, name, is_breaking):
    source = PLANNER.format(name="Driver", node="driver", code=SPEED + " start();")
    repository.commit({**MANIFEST, "arm/src/driver.cpp": source})
    repository.write(
        {
            "arm/src/driver.cpp": PLANNER.format(name="Driver", node=name, code="start();"),
            "arm/src/planner.cpp": PLANNER.format(name="Planner", node=node, code=SPEED),
        }
    )
    reasons = {str(change.sentence): str(change.reason) for _, change in compare(repository).breaking_changes}
    found = {line: reason for line, reason in reasons.items() if "parameter" in line}
    expected = {
        "parameter moved to 'arm/src/planner.cpp': 'speed' (0.5)": (
            "values that parameter files give to the old node have no effect"
        )
    }
    assert found == (expected if is_breaking else {})


@pytest.mark.parametrize(
    ("old", "new", "line"),
    [
        (LEFT, LEFT, "publishers added: 'left' (Float32)"),
        (LEFT, "", None),
        ("", LEFT, "publishers added: 'left' (Float32)"),
    ],
)
def test_a_changed_node_of_another_package_may_keep_its_name(repository, compare, old, new, line):
    other = {"base/package.xml": PACKAGE_XML.replace("arm_description", "base")}
    old_files = {"arm/src/drive.py": make("drive", "x = 1"), "base/src/wheels.py": make("wheels", f"{old}\nx = 1")}
    repository.commit({**MANIFEST, **other, **old_files})
    repository.write({"arm/src/drive.py": make("drive", LEFT), "base/src/wheels.py": make("wheels", f"{new}\nx = 2")})
    result = compare(repository)
    lines = [text for item in result.subjects if item.path == "arm/src/drive.py" for text in sentences(item)]
    assert [text for text in lines if "publishers" in text] == ([line] if line else [])


def test_a_changed_node_of_another_package_does_not_hide_a_lost_name(repository, compare):
    other = {"base/package.xml": PACKAGE_XML.replace("arm_description", "base")}
    nodes = {"arm/src/drive.py": make("drive", LEFT), "base/src/wheels.py": make("wheels", LEFT)}
    repository.commit({**MANIFEST, **other, **nodes})
    repository.write(
        {"arm/src/drive.py": make("drive", "x = 1"), "base/src/wheels.py": make("wheels", f"{LEFT}\nx = 2")}
    )
    lines = [text for item in compare(repository).subjects for text in sentences(item)]
    assert "publishers that published nothing removed: 'left' (Float32)" in lines
