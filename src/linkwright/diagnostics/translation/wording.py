"""The catalogues: gettext's, one for each language other than English, beside this module."""

from __future__ import annotations

import os
from functools import cache

from linkwright.loading.lean_typing import TYPE_CHECKING

if TYPE_CHECKING:
    from gettext import NullTranslations


@cache
def wording(language: str) -> NullTranslations:
    """Return the catalogue of a language, read once; an empty one in a checkout without a compiled one."""
    from gettext import GNUTranslations, NullTranslations  # English needs none of it

    try:
        with open(f"{os.path.dirname(__file__)}/{language}.mo", "rb") as file:  # noqa: PTH120, PTH123 - pathlib is slow to import
            return GNUTranslations(file)
    except FileNotFoundError:
        return NullTranslations()
