"""The limit of a link's speed: kept along the executed splines, and slow only where it must be."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from linkwright.planning.link_speed import LinkSpeedLimits
from tests.planning.arms import arm
from tests.planning.test_planner import LEFT, RIGHT, joint_goal, plan, request

pytestmark = pytest.mark.extra("arm")


def speeds(trajectory, link: str) -> np.ndarray:
    """Return the speeds of a link by differences of its positions along the executed splines."""
    times = np.linspace(0.0, trajectory.duration, 3000)
    positions, points = arm().positions(**LEFT), []
    for configuration in trajectory.interpolate(times)[0]:
        positions[arm().indexes] = configuration
        arm().model.move(positions)
        points.append(arm().model.link_pose(link)[:3])
    return np.linalg.norm(np.diff(points, axis=0), axis=1) / np.diff(times)


@pytest.mark.parametrize("link", ["tool", "forearm"])
def test_link_keeps_its_speed_and_uses_it(link: str) -> None:
    limited = plan(replace(request(joint_goal(**RIGHT)), max_link_speeds={link: 0.2}))
    assert speeds(plan(request(joint_goal(**RIGHT))), link).max() > 0.3
    fastest = speeds(limited, link)
    assert fastest.max() <= 0.2
    assert np.median(fastest) > 0.19


def test_ratio_of_pan_is_that_of_its_lever_arm() -> None:
    positions = arm().positions(**LEFT)
    limits = LinkSpeedLimits(arm().model, arm().group, positions, {"tool": 0.5})
    rates = np.zeros((1, 6))
    rates[0, 0] = 2.0
    arm().model.move(positions)
    tool = arm().model.link_pose("tool")
    assert limits.ratios(positions[arm().indexes][None], rates)[0] == pytest.approx(4.0 * np.hypot(tool[0], tool[1]))
