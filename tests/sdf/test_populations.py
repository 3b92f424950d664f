"""Populations: the number, poses and names of their models."""

from __future__ import annotations

from math import hypot, pi

import pytest

from linkwright.sdf.populations import generate_models
from tests.sdf.worlds import examine_world_in, make_world_text, write_files

MODEL = '<model name="can"><pose>9 9 9 0 0 0</pose><link name="l"/></model>'
BOX = "<box><size>4 2 0.5</size></box><model_count>4</model_count>"


def find_places(inside: str, pose: str = "10 20 0 0 0 0") -> list[tuple[float, float, float]]:
    text = f'<population name="p"><pose>{pose}</pose>{MODEL}{inside}</population>'
    return [model.pose.pose.xyz for model in generate_models(make_world_text(text).populations[0])]


def distribution_text(kind: str, extra: str = "") -> str:
    return f"<distribution><type>{kind}</type>{extra}</distribution>"


def test_grid_is_centered_on_pose():
    grid = distribution_text("grid", "<rows>2</rows><cols>3</cols><step>1 0.5 0</step>")
    assert find_places(grid) == [(x, y, 0) for y in (19.75, 20.25) for x in (9, 10, 11)]


@pytest.mark.parametrize(
    ("kind", "expected"),
    [
        ("linear-x", [(8, 20, 0), (9, 20, 0), (10, 20, 0), (11, 20, 0)]),
        ("linear-y", [(10, 19, 0), (10, 19.5, 0), (10, 20, 0), (10, 20.5, 0)]),
        ("linear-z", [(10, 20, -0.25), (10, 20, -0.125), (10, 20, 0), (10, 20, 0.125)]),
    ],
)
def test_row_starts_at_side_of_box(kind, expected):
    assert find_places(BOX + distribution_text(kind)) == expected


@pytest.mark.parametrize("kind", ["random", "uniform"])
def test_random_models_are_inside_box_and_reproducible(kind):
    positions = find_places(BOX + distribution_text(kind))
    assert len(set(positions)) == 4
    assert all(8 <= x <= 12 and 19 <= y <= 21 and -0.25 <= z <= 0.25 for x, y, z in positions)
    assert find_places(BOX + distribution_text(kind)) == positions


@pytest.mark.parametrize("kind", ["random", "uniform"])
def test_random_models_are_inside_cylinder_above_base(kind):
    cylinder = "<cylinder><radius>2</radius><length>1</length></cylinder><model_count>50</model_count>"
    positions = find_places(cylinder + distribution_text(kind))
    assert len(set(positions)) == 50
    assert all(hypot(x - 10, y - 20) <= 2 and 0 <= z <= 1 for x, y, z in positions)


def test_box_rotates_about_corner_like_gazebo():
    (first, second, *_) = find_places(BOX + distribution_text("linear-x"), f"0 0 0 0 0 {pi / 2}")
    assert (second[0] - first[0], second[1] - first[1]) == pytest.approx((0, 1))


@pytest.mark.parametrize(
    "inside",
    [distribution_text("random"), f"{BOX}{distribution_text('grid', '<rows>0</rows>')}", distribution_text("linear-x")],
)
def test_population_without_distribution_is_empty(inside):
    assert find_places(inside) == []


def test_population_can_include_models_and_names_them(tmp_path):
    write_files(tmp_path, {"can/model.sdf": '<sdf version="1.6"><model name="can"><link name="l"/></model></sdf>'})
    model = '<model name="sip"><include><uri>model://can</uri></include></model>'
    reading = examine_world_in(
        tmp_path, f'<population name="p">{model}{BOX}</population>', GAZEBO_MODEL_PATH=str(tmp_path)
    )
    assert reading.diagnostics == ()
    assert reading.sdf is not None
    clones = reading.sdf.worlds[0].models
    assert [clone.name for clone in clones] == [f"sip_clone_{index}" for index in range(4)]
    assert all(clone.models[0].links for clone in clones)
