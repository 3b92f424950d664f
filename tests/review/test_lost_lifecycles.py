"""Classes of nodes that are no longer lifecycle nodes."""

from __future__ import annotations

import pytest

from tests.review.conftest import breaking, sentences, subject

CPP = "class Motors : public rclcpp_lifecycle::LifecycleNode {\n};\n"
PYTHON = "class Motors(LifecycleNode):\n    pass\n"


@pytest.mark.parametrize(
    ("launch", "is_breaking"), [("", True), ("<node pkg='nav2_lifecycle_manager' exec='lifecycle_manager'/>", False)]
)
def test_class_that_becomes_a_lifecycle_node(repository, compare, launch, is_breaking):
    files = {"arm/launch/arm.launch.xml": f"<launch>{launch}</launch>\n"}
    repository.commit({"arm/motors.py": PYTHON.replace("Lifecycle", ""), **files})
    repository.write({"arm/motors.py": PYTHON})
    result = compare(repository)
    text = "class 'Motors' is a lifecycle node now"
    assert text in sentences(subject(result, "arm/motors.py"))
    assert (text in breaking(result)) is is_breaking


@pytest.mark.parametrize(
    ("path", "old", "new", "is_lost"),
    [
        ("arm/motors.hpp", CPP, CPP.replace("rclcpp_lifecycle::Lifecycle", "rclcpp::"), True),
        ("arm/motors.hpp", CPP, CPP.replace("public rclcpp_lifecycle::", "public "), False),
        ("arm/motors.py", PYTHON, PYTHON.replace("Lifecycle", ""), True),
        ("arm/motors.py", PYTHON, PYTHON.replace("LifecycleNode", "Base"), False),
        ("arm/motors.py", PYTHON.replace("Lifecycle", ""), PYTHON, False),
    ],
)
def test_class_that_becomes_a_plain_node_is_breaking(repository, compare, path, old, new, is_lost):
    repository.commit({path: old})
    repository.write({path: new})
    expected = "class 'Motors' is no longer a lifecycle node"
    assert (expected in breaking(compare(repository))) == is_lost
