"""Extensions of other packages that cannot be imported."""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import Any

import pytest

from linkwright.diagnostics import LinkwrightError, phrase
from linkwright.diagnostics.extension_errors import load_extension
from linkwright.loading.extensions import EntryPoint

BROKEN = EntryPoint("theirs", "their_broken_module:Theirs", "their-package")


@pytest.fixture
def write_broken_module(tmp_path: Any, monkeypatch: pytest.MonkeyPatch) -> Callable[[str], None]:
    """Return a function that writes the module of the entry point."""

    def write(text: str) -> None:
        (tmp_path / "their_broken_module.py").write_text(text)
        monkeypatch.syspath_prepend(tmp_path)
        monkeypatch.delitem(sys.modules, "their_broken_module", raising=False)

    return write


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("import no_such_library", "No module named 'no_such_library'"),
        ("1 / 0", "division by zero"),
        ("", "has no attribute 'Theirs'"),
    ],
)
def test_the_error_names_the_package_and_the_problem(
    write_broken_module: Callable[[str], None], text: str, problem: str
) -> None:
    write_broken_module(text)
    with pytest.raises(LinkwrightError) as raised:
        load_extension(BROKEN, "VISION113", phrase("the detector '{name}' cannot be imported", name="theirs"))
    (diagnostic,) = raised.value.diagnostics
    assert (diagnostic.code, diagnostic.message) == ("VISION113", "the detector 'theirs' cannot be imported")
    assert diagnostic.hint is not None
    assert diagnostic.hint.startswith("fix the Python package 'their-package', whose import fails: ")
    assert problem in diagnostic.hint


def test_an_error_with_a_finding_of_its_own_is_kept(write_broken_module: Callable[[str], None]) -> None:
    write_broken_module(
        "from linkwright.diagnostics import Diagnostic, LinkwrightError\n"
        "raise LinkwrightError(Diagnostic('OTHER101', 'no camera'))"
    )
    with pytest.raises(LinkwrightError) as raised:
        load_extension(BROKEN, "VISION113", phrase("the detector '{name}' cannot be imported", name="theirs"))
    assert [diagnostic.code for diagnostic in raised.value.diagnostics] == ["OTHER101"]
