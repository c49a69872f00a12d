from __future__ import annotations

import pytest

from smd.acting.performance import Performance
from tests.naive.puppet import performance as _performance


@pytest.fixture(scope="session")
def performance() -> Performance:
    """Two puppets that wave for two seconds, with phrases, pauses and a lost stretch."""
    return _performance(seconds=2.0, rate_hz=24.0)
