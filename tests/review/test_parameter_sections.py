"""The lines of a review about parameter files that nobody misses: clocks, renamed lists, placeholders and tests."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

NAVIGATION = """local_client:
  ros__parameters:
    use_sim_time: true
behavior_server:
  ros__parameters:
    recovery_plugins: [spin, wait]
    spin: {plugin: nav2/Spin}
    enabled: true
"""
PATH = "arm/config/navigation.yaml"


def review_text(repository, compare, new: str, files: dict[str, str] | None = None):
    repository.commit({"arm/package.xml": PACKAGE_XML, PATH: NAVIGATION, **(files or {})})
    repository.write({PATH: new})
    return compare(repository)


CLOCK = NAVIGATION[: NAVIGATION.index("behavior_server")]


@pytest.mark.parametrize(
    ("old", "new", "is_breaking"),
    [
        (CLOCK, "", False),
        (NAVIGATION[NAVIGATION.index("behavior_server") :], "", True),
        ("recovery_plugins: [spin, wait]", "behavior_plugins: [spin, wait, drive]", False),
        ("recovery_plugins: [spin, wait]", "behavior_plugins: [spin]", True),
        ("recovery_plugins: [spin, wait]", "recovery_plugins: [spin]\n    other_plugins: [wait]", False),
        ("enabled: true", "enabled: 'on'", True),
    ],
)
def test_only_what_somebody_misses_is_breaking(repository, compare, old, new, is_breaking):
    assert old in NAVIGATION
    result = review_text(repository, compare, NAVIGATION.replace(old, new))
    assert sentences(subject(result, PATH))
    assert bool(breaking(result)) is is_breaking


@pytest.mark.parametrize(("text", "is_breaking"), [("'KEEPOUT'", False), ("'OTHER'", True)])
def test_placeholder_that_a_launch_file_replaces_has_no_type(repository, compare, text, is_breaking):
    launch = f"def generate_launch_description():\n    return RewrittenYaml('x', value_rewrites={{{text}: keepout}})\n"
    new = NAVIGATION.replace("enabled: true", "enabled: KEEPOUT")
    result = review_text(repository, compare, new, {"arm/launch/navigation.launch.py": launch})
    assert bool(breaking(result)) is is_breaking


CONTROLLERS = """controller_manager:
  ros__parameters:
    arm_controller:
      type: joint_trajectory_controller/JointTrajectoryController
"""


@pytest.mark.parametrize(("key", "is_lost"), [("/**/controller_manager", False), ("ns/controller_manager", False)])
def test_controller_manager_in_any_namespace_has_the_controllers(repository, compare, key, is_lost):
    launch = '<launch><node pkg="controller_manager" exec="spawner" args="arm_controller"/></launch>'
    files = {"arm/package.xml": PACKAGE_XML, "arm/launch/arm.launch.xml": launch}
    repository.commit({**files, "arm/config/controllers.yaml": CONTROLLERS})
    repository.write({"arm/config/controllers.yaml": CONTROLLERS.replace("controller_manager", key)})
    result = compare(repository)
    assert any("names the controller" in text for text in breaking(result)) is is_lost


CMAKE = """cmake_minimum_required(VERSION 3.8)
project(arm)
if(BUILD_TESTING)
  install(DIRECTORY test/config DESTINATION share/${PROJECT_NAME}/test)
