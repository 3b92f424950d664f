from __future__ import annotations

import json

import pytest

from linkwright.wire.zenoh.session import configuration
from linkwright.wire.zenoh.settings import OVERRIDES, read_router_settings, read_settings

DROPPING = "transport/link/tx/queue/congestion_control/drop"


def dropping(settings):
    return json.loads(configuration(settings).get_json(DROPPING))


def test_sessions_wait_for_a_busy_machine_before_they_drop_and_routers_do_not():
    assert dropping(read_settings({})) == {"wait_before_drop": 50_000, "max_wait_before_drop_fragments": 200_000}
    assert dropping(read_router_settings({})) == {"wait_before_drop": 1_000, "max_wait_before_drop_fragments": 50_000}


@pytest.mark.parametrize("wait", [0, 1_000_000])
def test_how_long_they_wait_can_be_said(wait):
    settings = read_settings({OVERRIDES: f"{DROPPING}/wait_before_drop={wait}"})
    assert dropping(settings)["wait_before_drop"] == wait
