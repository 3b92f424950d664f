"""Language-dependent data covers all languages of the catalog."""

from __future__ import annotations

import pytest

from linkwright.cli import voice
from linkwright.diagnostics.translation import LANGUAGES
from linkwright.model_files import model_entry
from linkwright.speech.commands.quantities import GRAMMAR_VALUES
from linkwright.speech.engines.vosk_engine import MODELS
from linkwright.vision.places import object_requests


@pytest.mark.parametrize("table", [voice._TEST_PHRASES, object_requests._NUMBER_WORDS, *GRAMMAR_VALUES.values()])
def test_tables_cover_languages(table) -> None:
    assert tuple(table) == LANGUAGES


@pytest.mark.parametrize("language", LANGUAGES)
def test_vosk_has_model_for_each_language(language) -> None:
    assert model_entry(MODELS[language])