endif()
"""


@pytest.mark.parametrize("is_removed", [True, False])
@pytest.mark.parametrize(
    ("cmake", "is_breaking"),
    [(CMAKE, False), (CMAKE.replace("if(BUILD_TESTING)", "").replace("endif()", ""), True)],
)
def test_files_that_only_tests_use_are_not_breaking(repository, compare, cmake, is_breaking, is_removed):
    path = "arm/test/config/navigation.yaml"
    package = PACKAGE_XML.replace("arm_description", "arm")
    repository.commit({"arm/package.xml": package, "arm/CMakeLists.txt": cmake, path: NAVIGATION})
    repository.write({path: None if is_removed else CLOCK})
    result = compare(repository)
    assert sentences(subject(result, path))
    assert any(found.path == path for found, _ in result.breaking_changes) is is_breaking


@pytest.mark.parametrize("install", ["", "install(DIRECTORY test DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION})\n"])
def test_launch_files_of_tests_are_not_breaking_in_ros_1_either(repository, compare, install):
    path = "arm/test/arm.launch"
    package = PACKAGE_XML.replace("arm_description", "arm").replace(
        "<exec", "<buildtool_depend>catkin</buildtool_depend><exec", 1
    )
    cmake = f"cmake_minimum_required(VERSION 3.0)\nproject(arm)\nfind_package(catkin)\ncatkin_package()\n{install}"
    launch = '<launch><node pkg="amcl" type="amcl" name="amcl"/></launch>\n'
    repository.commit({"arm/package.xml": package, "arm/CMakeLists.txt": cmake, path: launch})
    repository.write({path: "<launch/>\n"})
    assert bool(breaking(compare(repository))) is bool(install)


@pytest.mark.parametrize(
    ("files", "path", "is_breaking"),
    [
        ({}, "test/launch/arm.launch.xml", False),
        ({}, "launch/arm.launch.xml", True),
        ({"manifest.xml": "<package/>"}, "test/launch/arm.launch.xml", True),
        ({"tests/arm/package.xml": "arm_checks"}, "tests/arm/launch/arm.launch.xml", False),
        ({"tests/package.xml": "arm_checks"}, "tests/launch/arm.launch.xml", True),
        (
            {"tests/arm/package.xml": "arm_checks", "README.md": "ros2 launch arm_checks"},
            "tests/arm/launch/arm.launch.xml",
            True,
        ),
        (
            {"tests/arm/package.xml": "arm_checks", "tests/README.md": "Start arm_checks."},
            "tests/arm/launch/arm.launch.xml",
            False,
        ),
        ({"tests/arm/package.xml": "arm_checks", "b/package.xml": "b"}, "tests/arm/launch/arm.launch.xml", False),
        (
            {
                "tests/arm/package.xml": "arm_checks",
                "b/package.xml": "b",
                "b/launch/b.launch.xml": "$(find-pkg-share arm_checks)",
            },
            "tests/arm/launch/arm.launch.xml",
            True,
        ),
    ],
)
def test_launch_files_of_test_packages_and_without_package_break_nothing(repository, compare, files, path, is_breaking):
    manifests = {name: PACKAGE_XML.replace("arm_description", text) for name, text in files.items() if "/p" in name}
    launch = '<launch><node pkg="amcl" exec="amcl" name="amcl"/></launch>\n'
    repository.commit({**files, **manifests, path: launch})
    repository.write({path: "<launch/>\n"})
    assert bool(breaking(compare(repository))) is is_breaking


GAINS = {"/**": ["rho: 1.2", "p: 2.0", "i: 0.1", "d: 0.01", "limit: 5"]}
SPLIT = {"/**": ["rho: 1.2"], "/pilot": ["p: 2.0", "i: 0.1", "d: 0.02", "limit: 5"]}


def format_sections(sections: dict[str, list[str]]) -> str:
    return "".join(
        f"{node}:\n  ros__parameters:\n" + "".join(f"    {value}\n" for value in values)
        for node, values in sections.items()
    )


def test_parameters_that_move_to_another_node_are_one_change(repository, compare):
    repository.commit({"arm/package.xml": PACKAGE_XML, PATH: format_sections(GAINS)})
    repository.write({PATH: format_sections(SPLIT)})
    found = sentences(subject(compare(repository), PATH))
    assert found == [
        "moved from /** to /pilot: p, i, limit",
        "/pilot.ros__parameters.d 0.02 added",
        "/**.ros__parameters.d 0.01 removed",
    ]


@pytest.mark.parametrize("values", [["p: 2.0", "i: 0.1"], ["p: 1.0", "i: 1.1", "limit: 6"]])
def test_few_equal_values_of_another_node_have_not_moved(repository, compare, values):
    repository.commit({"arm/package.xml": PACKAGE_XML, PATH: format_sections(GAINS)})
    repository.write({PATH: format_sections({"/**": ["rho: 1.2"], "/pilot": values})})
    assert not any(text.startswith("moved") for text in sentences(subject(compare(repository), PATH)))


def test_topic_that_moves_to_another_node_stays_breaking(repository, compare):
    old = {"/lidar": ["scan_topic: front/scan", "rate: 12", "range: 30", "noise: 0.1"]}
    repository.commit({"arm/package.xml": PACKAGE_XML, PATH: format_sections({**old, "/camera": ["width: 3"]})})
    repository.write({PATH: format_sections({"/lidar": [], "/camera": ["width: 3", *old["/lidar"]]})})
    result = compare(repository)
    assert any("scan_topic" in text for text in breaking(result))


POSES = """arm:
  ros__parameters:
    home:
      - shoulder: 0.5
      - elbow: 1.0
    rate: 10
