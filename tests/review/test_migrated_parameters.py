"""Parameter files that move from the format of ROS 1 to that of ROS 2."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

PATH = "arm/config/arm.yaml"


@pytest.fixture
def review_changes(repository, compare):
    """Review two versions of a YAML file.

    Return the changes, and the sentences of the breaking ones.
    """

    def run(old: str, new: str):
        repository.commit({"arm/package.xml": PACKAGE_XML, PATH: old})
        repository.write({PATH: new})
        result = compare(repository)
        return subject(result, PATH), breaking(result)

    return run


def test_parameters_without_a_node_move_below_its_name(review_changes):
    found, found_breaking = review_changes(
        "frame_id: laser\nrate: 10\nmodes: [scan, cloud]\nold: 1\n",
        "lidar:\n  ros__parameters:\n    frame_id: laser\n    rate: 10.0\n    modes: [scan]\n    new: 2\n",
    )
    assert sentences(found) == [
        "frame_id, rate, modes moved to lidar.ros__parameters",
        "lidar.ros__parameters.modes [scan, cloud] -> [scan]",
        "lidar.ros__parameters.new 2 added",
        "old 1 removed",
    ]
    assert found_breaking == []


def test_parameters_of_nodes_move_below_the_key_of_ros_2(review_changes):
    found, _ = review_changes(
        "amcl: {min_particles: 10, model: diff}\nmap_server: {frame_id: map}\nboard: {port: 1, baud: 2}\n",
        "amcl:\n  ros__parameters: {min_particles: 20, model: diff}\n"
        "map_server:\n  ros__parameters: {frame_id: map}\n"
        "board:\n  ros__parameters: {port: 1, baud: 2}\n",
    )
    assert sentences(found) == [
        "amcl moved to amcl.ros__parameters",
        "amcl.ros__parameters.min_particles 10 -> 20",
    ]
    assert found.changes[0].other_names == (
        "map_server -> map_server.ros__parameters",
        "board -> board.ros__parameters",
    )


def test_parameters_of_the_same_names_in_two_nodes_are_not_moved(review_changes):
    node = "  ros__parameters: {rate: 10, model: diff}\n"
    found, _ = review_changes("rate: 10\nmodel: diff\n", f"left:\n{node}right:\n{node}")
    assert not any(" moved to " in sentence for sentence in sentences(found)), sentences(found)


def test_file_with_other_values_is_not_moved(review_changes):
    found, _ = review_changes("rate: 10\na: 1\nb: 2\n", "lidar:\n  ros__parameters: {rate: 10, model: diff}\n")
    assert not any(" moved to " in sentence for sentence in sentences(found)), sentences(found)


def test_parameters_beside_the_key_of_ros_2_have_not_moved(review_changes):
    old = "arm: {type: a, joints: [x, y], rate: 10}\nhand:\n  type: b\n  rate: 20\n"
    found, found_breaking = review_changes(old, old + "  ros__parameters: {speed: 2, force: 3}\n")
    assert sentences(found) == ["hand.ros__parameters added: speed 2, force 3"]
    assert found_breaking == []
