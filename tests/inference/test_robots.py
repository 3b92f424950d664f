"""Inference for small robots: cases in Markdown, each with a robot and the result."""

from __future__ import annotations

from pathlib import Path

import pytest

from linkwright.descriptions import examine
from linkwright.inertia import MeshLibrary
from linkwright.inference import Inference, infer
from linkwright.inference.completion import complete_description
from linkwright.packages import PackageFinder
from linkwright.xmltree import Document, write
from tests.markdown import read_sections

PAGE = Path(__file__).parent / "robots.md"
CASES = [(title, blocks[0].text, blocks[1].text) for title, blocks in read_sections(PAGE)]


def read_and_inferred(text: str) -> tuple[Document, Inference]:
    """Return a description, and the inference about its robot."""
    description = examine(text)
    assert description.robot is not None
    meshes = MeshLibrary(PackageFinder(start=PAGE.parent), PAGE.parent)
    return description.document, infer(description.robot, meshes)


def inferred(text: str) -> Inference:
    """Return the inference about a robot."""
    return read_and_inferred(text)[1]


def summary_of(inference: Inference) -> str:
    """Return an inference in the form of the page."""
    drive = inference.drive
    lines = ["none"]
    if drive is not None:
        lines = [f"{drive.kind} {drive.separation:.3g} {2 * drive.radius:.3g}"]
    lines[0] += f" ground {round(inference.ground_z, 4) + 0.0:g} base {inference.base_frame}"
    if drive is not None and drive.left:
        left, right = (" ".join(wheel.joint for wheel in side) for side in (drive.left, drive.right))
        lines.append(f"left {left}; right {right}")
    lines += [f"casters {' '.join(inference.casters)}"] if inference.casters else []
    lines += [f"held {' '.join(inference.held_joints)}"] if inference.held_joints else []
    lines += [
        f"{diagnostic.code} {diagnostic.severity.value} {diagnostic.message}" for diagnostic in inference.diagnostics
    ]
    return "".join(f"{line}\n" for line in lines)


@pytest.mark.parametrize(("title", "robot", "expected"), CASES, ids=[case[0] for case in CASES])
def test_inference_matches_markdown_case(title, robot, expected):
    assert summary_of(inferred(robot)) == expected


@pytest.mark.parametrize("robot", [case[1] for case in CASES], ids=[case[0] for case in CASES])
def test_completed_robot_needs_no_inference(robot):
    document, inference = read_and_inferred(robot)
    before = write(document)
    text = write(complete_description(document, inference))
    assert write(document) == before, "the inference does not change the document"
    completed = examine(text)
    assert not completed.diagnostics
    assert {diagnostic.code for diagnostic in inferred(text).diagnostics} <= {
        "DRIVE201",
        "DRIVE202",
        "DRIVE203",
        "DRIVE205",
    }


@pytest.mark.parametrize("robot", [case[1] for case in CASES], ids=[case[0] for case in CASES])
def test_inferred_elements_have_source_locations(robot):
    document, inference = read_and_inferred(robot)
    assert all(diagnostic.span is not None and diagnostic.source is not None for diagnostic in inference.diagnostics)
    assert all(element.source is not None for element in complete_description(document, inference).root.walk())


@pytest.mark.parametrize(
    "parameters", ["", "<parameters>/nowhere.yaml</parameters>", "<parameters>{file}</parameters>"]
)
def test_controllers_of_ros1_work_only_with_parameter_file(parameters):
    element = parameters.format(file=PAGE)
    document, inference = read_and_inferred(
        '<robot name="r"><link name="base_link"/><link name="a"/><joint name="j" type="revolute"><parent '
        'link="base_link"/><child link="a"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>'
        f'<gazebo><plugin name="c" filename="libgazebo_ros_control.so">{element}</plugin><static>1</static></gazebo>'
        "</robot>"
    )
    text = write(complete_description(document, inference))
    has_file = "{file}" in parameters
    assert ("libgazebo_ros_control.so" in text) is has_file
    assert "<static>1</static>" in text
    assert ("DRIVE205" in {diagnostic.code for diagnostic in inference.diagnostics}) is not has_file
