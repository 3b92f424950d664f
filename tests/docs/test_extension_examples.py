"""The example classes for user packages: hardware, laser filters, detectors, substitutions."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest

from linkwright.control.hardware.description import ComponentDescription, HardwareDescription, InterfaceDescription
from linkwright.launch.model.markup.expose import substitution_parse_methods
from linkwright.perception.scans.scan import Scan
from linkwright.standins import activate
from linkwright.vision.detector import Limits
from linkwright.vision.detectors.options import DetectorOptions
from tests.docs.pages import DOCS, read_blocks

LANGUAGES = pytest.mark.parametrize("docs", [DOCS, DOCS / "zh"], ids=["en", "zh"])


@pytest.fixture
def load_shown_class(monkeypatch: pytest.MonkeyPatch) -> Callable[[Path, str], Any]:
    """Return a function that returns a class from a page."""

    def find(page: Path, name: str) -> Any:
        (text,) = (block.text for block in read_blocks(page) if f"class {name}(" in block.text)
        module = ModuleType("shown")
        monkeypatch.setitem(sys.modules, "shown", module)  # dataclasses look up the names of types there
        exec(compile(text, str(page), "exec"), module.__dict__)
        return getattr(module, name)

    return find


@LANGUAGES
def test_the_hardware_approaches_its_commands(load_shown_class: Callable[[Path, str], Any], docs: Path) -> None:
    position = (InterfaceDescription("position"),)
    joint = ComponentDescription("shoulder", "joint", position, position)
    parameters = {"time_constant": "0.5"}
    description = HardwareDescription("arm", "system", "my_hardware/Lag", parameters=parameters, joints=(joint,))
    hardware = load_shown_class(docs / "control.md", "Lag")(description, None)
    hardware.on_configure()
    hardware.read(0, 0.1)
    assert hardware.states[0].value == 0.0
    hardware.commands[0].value = 1.0
    hardware.read(0, 0.1)
    assert hardware.states[0].value == pytest.approx(0.2)


@LANGUAGES
def test_the_filter_keeps_every_second_range(load_shown_class: Callable[[Path, str], Any], docs: Path) -> None:
    ranges = np.array([1.0, 2.0, 3.0, 4.0], np.float32)
    scan = Scan(ranges, np.zeros(0, np.float32), 0.0, 0.3, 0.1, 0.0, 9.0, 0.0, 0, "laser")
    scan_copy = load_shown_class(docs / "small-nodes.md", "EveryNth")(n=2).apply(scan, None)
    np.testing.assert_array_equal(scan_copy.ranges, [1.0, np.nan, 3.0, np.nan])


@LANGUAGES
def test_the_detector_finds_the_box_of_the_bright_pixels(
    load_shown_class: Callable[[Path, str], Any], docs: Path
) -> None:
    detector = load_shown_class(docs / "vision.md", "Bright")(DetectorOptions())
    image = np.zeros((50, 100, 3), np.uint8)
    assert len(detector.detect(image, Limits())) == 0
    image[10:20, 30:60] = 255
    detections = detector.detect(image, Limits())
    assert (detections.boxes.tolist(), detections.name(0)) == ([[30, 10, 60, 20]], "bright")


@LANGUAGES
def test_the_substitution_converts_to_capital_letters(
    load_shown_class: Callable[[Path, str], Any], docs: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    activate()
    from launch.substitutions import TextSubstitution

    from launch import LaunchContext

    monkeypatch.setitem(substitution_parse_methods, "upper", None)  # the name is removed again after the test
    del substitution_parse_methods["upper"]
    substitution = load_shown_class(docs / "launch.md", "Upper")([TextSubstitution(text="left")])
    assert substitution.perform(LaunchContext()) == "LEFT"
    assert "upper" in substitution_parse_methods
