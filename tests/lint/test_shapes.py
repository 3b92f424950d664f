"""The rules about masses, shapes, meshes and materials.

They check real robots and extreme numbers.
"""

from __future__ import annotations

import random
import re

import pytest

from linkwright.cli import main
from linkwright.lint.engine import examine
from linkwright.lint.settings import Settings
from tests.corpora import MODELS
from tests.lint.cases import load_cases
from tests.places import PACKAGE
from tests.work import lines_run

RULES = ("LW3", "LW4", "LW5")
FOUND_PACKAGES = {
    # Steering links with a mass and a tensor of zero; a box of 1 kg in a cubic meter.
    "gz_ros2_control/gz_ros2_control_demos/urdf/test_ackermann_drive.xacro.urdf": {"LW310", "LW321"},
    "gz_ros2_control/gz_ros2_control_demos/urdf/test_diff_drive.xacro.urdf": {"LW321"},
    "gz_ros2_control/gz_ros2_control_demos/urdf/test_tricycle_drive.xacro.urdf": {"LW321", "LW324"},
    # A dock of 15 kg with the inertia of one of 15 g.
    "husarion_components_description/urdf/wibotic_station.urdf.xacro": {"LW325"},
    # One link's identified tensor breaks the triangle inequality by 9 %.
    "franka_description/robots/fer/fer.urdf.xacro": {"LW314"},
    # Our robot: a head without mass, and missing textures.
    "humanoid_description/urdf/humanoid.urdf.xacro": {"LW301"},
    "cell_description/urdf/cell.urdf.xacro": {"LW503"},
    "plain_description/urdf/shapes.urdf": {"LW503"},
    # Every link uses "default_inertial", so the findings have one cause.
    "urdf_tutorial@ros2/urdf/08-macroed.urdf.xacro": {"LW315"},
}
"""Expected warnings about robots besides missing meshes: each is a mistake of the description."""


@pytest.mark.parametrize("model", MODELS, ids=str)
def test_corpus_robots_have_only_expected_warnings(model):
    settings = Settings(select=RULES, ignore=("LW411", "LW424", "LW507", "LW508"))
    findings = examine(model.path, arguments=model.arguments, packages=model.packages, settings=settings).diagnostics
    warned = {
        finding.code for finding in findings if finding.severity.value != "info" and finding.code.startswith(RULES)
    }
    assert warned == FOUND_PACKAGES.get(model.data["entry"], set())


@pytest.mark.parametrize("path", sorted(PACKAGE.glob("urdf/mbot_*")), ids=lambda path: path.name)
def test_mbot_has_no_shape_findings(path):
    findings = examine(path, settings=Settings(select=RULES)).diagnostics
    assert [finding.message for finding in findings if finding.code.startswith(RULES)] == []


NUMBER_PATTERN = re.compile(r'(?<=["\s])-?\d+(?:\.\d+)?(?:e-?\d+)?(?=["\s])')
EXTREME_NUMBERS = (
    "0",
    "-1",
    "1e308",
    "-1e308",
    "1e-308",
    "5e-324",
    "1e160",
    "1e-160",
    "1e77",
    "1e20",
    "-0",
    "0.5",
    "3",
)
PAGES = ("inertia", "geometry", "meshes", "materials")


@pytest.mark.parametrize("seed", range(60))
def test_shape_rules_survive_extreme_numbers(seed, tmp_path, capsys):
    rng = random.Random(seed)
    case = rng.choice([case for case in load_cases() if case.page in PAGES])
    for name, text in case.files.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text, encoding="utf-8")
    path = tmp_path / next(iter(case.files))
    share = rng.choice((0.05, 0.2, 0.6))
    text = path.read_text(encoding="utf-8")
    path.write_text(
        NUMBER_PATTERN.sub(lambda match: rng.choice(EXTREME_NUMBERS) if rng.random() < share else match[0], text)
    )
    examine(path, settings=Settings(select=RULES))
    assert main(["inertia", str(path), "--format", rng.choice(("text", "json"))]) in (0, 1)
    capsys.readouterr()


def test_effort_is_linear_in_links_of_fixed_body(tmp_path):
    def work(count):
        link = (
            '<link name="l{0}"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>'
            '</inertial><visual><geometry><box size="1 1 1"/></geometry></visual></link>'
            '<joint name="j{0}" type="fixed"><parent link="base"/><child link="l{0}"/></joint>'
        )
        path = tmp_path / f"r{count}.urdf"
        path.write_text(f'<robot name="r"><link name="base"/>{"".join(map(link.format, range(count)))}</robot>')
        return lines_run(lambda: examine(path, settings=Settings()))

    work(300)
    assert work(900) < 3.5 * work(300)
