"""Invalid worlds are simulated as far as possible; each omission is reported once."""

from __future__ import annotations

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from linkwright.diagnostics import LinkwrightError
from linkwright.packages import PackageFinder
from linkwright.sdf.reader import read
from linkwright.sdf.resources import ResourceFinder
from linkwright.sdf.text import parse_as_gazebo
from linkwright.simulation.simulation import Simulation
from tests.simulation.worlds import GROUND

BOX = "<geometry><box><size>1 1 1</size></box></geometry>"
LINK = f'<link name="link"><collision name="c">{BOX}</collision></link>'
CRATE = f'<model name="crate"><pose>0 0 2 0 0 0</pose>{LINK}</model>'
CIRCLE = '<link name="a"><pose relative_to="b"/></link><link name="b"><pose relative_to="a"/></link>'


def start_simulation(*parts: str, version: str = "1.9") -> Simulation:
    """Simulate a world, valid or not, for ten milliseconds."""
    text = f'<sdf version="{version}"><world name="test">{GROUND}{"".join(parts)}</world></sdf>'
    document, _ = parse_as_gazebo(text.encode(), "test.world")
    sdf = read(document).sdf
    assert sdf is not None
    simulation = Simulation(sdf.worlds[0], ResourceFinder(PackageFinder(), {}))
    simulation.advance(10_000_000)
    return simulation


def diagnostic_codes(simulation: Simulation) -> list[str]:
    return [diagnostic.code for diagnostic in simulation.scene.diagnostics]


@pytest.mark.parametrize(
    "invalid",
    [
        f'<model name="m">{CIRCLE}</model>',
        '<model name="m"><pose relative_to="nowhere"/><link name="a"/></model>',
        '<model name="m" placement_frame="nowhere"><link name="a"/></model>',
    ],
)
def test_model_without_valid_pose_is_omitted(invalid):
    simulation = start_simulation(CRATE, invalid)
    assert list(simulation.scene.models) == ["ground", "crate"]
    assert diagnostic_codes(simulation) == ["SIM116"]


def test_model_rejected_by_mujoco_is_omitted():
    points = "".join(f"<point>{x} {y}</point>" for x, y in ((0, 0), ("1e200", 0), ("1e200", "1e200")))
    shape = f"<geometry><polyline>{points}<height>1</height></polyline></geometry>"
    simulation = start_simulation(
        CRATE, f'<model name="m"><link name="l"><collision name="c">{shape}</collision></link></model>'
    )
    assert list(simulation.scene.models) == ["ground", "crate"]
    assert diagnostic_codes(simulation) == ["SIM117"]


def test_collision_with_unknown_frame_is_placed_in_its_link():
    collision = f'<collision name="c"><pose relative_to="gone">0 0 0.25 0 0 0</pose>{BOX}</collision>'
    simulation = start_simulation(f'<model name="m"><static>true</static><link name="l">{collision}</link></model>')
    model = simulation.model
    assert model.geom("m::l::c#collision").pos.tolist() == [0, 0, 0.25]


def test_tiny_link_moves():
    tensor = "<ixx>1e-20</ixx><iyy>1e-20</iyy><izz>1e-20</izz>"
    inertial = f"<inertial><mass>1e-5</mass><inertia>{tensor}</inertia></inertial>"
    simulation = start_simulation(f'<model name="m"><pose>0 0 5 0 0 0</pose><link name="l">{inertial}</link></model>')
    assert diagnostic_codes(simulation) == []
    simulation.advance(100_000_000)
    assert simulation.model_pose("m")[2] < 5.0


def test_zero_step_size_falls_back_to_one_millisecond():
    simulation = start_simulation(CRATE, "<physics type='ode'><max_step_size>0</max_step_size></physics>")
    assert simulation.step == 1_000_000
    assert diagnostic_codes(simulation) == ["SIM106"]


