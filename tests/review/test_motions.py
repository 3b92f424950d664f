"""Parameter files with motions that clients start by name, and of any node, in a review."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking

PATH = "arm/config/motions.yaml"
MOTION = """    {name}:
      joints: [head_1, head_2]
      points:
      - positions: [0.1, {angle}]
        time_from_start: 0.5
"""
HEADS = ["play_motion:\n  motions:\n", "/play_motion2:\n ros__parameters:\n  motions:\n", "poses:\n  motions:\n"]


@pytest.mark.parametrize("head", HEADS)
def test_lost_and_renamed_motions_are_names_of_clients(repository, compare, head):
    down, up, out = (MOTION.format(name=name, angle=angle) for name, angle in (("down", 1), ("up", 2), ("out", 3)))
    repository.commit({"arm/package.xml": PACKAGE_XML, PATH: head + down + up + out})
    repository.write({PATH: head + down.replace("down", "head_down") + up.replace("0.5", "0.7")})
    reasons = [str(change.reason) for _, change in compare(repository).breaking_changes]
    expected = [f"programs that use the name '{name}' do not find it" for name in ("down", "out")]
    assert sorted(reasons) == ([] if head == HEADS[2] else expected)


@pytest.mark.parametrize(("node", "is_lost"), [("/**", True), ("filter", False)])
@pytest.mark.parametrize("group", ["  overlap:\n    enabled: true\n", ""])
def test_single_parameters_of_any_node_are_lost_like_groups(repository, compare, node, is_lost, group):
    start = f"{node}:\n ros__parameters:\n"
    repository.commit({PATH: f"{start}{group}  height: 2\n  rate: 10\n"})
    repository.write({PATH: f"{start}  rate: 10\n"})
    result = compare(repository)
    assert any("height" in line for line in breaking(result)) == (is_lost and bool(group))
    if is_lost and group:
        reasons = {str(change.reason) for _, change in result.breaking_changes}
        assert reasons == {"the nodes that load the file start without these parameters"}
