from __future__ import annotations

from tests.viewer.conftest import _state_of_the_user  # noqa: F401  # a fixture
