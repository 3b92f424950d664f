"""The lines of a review about descriptions of parameters for generate_parameter_library."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

PATH = "arm/src/arm_parameters.yaml"
DESCRIPTION = """arm:
  rate: {
    type: double,
    default_value: 10.0,
    description: "Rate of the loop",
    validation: {bounds<>: [0.0, 100.0]}
  }
  mode:
    type: string
    default_value: "fast"
    read_only: true
    validation:
      one_of<>: [["fast", "slow"]]
  depth: {type: int, default_value: 3, validation: {gt_eq<>: [1]}}
  gains:
    __map_joints:
      p: {type: double, default_value: 1.0}
"""
SETTINGS = """arm:
  ros__parameters:
    depth: 5
    gains:
      shoulder:
        p: 2.0
"""
OTHER_SETTINGS = "leg:\n  ros__parameters:\n    mode: slow\n"
FILES = {
    "arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"),
    "arm/CMakeLists.txt": "project(arm)\ngenerate_parameter_library(arm_parameters src/arm_parameters.yaml)\n",
    PATH: DESCRIPTION,
    "arm/config/arm.yaml": SETTINGS,
    "arm/config/leg.yaml": OTHER_SETTINGS,
}


@pytest.mark.parametrize(
    ("old", "new", "expected", "is_breaking"),
    [
        ("10.0", "20.0", "parameter 'rate': default 10.0 -> 20.0", False),
        ("default_value: 10.0,", "", "parameter 'rate': default 10.0 -> -", True),
        ("type: int", "type: double", "parameter 'depth': type int -> double", True),
        ("100.0]", "50.0]", "parameter 'rate': bounds [0.0, 100.0] -> [0.0, 50.0]", True),
        ("100.0]", "200.0]", "parameter 'rate': bounds [0.0, 100.0] -> [0.0, 200.0]", False),
        ("gt_eq<>: [1]", "gt_eq<>: [0]", "parameter 'depth': gt_eq [1] -> [0]", False),
        ("gt_eq<>: [1]", "gt_eq<>: [2]", "parameter 'depth': gt_eq [1] -> [2]", True),
        (', validation: {gt_eq<>: [1]}', "", "parameter 'depth': gt_eq [1] -> -", False),
        ('"slow"]', '"slow", "idle"]', "parameter 'mode': one_of [fast, slow] -> [fast, slow, idle]", False),
        ('"slow"]', '"idle"]', "parameter 'mode': one_of [fast, slow] -> [fast, idle]", True),
        ("    read_only: true\n", "", "parameter 'mode': read-only yes -> no", False),
        ("value: 3,", "value: 3, read_only: true,", "parameter 'depth': read-only no -> yes", True),
        ("of the loop", "of control", "parameter 'rate': description Rate of the loop -> Rate of control", False),
        ("  gains:", "  tilt: {type: bool, default_value: false}\n  gains:", "parameters added: 'tilt' (false)", False),
        ("  gains:", "  tilt: {type: bool}\n  gains:", "parameters added: 'tilt' (bool)", True),
    ],
)  # fmt: skip
def test_parameters_are_compared_with_their_rules(repository, compare, old, new, expected, is_breaking):
    repository.commit(FILES)
    assert DESCRIPTION.count(old) == 1
    repository.write({PATH: DESCRIPTION.replace(old, new)})
    result = compare(repository)
    assert sentences(subject(result, PATH)) == [expected]
    assert bool(breaking(result)) is is_breaking


def test_two_rules_that_allow_the_same_range_reject_nothing(repository, compare):
    repository.commit(FILES)
    repository.write({PATH: DESCRIPTION.replace("bounds<>: [0.0, 100.0]", "gt_eq<>: [0.0], lt_eq<>: [100.0]")})
    assert breaking(compare(repository)) == []


@pytest.mark.parametrize(
    ("lost", "reason"),
    [
        ("  depth: {type: int, default_value: 3, validation: {gt_eq<>: [1]}}\n",
         "'arm/config/arm.yaml' still sets 'depth', which has no effect"),
        ("  gains:\n    __map_joints:\n      p: {type: double, default_value: 1.0}\n",
         "'arm/config/arm.yaml' still sets 'gains.<joints>.p', which has no effect"),
        (DESCRIPTION[DESCRIPTION.index("  mode:") : DESCRIPTION.index("  depth:")],
         "values that launch files and parameter files give to 'mode' have no effect"),
    ],
)  # fmt: skip
def test_a_removed_parameter_is_named_with_the_file_that_sets_it_for_the_node(repository, compare, lost, reason):
    repository.commit(FILES)
    assert lost in DESCRIPTION
    repository.write({PATH: DESCRIPTION.replace(lost, "")})
    (change,) = subject(compare(repository), PATH).changes
    assert str(change.reason) == reason


def test_a_parameter_file_with_types_is_no_description(repository, compare):
    text = "arm:\n  left:\n    type: double\n    speed: 1.0\n"
    repository.commit({**FILES, PATH: text})
    repository.write({PATH: text.replace("1.0", "2.0")})
    assert sentences(subject(compare(repository), PATH)) == ["arm.left.speed 1.0 -> 2.0"]


def test_a_parameter_with_a_similar_name_is_renamed(repository, compare):
    repository.commit(FILES)
    repository.write({PATH: DESCRIPTION.replace("depth: {type: int", "depths: {type: int_array")})
    (change,) = subject(compare(repository), PATH).changes
    assert str(change.sentence) == "parameter 'depth' (3) renamed to 'depths' (3)"
    assert str(change.reason) == "'arm/config/arm.yaml' still sets 'depth', which has no effect"


@pytest.mark.parametrize("folder", ["include/parameters", None])
def test_no_program_reads_a_description_of_parameters_by_its_path(repository, compare, folder):
    build_file = (
        "project(arm)\ngenerate_parameter_library(p {}/arm.yaml)\ninstall(DIRECTORY include/ DESTINATION include)\n"
    )
    files = {"arm/package.xml": FILES["arm/package.xml"], "arm/include/arm.yaml": DESCRIPTION}
    repository.commit({**files, "arm/CMakeLists.txt": build_file.format("include")})
    if folder is not None:
        repository.write({f"arm/{folder}/arm.yaml": DESCRIPTION, "arm/CMakeLists.txt": build_file.format(folder)})
    else:
        repository.write({"arm/CMakeLists.txt": "project(arm)\n"})
    repository.write({"arm/include/arm.yaml": None})
    found = breaking(compare(repository))
    assert not [line for line in found if any(word in line for word in ("file removed", "moved from", "renamed"))]
