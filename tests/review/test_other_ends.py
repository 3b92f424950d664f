"""The other end of a renamed topic, service or action, anywhere in the repository."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking

HEAD = """import rclpy
from rclpy.node import Node
from std_msgs.msg import Float64, String
from std_srvs.srv import Trigger


class Part(Node):
    def __init__(self):
        super().__init__("part")
"""
TALKER = f"{HEAD}        self.heat = self.create_publisher(Float64, '/boiler/heat', 1)\n        self.heat.publish(1)\n"
LISTENER = f"{HEAD}        self.create_subscription(Float64, '/boiler/heat', print, 1)\n"
CALLER = f"{HEAD}        self.start = self.create_client(Trigger, '/boiler/start')\n"
SERVER = f"{HEAD}        self.create_service(Trigger, '/boiler/start', print)\n"
HEAT = "programs that use the name '/boiler/heat' do not find it"


def make_files(*sources: str, **others: str) -> dict[str, str]:
    """Return packages with one source each, and other files of a third package."""
    files = {f"p{number}/package.xml": PACKAGE_XML.replace("arm_description", f"p{number}") for number in range(3)}
    files.update({f"p{number}/p{number}/part{number}.py": source for number, source in enumerate(sources)})
    return {**files, **{f"p2/{name.replace('__', '/').replace('_DOT_', '.')}": text for name, text in others.items()}}


@pytest.fixture
def find_reasons(repository, compare):
    """Return the reasons of the breaking changes of a commit that replaces texts in a file."""

    def run(files: dict[str, str], new: dict[str, str]) -> list[str]:
        repository.commit(files)
        repository.write(new)
        return [str(change.reason) for _, change in compare(repository).breaking_changes]

    return run


@pytest.mark.parametrize(
    ("source", "other", "old", "new", "reason"),
    [
        (TALKER, LISTENER, "/boiler/heat", "/stove/warmth",
         "'part1.py' still subscribes to '/boiler/heat'; nothing in the repository subscribes to '/stove/warmth'"),
        (LISTENER, TALKER, "/boiler/heat", "/stove/warmth",
         "'part1.py' still publishes '/boiler/heat'; nothing in the repository publishes '/stove/warmth'"),
        (CALLER, SERVER, "/boiler/start", "/stove/begin",
         "'part1.py' still serves '/boiler/start'; nothing in the repository serves '/stove/begin'"),
        (SERVER, CALLER, "/boiler/start", "/stove/begin",
         "'part1.py' still calls '/boiler/start'; nothing in the repository calls '/stove/begin'"),
        (LISTENER, TALKER.replace("Float64,", "String,"), "/boiler/heat", "/stove/warmth", HEAT),  # another type
        (LISTENER, TALKER.replace("'/boiler/heat'", "'boiler/heat'"), "/boiler/heat", "/boiler/part_heat",
         "'part1.py' still publishes '/boiler/heat'"),  # "part" is in a literal, from which a name may be made
    ],
)  # fmt: skip
def test_the_source_of_another_package_that_keeps_the_old_name_is_named(find_reasons, source, other, old, new, reason):
    files = make_files(source, other)
    assert find_reasons(files, {"p0/p0/part0.py": source.replace(old, new)}) == [reason]


def test_the_source_of_another_package_that_has_the_new_name_is_named(find_reasons):
    new = {"p0/p0/part0.py": TALKER.replace("/boiler", "/stove"), "p1/p1/part1.py": LISTENER.replace("boiler", "stove")}
    assert find_reasons(make_files(TALKER, LISTENER), new) == [
        f"{HEAT}; 'part1.py' subscribes to '/stove/heat'",
        f"{HEAT}; 'part0.py' publishes '/stove/heat'",
    ]


@pytest.mark.parametrize(("launch", "is_named"), [("Node()\n", True), ("Node(namespace='stove')\n", False)])
def test_relative_names_are_the_same_without_namespaces(find_reasons, launch, is_named):
    sources = [source.replace("/boiler/heat", "boiler/heat") for source in (TALKER, LISTENER)]
    files = make_files(*sources, launch__all_DOT_launch_DOT_py=launch)
    (reason, _) = find_reasons(files, {f"p{n}/p{n}/part{n}.py": sources[n].replace("heat", "warmth") for n in (0, 1)})
    assert ("'part1.py' subscribes to 'boiler/warmth'" in reason) == is_named


def test_a_client_that_follows_a_server_of_another_package_is_not_breaking(repository, compare):
    repository.commit(make_files(CALLER, SERVER.replace("start", "begin")))
    repository.write({"p0/p0/part0.py": CALLER.replace("start", "begin")})
    assert breaking(compare(repository)) == []


@pytest.mark.parametrize(
    "others",
    [
        {"p2__other_DOT_py": TALKER},
        {"launch__all_DOT_launch_DOT_py": "Node(package='p1', remappings=[('/boiler/heat', '/stove/heat')])\n"},
        {"launch__all_DOT_launch": '<launch><remap from="boiler/heat" to="stove/heat"/></launch>\n'},
    ],
)
def test_a_topic_that_others_publish_or_a_launch_file_remaps_is_left_to_nobody(find_reasons, others):
    """The listener may get the topic from another node."""
    files = make_files(TALKER, LISTENER, **others)
    assert find_reasons(files, {"p0/p0/part0.py": TALKER.replace("/boiler/heat", "/stove/warmth")}) == [HEAT]


CONTROLLER = """#include <controller_interface/controller_interface.hpp>
namespace boiler {
void Heater::on_configure() {
  sub_ = get_node()->create_subscription<std_msgs::msg::Float64>("~/goal", 1, on_goal);
}
}
PLUGINLIB_EXPORT_CLASS(boiler::Heater, controller_interface::ControllerInterface)
"""
LEFT_CONTROLLER = "'heater.cpp' still subscribes to '/main_heater/goal' as controller 'main_heater' of 'all.yaml'"
MANAGER = "controller_manager:\n  ros__parameters:\n    main_heater: {type: boiler/Heater}\n"


@pytest.mark.parametrize(
    ("manager", "end"),
    [
        (
            MANAGER,
            f"{LEFT_CONTROLLER}; nothing in the repository subscribes to '/main_heater_2/goal'",
        ),
        (
            MANAGER.replace("main_heater", "other_heater"),
            "programs that use the name '/main_heater/goal' do not find it",
        ),
        (MANAGER.replace("boiler/", "stove/"), "programs that use the name '/main_heater/goal' do not find it"),
    ],
)
def test_a_private_topic_of_a_controller_has_the_name_from_the_controller_manager(find_reasons, manager, end):
    source = TALKER.replace("/boiler/heat", "/main_heater/goal")
    files = {**make_files(source), "p1/src/heater.cpp": CONTROLLER, "p2/config/all.yaml": manager}
    found = find_reasons(files, {"p0/p0/part0.py": source.replace("/main_heater/", "/main_heater_2/")})
    assert found == [end]


@pytest.mark.parametrize(("node", "is_left"), [("part", True), ("other", False)])
def test_a_private_topic_has_the_name_of_its_node(find_reasons, node, is_left):
    private = LISTENER.replace("/boiler/heat", "~/heat")
    source = TALKER.replace("/boiler", f"/{node}")
    launch = "Node(package='p1', executable='part1', name='part')\n"
    files = make_files(source, private, launch__all_DOT_launch_DOT_py=launch)
    (reason,) = find_reasons(files, {"p0/p0/part0.py": source.replace("heat", "warmth")})
    assert reason.startswith(f"'part1.py' still subscribes to '/{node}/heat'") == is_left


PARAMETER = """        self.declare_parameter("source", "/boiler/heat")
        name = self.get_parameter("source").value
        self.create_subscription(Float64, name, print, 1)
