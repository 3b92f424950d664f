"""The name filters that select what a bridge forwards."""

from __future__ import annotations

import pytest

from linkwright.bridge.filters import NameFilter
from linkwright.diagnostics import LinkwrightError


@pytest.mark.parametrize(
    ("allowed", "denied", "matching_names", "blocked"),
    [
        ((), (), ["/a", "/a/b"], []),
        (("/a",), (), ["/a", "/a/b/c"], ["/ab", "/b", "/b/a"]),
        (("/",), (), ["/a", "/a/b"], []),
        (("/*/scan",), (), ["/r1/scan", "/r2/scan/raw"], ["/scan", "/a/b/scan"]),
        (("/robot*",), ("/robot2",), ["/robot1/tf", "/robot/tf"], ["/robot2/tf", "/robot2"]),
        ((), ("/rosout", "/parameter_events"), ["/tf"], ["/rosout", "/parameter_events"]),
        (("/a",), ("/a/b",), ["/a/_action/status", "/a/c/_action/send_goal"], ["/a/b/_action/status"]),
        (("/*",), (), ["/a", "/a/b/c"], []),
    ],
)
def test_name_filter_matches_allowed_names_and_names_below_them(allowed, denied, matching_names, blocked):
    name_filter = NameFilter(allowed, denied)
    assert [name for name in (*matching_names, *blocked) if name_filter.passes(name)] == matching_names


@pytest.mark.parametrize("pattern", ["", "scan", "/a/", "//", "/a b", "/a.*", "/[ab]"])
def test_malformed_pattern_is_rejected(pattern):
    for names in (((pattern,), ()), ((), (pattern,))):
        with pytest.raises(LinkwrightError) as raised:
            NameFilter(*names)
        assert [diagnostic.code for diagnostic in raised.value.diagnostics] == ["CLI453"]
