"""Features that are created on demand, when the first of their messages arrives."""

from __future__ import annotations

from importlib import import_module

import pytest

from linkwright.loading.extensions import extensions
from linkwright.page.protocol.message import get_import_path
from linkwright.panels.page_feature import ON_DEMAND_ENTRY_POINT_GROUP
from tests.imports import loaded_by

DECLARED = [feature for entry in extensions(ON_DEMAND_ENTRY_POINT_GROUP).values() for feature in entry.load().ON_DEMAND]
PROTOCOL = "linkwright.page.protocol.navigation"
PROGRAM = f"""
from linkwright.page.protocol.message import BadMessageError, decode, define_later
from linkwright.page.protocol.message import Received
define_later("{PROTOCOL}:WatchNavigation")
"""
SUCCESS_CHECK = """
assert decode('{"type":"watch_navigation","open":true}').open
"""
FAILURE_CHECK = """
try:
    decode('{"type":"watch_navigation"}')
except BadMessageError as error:
    assert "open" in str(error)
"""


@pytest.mark.parametrize("address", [message for feature in DECLARED for message in feature.receives])
def test_message_address_matches_class(address: str):
    module, _, name = address.partition(":")
    assert get_import_path(getattr(import_module(module), name)) == address


@pytest.mark.parametrize(("sent", "defined"), [("", False), (SUCCESS_CHECK, True), (FAILURE_CHECK, True)])
def test_first_message_imports_its_class(sent: str, defined: bool):
    assert (PROTOCOL in loaded_by(f"exec({PROGRAM + sent!r})")) is defined