"""


@pytest.mark.parametrize(
    ("new", "expected"),
    [
        (POSES.replace("  - ", "  "), []),
        (POSES.replace("  - ", "  ").replace("1.0", "2.0"), ["arm.ros__parameters.home.elbow 1.0 -> 2.0"]),
        (
            POSES.replace("  - ", "  ").replace("      elbow: 1.0\n", ""),
            ["arm.ros__parameters.home[1].elbow 1.0 removed"],
        ),
    ],
)
def test_a_list_of_mappings_that_ros_2_cannot_read_is_not_missed(repository, compare, new, expected):
    repository.commit({"arm/package.xml": PACKAGE_XML, PATH: POSES})
    repository.write({PATH: new})
    result = compare(repository)
    text, *others = sentences(subject(result, PATH))
    assert text.startswith("lists of mappings, which no parameter of ROS 2 can be, became mappings: arm.")
    assert (others, breaking(result)) == (expected, [])


FILTER = """{name}:
  ros__parameters:
    frequency: {rate}
    two_d_mode: true
    use_control: {is_controlled}
    map_frame: map
    odom_frame: odom
    base_link_frame: base_link
    odom0: {odometry}
"""
MORE = """    imu0: imu
    imu0_queue_size: 10
    imu0_relative: false
    odom0_queue_size: 10
    odom0_relative: false
    sensor_timeout: 0.1
    process_noise_covariance: [{covariance}]
"""


def test_a_renamed_node_with_many_new_parameters_is_compared_value_by_value(repository, compare):
    covariance = ", ".join("0.5" if index % 16 == 0 else "0.0" for index in range(225))
    others = FILTER.format(name="ekf_map", rate=10.0, is_controlled="false", odometry="gps")
    new = FILTER.format(name="ekf_odom", rate=10.0, is_controlled="false", odometry="wheels") + MORE + others
    repository.commit(
        {
            "arm/package.xml": PACKAGE_XML,
            PATH: FILTER.format(name="ekf_filter", rate=5.0, is_controlled="true", odometry="wheels"),
        }
    )
    repository.write({PATH: new.replace("{covariance}", covariance)})
    texts = sentences(subject(compare(repository), PATH))
    assert "ekf_filter renamed to ekf_odom" in texts
    assert "ekf_odom.ros__parameters.frequency 5.0 -> 10.0" in texts
    diagonal = f"15 x 15, diagonal [{', '.join(['0.5'] * 15)}]"
    assert [text for text in texts if text.endswith(f"process_noise_covariance {diagonal} added")]


def test_parameters_below_a_second_section_have_no_effect(repository, compare):
    path, start = "arm/config/controllers.yaml", "controller_manager:\n  ros__parameters:\n    update_rate: 100\n"
    repository.commit({path: start})
    repository.write({path: f"{start}    arm:\n      ros__parameters:\n        joints: [left, right]\n"})
    reasons = [str(change.reason) for _, change in compare(repository).breaking_changes]
    assert reasons == ["no node gets parameters below a second 'ros__parameters'"]


def test_an_added_list_of_mappings_is_shown_with_its_items(repository, compare):
    repository.commit({"arm/package.xml": PACKAGE_XML})
    items = "".join(f"- module: {name}\n  args:\n    topic: /{name}\n    rate: 10\n" for name in ("map", "camera"))
    repository.write({"arm/config/topics.yaml": items})
    (review_subject,) = compare(repository).subjects
    (line,) = sentences(review_subject)
    assert line.startswith("parameter file added: ")
    assert "/map" in line
    assert "/camera" in line


def test_plugins_topics_and_frames_of_a_long_added_file_come_first(repository, compare):
    repository.commit({"arm/package.xml": PACKAGE_XML})
    sizes = "".join(f"    size_{number}: {number + 1}\n" for number in range(40))
    names = "    plugins: [walls]\n    walls:\n      plugin: a/Walls\n      scan_topic: /scan\n    global_frame: map\n"
    others = "".join(f"other_{number}:\n  ros__parameters:\n    use_sim_time: true\n" for number in range(4))
    repository.write({"arm/config/map.yaml": f"map:\n  ros__parameters:\n{sizes}{names}{others}"})
    (line,) = sentences(subject(compare(repository), "arm/config/map.yaml"))
    first = "plugins [walls], walls.plugin a/Walls, walls.scan_topic /scan, global_frame map, size_0 1"
    assert line.startswith(f"parameter file added: parameters of map ({first}, ")
    assert "size_23 24 and 16 more)" in line  # the other nodes have one value each


@pytest.mark.parametrize(
    ("section", "reason"),
    [
        ("/**", "the nodes that load the file start without these parameters"),
        ("lamp", "the node 'lamp' starts without these parameters"),
    ],
)
def test_section_for_any_node_is_not_called_a_node(repository, compare, section, reason):
    text = "other:\n  ros__parameters:\n    port: 1\n"
    lamp = f"{section}:\n  ros__parameters:\n    rate: 10\n    gain: 2.0\n"
    repository.commit({"p/package.xml": PACKAGE_XML, "p/config/a.yaml": text + lamp})
    repository.write({"p/config/a.yaml": text})
    ((_, change),) = compare(repository).breaking_changes
    assert str(change.reason) == reason
