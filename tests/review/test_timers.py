"""The lines of a review about removed and added timers."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import sentences

MANIFEST = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")}
PYTHON = "from rclpy.node import Node\n\n\nclass Arm(Node):\n    def start(self):\n        self.ok = True\n{}"
STEP, STATE = ("        self.create_timer({}, self.{})\n".format(*timer) for timer in ((0.1, "step"), (0.5, "state")))
LAMBDA = "        self.create_timer(2.0, lambda: self.step())\n"
CPP = "void Arm::start() {{\n  ok_ = true;\n{}}}\n"
CPP_STEP = "  step_ = create_wall_timer(100ms, std::bind(&Arm::step, this));\n"
CPP_STATE = "  state_ = create_wall_timer(500ms, std::bind(&Arm::state, this));\n"
CPP_LAMBDA = "  run_ = create_wall_timer(2s, [this]() { run(); });\n"


@pytest.mark.parametrize(
    ("path", "old", "new", "expected"),
    [
        ("a.py", STEP + STATE, STATE, ["timer of 'step' removed: create_timer(0.1)"]),
        ("a.py", STEP, STEP + STATE, ["timer of 'state' added: create_timer(0.5)"]),
        ("a.py", LAMBDA + STATE, STATE, ["timer removed: create_timer(2.0)"]),
        (
            "a.py",
            STEP + STATE,
            STATE.replace("0.5", "0.2"),
            ["rate or period: create_timer(0.5) -> create_timer(0.2)", "timer of 'step' removed: create_timer(0.1)"],
        ),
        ("a.cpp", CPP_STEP + CPP_STATE, CPP_STATE, ["timer of 'step' removed: create_wall_timer(100ms)"]),
        ("a.cpp", CPP_STATE, CPP_STATE + CPP_LAMBDA, ["timer added: create_wall_timer(2s)"]),
    ],
)
def test_a_removed_or_added_timer_is_told(repository, compare, path, old, new, expected):
    text = PYTHON if path.endswith(".py") else CPP
    repository.commit({**MANIFEST, f"arm/{path}": text.format(old)})
    repository.write({f"arm/{path}": text.format(new)})
    assert sentences(compare(repository).subjects[0])[: len(expected)] == expected


def test_a_timer_that_moves_to_another_source_is_not_told(repository, compare):
    repository.commit({**MANIFEST, "arm/a.py": PYTHON.format(STEP + STATE), "arm/b.py": PYTHON.format("")})
    repository.write({"arm/a.py": PYTHON.format(STATE), "arm/b.py": PYTHON.format(STEP)})
    assert all("timer" not in text for found in compare(repository).subjects for text in sentences(found))


@pytest.mark.parametrize(
    ("call", "old", "new"),
    [
        ("rclcpp::create_timer(this, get_clock(), {}, f)", "rclcpp::Duration(1, 0)", "rclcpp::Duration(2, 0)"),
        ("rclcpp::create_timer(node_, clock_, {}, f)", "100ms", "200ms"),
    ],
)
def test_the_period_behind_the_node_and_its_clock_is_told(repository, compare, call, old, new):
    text = "void Arm::f() {{ timer_ = {}; }}\n"
    repository.commit({**MANIFEST, "arm/a.cpp": text.format(call.format(old))})
    repository.write({"arm/a.cpp": text.format(call.format(new))})
    expected = [f"rate or period: create_timer({old}) -> create_timer({new})"]
    assert sentences(compare(repository).subjects[0]) == expected


CLOCK = "  step_ = {}, std::bind(&Arm::step, this));\n"
NODE_CLOCK = "rclcpp::create_timer(this, this->get_clock(), period_"
ALSO_SIMULATED = ", also if use_sim_time is set"
SIMULATED = ", which is simulated time if use_sim_time is set"


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("create_wall_timer(period_", NODE_CLOCK, [f"timer of 'step': wall time -> ROS time{SIMULATED}"]),
        ("create_wall_timer(period_", "create_timer(period_", [f"timer of 'step': wall time -> ROS time{SIMULATED}"]),
        (
            NODE_CLOCK,
            "create_wall_timer(period_",
            ["timer of 'step': ROS time -> wall time, also if use_sim_time is set"],
        ),
        ("create_wall_timer(period_", "rclcpp::create_timer(this, clock_, period_", []),  # of an unknown kind
        ("create_timer(period_", NODE_CLOCK, []),
        (
            "create_wall_timer(100ms",
            "create_timer(50ms",
            [
                "rate or period: create_wall_timer(100ms) -> create_timer(50ms)",
                f"timer of 'step': wall time -> ROS time{SIMULATED}",
            ],
        ),
    ],
)
def test_another_clock_of_a_timer(repository, compare, old, new, expected):
    texts = [CPP.format(CLOCK.format(call)) for call in (old, new)]
    repository.commit({**MANIFEST, "arm/arm.cpp": texts[0]})
    repository.write({"arm/arm.cpp": texts[1]})
    lines = [line for subject in compare(repository).subjects for line in sentences(subject)]
    assert [line for line in lines if "timer" in line] == expected
    assert not expected or lines == expected


LOOP = """int main(int argc, char ** argv) {{
  ros::init(argc, argv, "arm");
  {}
}}
"""
RATE = "ros::Rate rate(hz); while (ros::ok()) { send(); ros::spinOnce(); rate.sleep(); }"


@pytest.mark.parametrize(("old", "new", "word"), [(RATE, "ros::spin();", "removed"), ("ros::spin();", RATE, "added")])
def test_the_rate_of_the_only_loop_is_told(repository, compare, old, new, word):
    repository.commit({**MANIFEST, "arm/a.cpp": LOOP.format(old)})
    repository.write({"arm/a.cpp": LOOP.format(new)})
    assert f"rate {word}: ros::Rate(hz)" in sentences(compare(repository).subjects[0])


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ({"arm/a.cpp": LOOP.format(RATE), "arm/b.cpp": "int b;\n"},
         {"arm/a.cpp": LOOP.format("ros::spin();"), "arm/b.cpp": "int b;\n" + LOOP.format(RATE)}),
        ({"arm/a.cpp": LOOP.format(RATE)}, {"arm/a.cpp": LOOP.format(RATE.replace("rate", "loop"))}),
    ],
)  # fmt: skip
def test_a_loop_that_moves_or_has_another_name_keeps_its_rate(repository, compare, old, new):
    repository.commit({**MANIFEST, **old})
    repository.write(new)
    assert all("rate " not in text for found in compare(repository).subjects for text in sentences(found))
