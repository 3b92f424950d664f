"""nav2_msgs has Humble's fields, or Jazzy's fields if ROS_DISTRO selects Jazzy."""

from __future__ import annotations

import pytest

from linkwright.messages import get_interface
from linkwright.messages.catalog import read_texts
from linkwright.messages.definitions.library import Library


def interface_names_of(package: str) -> list[str]:
    return sorted(read_texts(package))


class TestHumble:
    @pytest.fixture(autouse=True)
    def humble(self, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setenv("ROS_DISTRO", "humble")

    def test_results_have_no_error_codes(self):
        assert all("error_code" not in text for text in read_texts("nav2_msgs").values())

    def test_jazzy_interfaces_and_fields_are_missing(self):
        assert "action/DockRobot" not in interface_names_of("nav2_msgs")
        assert "goal_checker_id" in read_texts("nav2_msgs")["action/FollowPath"]
        assert "progress_checker_id" not in read_texts("nav2_msgs")["action/FollowPath"]


class TestJazzy:
    @pytest.fixture(autouse=True)
    def jazzy(self, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setenv("ROS_DISTRO", "jazzy")

    def test_results_of_actions_have_error_codes(self):
        interface_texts = read_texts("nav2_msgs")
        assert all("error_code" in text for name, text in interface_texts.items() if name.startswith("action/"))
        assert "progress_checker_id" in interface_texts["action/FollowPath"]

    def test_humble_and_jazzy_interfaces_are_available(self):
        assert {"action/DockRobot", "action/NavigateToPose", "msg/Costmap", "srv/GetCost"} <= set(
            interface_names_of("nav2_msgs")
        )


@pytest.mark.parametrize("distribution", ["humble", "jazzy"])
@pytest.mark.parametrize("package", ["nav2_msgs", "bond"])
def test_interfaces_are_well_formed(monkeypatch, package, distribution):
    monkeypatch.setenv("ROS_DISTRO", distribution)
    library = Library()
    for name in read_texts(package):
        assert library.definition(f"{package}/{name}").type_name == f"{package}/{name}"


def test_action_is_available_as_class():
    action = get_interface("nav2_msgs/action/NavigateToPose")
    goal = action.Goal()
    goal.pose.header.frame_id = "map"
    assert action.Feedback().number_of_recoveries == 0