def test_collisions_and_joints_with_duplicate_names_are_kept():
    links = "".join(f'<link name="{name}"><collision name="c">{BOX}</collision></link>' for name in "abd")
    joints = "".join(
        f'<joint name="j" type="revolute"><parent>a</parent><child>{child}</child><axis/></joint>' for child in "bd"
    )
    link_with_duplicates = (
        f'<link name="e"><collision name="c">{BOX}</collision><collision name="c">{BOX}</collision></link>'
    )
    simulation = start_simulation(
        f'<model name="m"><pose>0 0 3 0 0 0</pose>{links}{link_with_duplicates}{joints}</model>'
    )
    assert simulation.model.body("m::e").geomnum == 2
    assert sorted(simulation.scene.joints) == ["m::j", "m::j~"]


def test_zero_axis_defaults_to_z_and_self_joint_is_omitted():
    ends = '<link name="a"/><link name="b"/>'
    first = '<joint name="j" type="revolute"><parent>a</parent><child>b</child><axis><xyz>0 0 0</xyz></axis></joint>'
    second = '<joint name="k" type="revolute"><parent>a</parent><child>a</child><axis/></joint>'
    simulation = start_simulation(f'<model name="m"><pose>0 0 3 0 0 0</pose>{ends}{first}{second}</model>')
    assert list(simulation.scene.joints) == ["m::j"]
    assert simulation.model.joint("m::j").axis.tolist() == [0, 0, 1]


def test_nested_link_names_of_old_files_are_kept():
    joint = '<joint name="laser::j" type="revolute"><parent>base</parent><child>laser::link</child><axis/></joint>'
    links = '<link name="base"/><link name="laser::link"><pose>0 0 1 0 0 0</pose></link>'
    simulation = start_simulation(f'<model name="m"><pose>0 0 3 0 0 0</pose>{links}{joint}</model>', version="1.6")
    assert simulation.joint_state("m::laser::j")[0] == pytest.approx(0, abs=1e-6)
    assert simulation.link_pose("m::laser::link")[2] == pytest.approx(4, abs=1e-2)


_NUMBERS = ["0", "-1", "nan", "inf", "1e300", "-1e300", "1e-300", "", "x", "1 2 3", "1e9"]
_PARTS = """
<pose>{}</pose>
<pose>0 0 {} 0 0 0</pose>
<static>{}</static>
<link name="b"><inertial><mass>{}</mass><inertia><ixx>{}</ixx></inertia></inertial></link>
<link name="a"/>
<link name="c"><collision name="c"><geometry><box><size>{} 1 {}</size></box></geometry></collision></link>
<link name="d"><collision name="c"><geometry><sphere><radius>{}</radius></sphere></geometry></collision></link>
<visual name="v"><geometry><polyline><point>{} 0</point><point>1 {}</point></polyline></geometry></visual>
<visual name="w"><geometry><cone><radius>{}</radius><length>1</length></cone></geometry></visual>
<joint name="j" type="revolute"><parent>a</parent><child>b</child><axis><xyz>0 {} 1</xyz></axis></joint>
<joint name="i" type="prismatic"><parent>a</parent><child>d</child><axis><limit><lower>{}</lower></limit></axis></joint>
<joint name="k" type="screw"><parent>b</parent><child>c</child><thread_pitch>{}</thread_pitch><axis/></joint>
<joint name="l" type="ball"><parent>c</parent><child>a</child></joint>
<frame name="g" attached_to="{}"/>
<model name="m"><link name="a"/></model>
""".strip().splitlines()


@st.composite
def invalid_models(draw: st.DrawFn) -> str:
    """Draw a model of elements that mostly fit together, with values that mostly do not."""
    parts = draw(st.lists(st.sampled_from(_PARTS), min_size=1, max_size=6))
    elements = [part.format(*(draw(st.sampled_from(_NUMBERS)) for _ in range(part.count("{}")))) for part in parts]
    elements = [
        f'<link name="{index}">{part}</link>' if "<visual" in part else part for index, part in enumerate(elements)
    ]
    return f'<model name="m">{"".join(elements)}</model>'


@settings(max_examples=60, deadline=None, derandomize=True, suppress_health_check=[HealthCheck.too_slow])
@given(invalid_models())
def test_arbitrary_model_is_simulated_or_reported(invalid: str):
    codes: set[str] = set()
    try:
        assert "crate" in start_simulation(CRATE, invalid).scene.models
    except LinkwrightError as error:
        codes = {diagnostic.code for diagnostic in error.diagnostics}
    assert codes <= {"SIM120", "SIM121"}
