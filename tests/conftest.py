from __future__ import annotations

import os
from pathlib import Path

import pytest
from hypothesis import settings

# Before NumPy is loaded, here and in what tests start: small matrix products gain nothing from
# more threads, which wait for each other where a test runs on each core.
for _library in ("OPENBLAS", "OMP", "MKL", "VECLIB_MAXIMUM"):
    os.environ[f"{_library}_NUM_THREADS"] = "1"

SHARED_DATA = Path(os.environ.get("SMD_TEST_DATA", Path(__file__).parents[2] / "shared" / "data"))


# The same examples in every run: the suite says the same of the same code.
settings.register_profile("same each time", derandomize=True)
settings.load_profile("same each time")


@pytest.fixture(scope="session")
def shared_data() -> Path:
    """Folder of real recordings and clips; a test that asks for it skips where it is absent."""
    if not SHARED_DATA.is_dir():
        pytest.skip(f"real data absent: {SHARED_DATA}")
    return SHARED_DATA