"""


@pytest.mark.parametrize(
    ("others", "is_left"),
    [({}, True), ({"config__other_DOT_yaml": "part:\n  ros__parameters:\n    source: /stove/warmth\n"}, False)],
)
def test_a_parameter_that_no_file_sets_gives_a_name_by_default(find_reasons, others, is_left):
    files = make_files(TALKER, f"{HEAD}{PARAMETER}", **others)
    (reason,) = find_reasons(files, {"p0/p0/part0.py": TALKER.replace("/boiler/heat", "/stove/new")})
    assert reason.startswith("'part1.py' still subscribes to '/boiler/heat'") == is_left


def test_another_topic_in_a_parameter_file_names_the_subscriber(find_reasons):
    """The publisher has the topic from its parameter file."""
    talker = HEAD + PARAMETER.replace(
        "create_subscription(Float64, name, print, 1)", "create_publisher(Float64, name, 1)"
    )
    settings = "part:\n  ros__parameters:\n    source: /stove/warmth\n"
    files = make_files(talker, LISTENER.replace("/boiler/heat", "/stove/warmth"))
    files["p0/config/part.yaml"] = settings
    new = {"p0/config/part.yaml": settings.replace("/stove/warmth", "/hearth")}
    assert find_reasons(files, new) == [
        "'part1.py' still subscribes to '/stove/warmth'; nothing in the repository subscribes to '/hearth'"
    ]
