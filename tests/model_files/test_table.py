"""The table of models.

Entries have all facts for the download, and checksums for each file.
"""

from __future__ import annotations

import re

import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.model_files import model_entry, model_table


@pytest.mark.parametrize("entry", model_table().values(), ids=list(model_table()))
def test_table_entries_have_address_license_and_checksums(entry):
    assert entry.kind in ("speech", "vision")
    assert entry.address.startswith("https://")
    assert entry.license == "Apache-2.0"
    assert entry.sha256 or entry.files
    assert bool(entry.folder) == bool(entry.files)
    for checksum in (entry.sha256, *entry.files.values()):
        assert checksum is None or re.fullmatch("[0-9a-f]{64}", checksum)
    for name in entry.files:
        assert ".." not in name.split("/")
        assert not name.startswith("/")


def test_unknown_model_suggests_similar_names():
    with pytest.raises(LinkwrightError) as error:
        model_entry("vosk-cn")
    (diagnostic,) = error.value.diagnostics
    assert diagnostic.code == "MODEL101"
    assert "vosk-en" in str(diagnostic.hint)
    assert "vosk-zh" in str(diagnostic.hint)
