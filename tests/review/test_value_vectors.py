"""Values of a parameter file that belong together, such as the components of a pose, are one line of a review."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import sentences, subject

PATH = "arm/config/arm.yaml"


@pytest.fixture
def lines(repository, compare):
    """Return the lines about a file with other values, each with the other names."""

    def run(old: str, new: str) -> list[tuple[str, tuple[str, ...]]]:
        repository.commit({"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"), PATH: old})
        repository.write({PATH: new})
        changes = subject(compare(repository), PATH).changes
        return [(str(change.sentence), change.other_names) for change in changes]

    return run


NODE = "amcl:\n  ros__parameters:\n    {}\n"


def make_text(values: dict[str, str]) -> str:
    return NODE.format("\n    ".join(f"{name}: {value}" for name, value in values.items()))


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ({"alpha1": "0.2", "alpha2": "0.2"}, {"alpha1": "0.1", "alpha2": "0.1"},
         [("amcl.ros__parameters: alpha1 0.2 -> 0.1, alpha2 0.2 -> 0.1", ())]),
        ({"alpha1": "0.2", "alpha2": "0.2", "alpha3": "0.2"}, {"alpha1": "0.1", "alpha2": "0.1", "alpha3": "0.1"},
         [("amcl.ros__parameters.alpha1 0.2 -> 0.1", ("amcl.ros__parameters.alpha2", "amcl.ros__parameters.alpha3"))]),
        ({"max_vel_x": "0.2", "max_vel_theta": "1.0"}, {"max_vel_x": "0.3", "max_vel_theta": "2.0"},
         [("amcl.ros__parameters: max_vel_x 0.2 -> 0.3, max_vel_theta 1.0 -> 2.0", ())]),
        ({"max_rot_vel": "0.2", "min_rot_vel": "0.1"}, {"max_rot_vel": "0.3", "min_rot_vel": "0.2"},
         [("amcl.ros__parameters: max_rot_vel 0.2 -> 0.3, min_rot_vel 0.1 -> 0.2", ())]),
        ({"vx_max": "0.2", "vyMax": "0.1"}, {"vx_max": "0.3", "vyMax": "0.2"},
         [("amcl.ros__parameters: vx_max 0.2 -> 0.3, vyMax 0.1 -> 0.2", ())]),
        ({"rate": "5.0", "timeout": "1.0"}, {"rate": "6.0", "timeout": "2.0"},
         [("amcl.ros__parameters.rate 5.0 -> 6.0", ()), ("amcl.ros__parameters.timeout 1.0 -> 2.0", ())]),
        ({"max_vel": "5.0", "max_range": "1.0"}, {"max_vel": "6.0", "max_range": "2.0"},
         [("amcl.ros__parameters.max_vel 5.0 -> 6.0", ()), ("amcl.ros__parameters.max_range 1.0 -> 2.0", ())]),
        ({"alpha1": "0.2", "alpha2": "0.2"}, {"alpha1": "0.1", "alpha2": "true"},
         [("amcl.ros__parameters.alpha1 0.2 -> 0.1", ()), ("amcl.ros__parameters.alpha2 0.2 -> true", ())]),
    ],
)  # fmt: skip
def test_numbers_whose_names_differ_in_the_axis_or_number_are_one_line(lines, old, new, expected):
    assert lines(make_text(old), make_text(new)) == expected


POSES = """{{a: {{orientation: {{yaw: {yaw}}}, translation: {{x: {x}, y: 0.0}}}},
b: {{orientation: {{yaw: {yaw}}}, translation: {{x: {x}, y: 0.0}}}}}}
"""


def test_equal_changes_of_several_poses_are_one_line(lines):
    expected = "a: orientation.yaw 0.0 -> 1.5, translation.x 0.0 -> 0.2"
    assert lines(POSES.format(yaw="0.0", x="0.0"), POSES.format(yaw="1.5", x="0.2")) == [(expected, ("b",))]


def test_items_of_the_lists_of_a_filter_have_names(lines):
    def text(yaw: str, roll: str, pitch_rate: str) -> str:
        inputs = ["false"] * 15
        inputs[11] = yaw
        covariance = ["0.0"] * 225
        covariance[3 * 15 + 3], covariance[0 * 15 + 10] = roll, pitch_rate
        return make_text(
            {"odom0_config": f"[{', '.join(inputs)}]", "process_noise_covariance": f"[{', '.join(covariance)}]"}
        )

    assert [line for line, _ in lines(text("true", "0.1", "0.0"), text("false", "0.2", "0.5"))] == [
        "amcl.ros__parameters.odom0_config: vyaw true -> false",
        "amcl.ros__parameters.process_noise_covariance: (x, vpitch) 0.0 -> 0.5, roll 0.1 -> 0.2",
    ]


def test_items_of_other_lists_have_no_names(repository, compare):
    path = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"), PATH: "weights: [1, 2, 3]\n"}
    repository.commit(path)
    repository.write({PATH: "weights: [1, 2, 4]\n"})
    assert sentences(subject(compare(repository), PATH)) == ["weights [1, 2, 3] -> [1, 2, 4]"]


@pytest.mark.parametrize(
    ("names", "expected"),
    [
        ("ab", ["arm.a 1 added", "arm.b 1 added"]),
        ("abcd", ["arm: a 1, b 1, c 1, d 1 added"]),
        ("abcdefghijkl", ["arm: a 1, b 1, c 1, d 1, e 1, f 1, g 1, h 1, i 1, j 1 added", "arm: k 1, l 1 added"]),
    ],
)
def test_many_values_that_a_part_gains_or_loses_are_listed_together(lines, names, expected):
    old, new = "arm:\n  rate: 5\n", "arm:\n  rate: 5\n" + "".join(f"  {name}: 1\n" for name in names)
    assert [line for line, _ in lines(old, new)] == expected
    assert [line for line, _ in lines(new, old)] == [line.replace("added", "removed") for line in expected]


def test_zeros_and_empty_values_of_a_long_added_file_come_last(repository, compare):
    values = {f"zero{number}": "0.0" for number in range(20)} | {"empty": "[]", "none": "[0.0, 0]"}
    values |= {f"rate{number}": "5" for number in range(15)}
    repository.commit({"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")})
    repository.write({PATH: make_text(values)})
    (line,) = sentences(subject(compare(repository), PATH))
    assert all(f"rate{number} 5" in line for number in range(15))
    assert "zero0 0.0" in line
    assert "zero19" not in line


UNNAMED = "thrusters:\n" + "".join(f"- {{pose: [{x}, 0, 1], rate: 5}}\n" for x in range(4))
NAMED = "thrusters:\n" + "".join(f"- {{name: T{x}, pose: [{x}, 0, 1], rate: 5}}\n" for x in range(4))
NAMES = tuple(f"thrusters[T{x}].name" for x in range(4))


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        (UNNAMED, NAMED, [(f"{NAMES[0]} added", NAMES[1:])]),
        (NAMED, UNNAMED, [(f"{NAMES[0]} removed", NAMES[1:])]),
        (UNNAMED, NAMED.replace("[2, 0, 1]", "[2, 0, 7]"),
         [("thrusters[T2].pose [2, 0, 1] -> [2, 0, 7]", ()), (f"{NAMES[0]} added", NAMES[1:])]),
        ("thrusters:\n- {pose: [0, 0, 1]}\n", "thrusters:\n- {name: T0, rate: 6}\n",
         [("thrusters[T0] rate 6 added", ()), ("thrusters[old 0].pose [0, 0, 1] removed", ())]),
    ],
)  # fmt: skip
def test_items_of_a_list_match_if_only_one_version_has_names(lines, old, new, expected):
    assert lines(old, new) == expected
